#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/deformed_scene.hpp"
#include "app/output_file.hpp"
#include "app/progress.hpp"

namespace torsion {
namespace {

struct ExportOptions {
  SceneOptions scene;
  std::string out;
  double at = 0.0;  // s
  bool quiet = false;
};

int export_scene(const ExportOptions& options) {
  const std::string extension = std::filesystem::path(options.out).extension().string();
  if (extension != ".glb" && extension != ".gltf") {
    fmt::print(stderr, "--out {}: expected a name that ends in .glb or .gltf\n", options.out);
    return kUsage;
  }
  Result<Session> opened =
      open_session(options.scene.scene, options.scene.prepare_options(), options.quiet);
  if (!opened) {
    return fail(opened.error().text);
  }
  // Opened before the run, so that a place that cannot be written is known at once.
  Result<OutputFile> file = OutputFile::create(options.out);
  if (!file) {
    return fail(file.error().text);
  }
  Session& session = opened.value();
  const std::uint64_t steps = steps_in(session, options.at) + 1;
  {
    Progress progress("simulating", options.quiet);
    for (std::uint64_t i = 0; i < steps; ++i) {
      step_scripted(session);
      progress.show(static_cast<double>(i) / static_cast<double>(steps));
    }
  }
  const Result<std::string> bytes = gltf_bytes(deformed_scene(session), extension == ".glb");
  if (!bytes) {
    return fail(options.out + ": " + bytes.error().text);
  }
  file.value().write(bytes.value());
  const Result<Done> done = file.value().commit();
  if (!done) {
    return fail(done.error().text);
  }
  if (!options.quiet) {
    fmt::print("{}: {} as it is at {:.4g} s\n", options.out, session.scene.path,
               session.simulation.world.clock.at<Clock>(0).time);
  }
  return kDone;
}

}  // namespace

void add_export(CLI::App& app, Command& command) {
  CLI::App* subcommand =
      app.add_subcommand("export", "Write the deformed bodies at one moment as glTF");
  auto options = std::make_shared<ExportOptions>();
  options->scene.add_to(*subcommand);
  subcommand->add_option("--at", options->at, "The moment (s)")
      ->required()
      ->check(CLI::Range(0.0, 1e6));
  subcommand->add_option("--out", options->out, "A .glb or .gltf to write")->required();
  subcommand->add_flag("--quiet", options->quiet, "Print nothing but errors");
  subcommand->callback([options, &command] {
    command = [options] {
      return export_scene(*options);
    };
  });
}

}  // namespace torsion
