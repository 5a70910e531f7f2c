#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/deformed_scene.hpp"
#include "app/live/recorded_motion.hpp"
#include "app/live/recording_file.hpp"
#include "app/output_file.hpp"
#include "app/progress.hpp"
#ifdef TORSION_WITH_RENDER
#include "app/run_page/run_page.hpp"
#endif

namespace torsion::engine {
namespace {

struct ExportOptions {
  SceneOptions scene;
  std::string out;
  std::string replay;
  double at = 0.0;        // s
  bool animate = false;   // the whole run instead
  double fps = 10.0;      // of it
  double seconds = -1.0;  // s, of it; negative: to the end of its animation
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

/// How many moments a run has; none where it has no end.
Result<std::uint64_t> moments_of(const ExportOptions& options, const Session& session) {
  constexpr double kMost = 500.0;
  const double seconds = options.seconds >= 0.0 ? options.seconds : session.scene.duration;
  if (seconds <= 0.0) {
    return Error{options.scene.scene + ": no animation moves a tool, so --animate needs --seconds"};
  }
  const double moments = std::floor(seconds * options.fps + 1e-9) + 1.0;
  if (moments > kMost) {
    return Error{fmt::format(
        "{}: {:.4g} s at --fps {:.4g} are {:.0f} shapes of each body; a file holds up to {:.0f}: "
        "take fewer a second, or --seconds",
        options.scene.scene, seconds, options.fps, moments, kMost)};
  }
  return static_cast<std::uint64_t>(moments);
}

enum class RunFormat { kGltf, kGlb, kPage };

Result<std::string> run_bytes(const Session& session, const DeformedRun& run, RunFormat format) {
#ifdef TORSION_WITH_RENDER
  if (format == RunFormat::kPage) {
    return run_page(session, run);
  }
#else
  static_cast<void>(session);
#endif
  return animated_gltf_bytes(run.meshes(), run.times(), format == RunFormat::kGlb);
}

int export_run(const ExportOptions& options, Session& session, OutputFile& file, RunFormat format) {
  const Result<std::uint64_t> moments = moments_of(options, session);
  if (!moments) {
    return fail(moments.error().text);
  }
  DeformedRun run(session);
  Progress progress("simulating", options.quiet);
  std::uint64_t taken = 0;  // steps
  for (std::uint64_t moment = 0; moment < moments.value(); ++moment) {
    const double time = static_cast<double>(moment) / options.fps;
    for (const std::uint64_t steps = steps_in(session, time) + 1; taken < steps; ++taken) {
      step_scripted(session);
    }
    run.add(session, time);
    progress.show(static_cast<double>(moment) / static_cast<double>(moments.value()));
  }
  return write_out(options, file, run_bytes(session, run, format),
                   fmt::format("{}, {} moments up to {:.4g} s", options.scene.scene,
                               moments.value(), static_cast<double>(run.times().back())));
}

int export_scene(const ExportOptions& options) {
  const std::string extension = std::filesystem::path(options.out).extension().string();
#ifdef TORSION_WITH_RENDER
  const bool page = extension == ".html" && options.animate;
#else
  constexpr bool page = false;
#endif
  if (extension != ".glb" && extension != ".gltf" && !page) {
    fmt::print(stderr,
               "--out {}: expected a name that ends in .glb or .gltf, or with --animate in .html\n",
               options.out);
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
  if (options.animate) {
    return export_run(options, session, file.value(),
                      page                  ? RunFormat::kPage
                      : extension == ".glb" ? RunFormat::kGlb
                                            : RunFormat::kGltf);
  }
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
  CLI::App* subcommand = app.add_subcommand(
      "export", "Write the deformed bodies at one moment, or all of a run, as glTF");
  auto options = std::make_shared<ExportOptions>();
  options->scene.add_to(*subcommand);
  CLI::Option* at =
      subcommand->add_option("--at", options->at, "The moment (s)")->check(CLI::Range(0.0, 1e6));
  CLI::Option* replay = subcommand->add_option(
      "--replay", options->replay,
      "A recording instead of a moment: the scene, its tools animated as they were recorded");
  replay->excludes(at);
  CLI::Option* animate = subcommand->add_flag(
      "--animate", options->animate, "The whole run: tools by keys, bodies by a shape a moment");
  animate->excludes(at)->excludes(replay);
  subcommand->add_option("--fps", options->fps, "Moments a second of --animate, 10 unless said")
      ->check(CLI::Range(0.1, 1000.0))
      ->needs(animate);
  subcommand->add_option("--seconds", options->seconds, "How long; else the animation's length")
      ->check(CLI::Range(0.0, 1e6))
      ->needs(animate);
  options->scene.add_settings_to(*subcommand)->excludes(replay);
  subcommand
      ->add_option("--out", options->out, "A .glb or .gltf to write, or an .html that plays a run")
      ->required();
  subcommand->add_flag("--quiet", options->quiet, "Print nothing but errors");
  subcommand->callback([options, at, replay, &command] {
    command = [options, at, replay] {
      if (at->empty() && replay->empty() && !options->animate) {
        fmt::print(stderr, "export: one of --at, --animate and --replay is required\n");
        return kUsage;
      }
      return export_scene(*options);
    };
  });
}

}  // namespace torsion::engine
