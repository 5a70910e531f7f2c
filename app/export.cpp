#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/deformed_scene.hpp"
#include "app/live/recorded_motion.hpp"
#include "app/live/recording_file.hpp"
#include "app/output_file.hpp"
#include "app/progress.hpp"

namespace torsion::engine {
namespace {

struct ExportOptions {
  SceneOptions scene;
  std::string out;
  std::string replay;
  double at = 0.0;  // s
  bool quiet = false;
};

/// Writes the bytes and says what they are.
int write_out(const ExportOptions& options, OutputFile& file, const Result<std::string>& bytes,
              const std::string& what) {
  if (!bytes) {
    return fail(options.out + ": " + bytes.error().text);
  }
  file.write(bytes.value());
  const Result<Done> done = file.commit();
  if (!done) {
    return fail(done.error().text);
  }
  if (!options.quiet) {
    fmt::print("{}: {}\n", options.out, what);
  }
  return kDone;
}

int export_recording(const ExportOptions& options, bool binary) {
  const Result<Recording> recording = load_recording(options.replay);
  if (!recording) {
    return fail(recording.error().text);
  }
  const Result<Session> session =
      open_recorded(options.scene.scene, recording.value(), options.quiet);
  if (!session) {
    return fail(session.error().text);
  }
  Result<OutputFile> file = OutputFile::create(options.out);
  if (!file) {
    return fail(file.error().text);
  }
  return write_out(options, file.value(),
                   with_motions(options.scene.scene,
                                recorded_motions(recording.value(), session.value().scene), binary),
                   fmt::format("{} moved as in {}", options.scene.scene, options.replay));
}

int export_scene(const ExportOptions& options) {
  const std::string extension = std::filesystem::path(options.out).extension().string();
  if (extension != ".glb" && extension != ".gltf") {
    fmt::print(stderr, "--out {}: expected a name that ends in .glb or .gltf\n", options.out);
    return kUsage;
  }
  if (!options.replay.empty()) {
    return export_recording(options, extension == ".glb");
  }
  Result<Session> opened = open_session(options.scene.scene, options.scene.prepare_options(),
                                        options.quiet, options.scene.settings);
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
  return write_out(options, file.value(), gltf_bytes(deformed_scene(session), extension == ".glb"),
                   fmt::format("{} as it is at {:.4g} s", options.scene.scene,
                               session.simulation.world.state.clock.time));
}

}  // namespace

void add_export(CLI::App& app, Command& command) {
  CLI::App* subcommand =
      app.add_subcommand("export", "Write the deformed bodies at one moment as glTF");
  auto options = std::make_shared<ExportOptions>();
  options->scene.add_to(*subcommand);
  CLI::Option* at =
      subcommand->add_option("--at", options->at, "The moment (s)")->check(CLI::Range(0.0, 1e6));
  CLI::Option* replay = subcommand->add_option(
      "--replay", options->replay,
      "A recording instead of a moment: the scene, its tools animated as they were recorded");
  replay->excludes(at);
  options->scene.add_settings_to(*subcommand)->excludes(replay);
  subcommand->add_option("--out", options->out, "A .glb or .gltf to write")->required();
  subcommand->add_flag("--quiet", options->quiet, "Print nothing but errors");
  subcommand->callback([options, at, replay, &command] {
    command = [options, at, replay] {
      if (at->empty() && replay->empty()) {
        fmt::print(stderr, "export: one of --at and --replay is required\n");
        return kUsage;
      }
      return export_scene(*options);
    };
  });
}

}  // namespace torsion::engine
