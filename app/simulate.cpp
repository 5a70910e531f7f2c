#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/device_options.hpp"
#include "app/live/scene_device.hpp"
#include "app/simulate_loop.hpp"
#include "app/summary.hpp"
#include "app/trace_columns.hpp"
#ifdef TORSION_WITH_RENDER
#include "app/run_page/page_file.hpp"
#endif

namespace torsion::engine {
namespace {

struct SimulateOptions {
  SceneOptions scene;
  std::string trace;
  std::string columns = "usual";  // of the trace
  std::string regions;
  std::string html;
  std::string record;
  std::string replay;
  double seconds = -1.0;  // s; negative: to the end of the longest animation
  DeviceChoice device;
  bool realtime = false;
  bool json = false;
  bool quiet = false;
};

/// What the command line can get wrong in ways that only the file behind it shows.
Result<Session> open_for_run(const SimulateOptions& options, const Recording* replayed) {
  const bool quiet = options.quiet || options.json;
  Result<Session> opened = replayed != nullptr
                               ? open_recorded(options.scene.scene, *replayed, quiet)
                               : open_session(options.scene.scene, options.scene.prepare_options(),
                                              quiet, options.scene.settings);
  if (opened && replayed == nullptr && options.seconds < 0.0 &&
      opened.value().scene.duration <= 0.0) {
    return Error{opened.value().scene.path +
                 ": no animation moves a tool, so there is no end to run to; say --seconds"};
  }
  return opened;
}

std::uint64_t steps_of_run(const SimulateOptions& options, const Session& session,
                           const Recording* replayed) {
  const double seconds = options.seconds < 0.0 ? session.scene.duration : options.seconds;
  if (replayed == nullptr) {
    return steps_in(session, seconds);
  }
  const std::uint64_t recorded = steps_in(*replayed);
  return options.seconds < 0.0 ? recorded : std::min(recorded, steps_in(session, seconds));
}

/// What a run writes; each is there where the command line asks for it.
struct Outputs {
  std::optional<TraceWriter> trace;
  std::optional<RegionTrace> regions;
  std::optional<RecordingWriter> record;
#ifdef TORSION_WITH_RENDER
  std::optional<PageFile> page;
#endif
};

template <class T>
Result<Done> keep(Result<T> created, std::optional<T>& kept) {
  if (!created) {
    return created.error();
  }
  kept = std::move(created).value();
  return Done{};
}

/// Opened before the run, so that a place that cannot be written is known at once.
Result<Done> open_outputs(const SimulateOptions& options, const Session& session,
                          [[maybe_unused]] std::uint64_t steps, Outputs& outputs) {
  Result<Done> done = Done{};
  if (!options.trace.empty()) {
    Result<std::vector<TraceColumn>> columns = read_trace_columns(options.columns);
    done = columns ? keep(TraceWriter::create(options.trace, tool_names(session.scene),
                                              std::move(columns).value()),
                          outputs.trace)
                   : Error{"--columns: " + columns.error().text};
  }
  if (done && !options.regions.empty()) {
    done = keep(RegionTrace::create(options.regions), outputs.regions);
  }
  if (done && !options.record.empty()) {
    done = keep(RecordingWriter::create(options.record,
                                        begin_recording(session, options.scene.prepare_options())),
                outputs.record);
  }
#ifdef TORSION_WITH_RENDER
  if (done && !options.html.empty()) {
    done = keep(PageFile::create(options.html, session, steps), outputs.page);
  }
#endif
  return done;
}

RunFiles files_of(Outputs& outputs) {
  RunFiles files;
  files.trace = outputs.trace ? &*outputs.trace : nullptr;
  files.regions = outputs.regions ? &*outputs.regions : nullptr;
  files.record = outputs.record ? &*outputs.record : nullptr;
#ifdef TORSION_WITH_RENDER
  if (outputs.page) {
    files.watch = [&page = *outputs.page](const Session& now, std::uint64_t step) {
      page.watch(now, step);
    };
  }
#endif
  return files;
}

/// Finishes what was written. A recording that has a problem does not keep the rest from it.
Result<Done> finish(const SimulateOptions& options, [[maybe_unused]] const Session& session,
                    Outputs& outputs, RunFacts& facts) {
  Result<Done> done = Done{};
  if (outputs.trace) {
    done = outputs.trace->finish();
    facts.trace = options.trace;
  }
  if (done && outputs.regions) {
    done = outputs.regions->finish();
  }
#ifdef TORSION_WITH_RENDER
  if (done && outputs.page) {
    done = outputs.page->finish(session);
    facts.page = options.html;
  }
#endif
  if (done && outputs.record) {
    const Result<Done> recorded = outputs.record->finish();
    (recorded ? facts.recording : facts.problem) =
        recorded ? options.record : recorded.error().text;
  }
  return done;
}

/// On the clock or as fast as it goes.
Result<RunStatistics> run(const SimulateOptions& options, Session& session, std::uint64_t steps,
                          const RunFiles& files, RunFacts& facts) {
  RunStatistics statistics;
  {
    Progress progress("simulating", options.quiet);
    if (options.realtime) {
      RealtimeMode mode;
      const Result<SceneDevice> opened = open_device(options.device, session.scene);
      if (!opened) {
        return opened.error();
      }
      DeviceLink* const link = opened.value().link.get();
      const RunDevice device{link, opened.value().tool, options.device.hold};
      statistics = run_realtime(session, steps, files, device, progress, mode);
      facts.mode = describe(mode);
      if (device.link != nullptr) {
        facts.device = device.link->view();
      }
    } else {
      const Result<RunStatistics> ran = run_fast(session, steps, files, progress);
      if (!ran) {
        return ran.error();
      }
      statistics = ran.value();
    }
  }
  if (statistics.lost_rows + statistics.lost_inputs > 0) {
    return Error{fmt::format("{}: {} rows are lost: the disk is too slow for a run in real time",
                             statistics.lost_rows > 0 ? options.trace : options.record,
                             statistics.lost_rows + statistics.lost_inputs)};
  }
  return statistics;
}

int simulate(const SimulateOptions& options) {
  // Before any thread, and until all is written: who ends the run early keeps what there is of it.
  const Interrupt interrupt;
  std::optional<Recording> replayed;
  if (!options.replay.empty()) {
    Result<Recording> loaded = load_recording(options.replay);
    if (!loaded) {
      return fail(loaded.error().text);
    }
    replayed = std::move(loaded).value();
  }
  Result<Session> opened = open_for_run(options, replayed ? &*replayed : nullptr);
  if (!opened) {
    return fail(opened.error().text);
  }
  Session& session = opened.value();
  Replay replay{replayed ? &*replayed : nullptr, 0};
  const std::uint64_t steps = steps_of_run(options, session, replay.recording);
  Outputs outputs;
  if (const Result<Done> done = open_outputs(options, session, steps, outputs); !done) {
    return fail(done.error().text);
  }
  RunFiles files = files_of(outputs);
  files.interrupt = &interrupt;
  files.replay = replayed ? &replay : nullptr;
  files.quiet = options.quiet || options.json;
  RunFacts facts;
  const Result<RunStatistics> ran = run(options, session, steps, files, facts);
  if (!ran) {
    return fail(ran.error().text);
  }
  if (const Result<Done> done = finish(options, session, outputs, facts); !done) {
    return fail(done.error().text);
  }
  facts.steps_left = steps - std::min(steps, ran.value().steps);
  if (options.json) {
    fmt::print("{}", summary_json(session, ran.value(), facts));
  } else if (!options.quiet) {
    fmt::print("{}", summary_text(session, ran.value(), facts));
  }
  if (!facts.problem.empty()) {
    return fail(facts.problem);
  }
  return kDone;
}

}  // namespace

void add_simulate(CLI::App& app, Command& command) {
  CLI::App* subcommand = app.add_subcommand(
      "simulate", "Run a scene without a window; write force and torque at every step");
  auto options = std::make_shared<SimulateOptions>();
  options->scene.add_to(*subcommand);
  CLI::Option* trace = subcommand->add_option("--trace", options->trace,
                                              "CSV or HDF5 (.h5) file to write, one row a step");
  subcommand
      ->add_option("--columns", options->columns,
                   "The trace's columns of each tool, with commas between; usual, all, or names")
      ->needs(trace);
  CLI::Option* regions = subcommand->add_option(
      "--regions", options->regions,
      "CSV or HDF5 (.h5) file to write, one row for each contact region in each step");
#ifdef TORSION_WITH_RENDER
  CLI::Option* html = subcommand->add_option(
      "--html", options->html, "A page to write that plays the run in a browser, in 3D");
#endif
  subcommand->add_option("--seconds", options->seconds, "How long; else the animation's length")
      ->check(CLI::Range(0.0, 1e6));
  CLI::Option* realtime = subcommand->add_flag("--realtime", options->realtime,
                                               "Run on the clock, not as fast as it goes");
#ifdef TORSION_WITH_RENDER
  html->excludes(realtime);
#endif
  regions->excludes(realtime);  // as many rows as there are regions: record, then replay
  CLI::Option* record = subcommand->add_option(
      "--record", options->record, "File to write with everything that goes into the run");
  CLI::Option* replay =
      subcommand->add_option("--replay", options->replay,
                             "Recording to run again: the same bits, its models and its rate");
  subcommand
      ->add_option("--device", options->device.what,
                   "What holds the tool: usb, usb:falcon+odrive and the like, or gateway[:PORT]")
      ->needs(realtime);
  add_device_options(*subcommand, options->device);
  // A recording is of what the scene's file says and what was picked in the window.
  options->scene.add_settings_to(*subcommand)->excludes(record)->excludes(replay);
  replay->excludes(record)->excludes(realtime);
  for (const char* chosen :
       {"--contact-model", "--body-model", "--rate", "--cells", "--iterations"}) {
    replay->excludes(chosen);
  }
  subcommand->add_flag("--json", options->json, "Print the summary as JSON");
  subcommand->add_flag("--quiet", options->quiet, "Print no progress and no summary text");
  subcommand->callback([options, &command] {
    command = [options] {
      return simulate(*options);
    };
  });
}

}  // namespace torsion::engine
