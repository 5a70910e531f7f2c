#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/device_options.hpp"
#include "app/live/scene_device.hpp"
#include "app/simulate_loop.hpp"
#include "app/summary.hpp"
#include "app/trace_columns.hpp"

namespace torsion::engine {
namespace {

struct SimulateOptions {
  SceneOptions scene;
  std::string trace;
  std::string columns = "usual";  // of the trace
  std::string regions;
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

/// Runs, and finishes what is written.
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
  if (files.trace != nullptr) {
    const Result<Done> done = files.trace->finish();
    if (!done) {
      return done.error();
    }
    facts.trace = options.trace;
  }
  if (files.regions != nullptr) {
    if (const Result<Done> done = files.regions->finish(); !done) {
      return done.error();
    }
  }
  if (files.record != nullptr) {
    const Result<Done> done = files.record->finish();
    (done ? facts.recording : facts.problem) = done ? options.record : done.error().text;
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
  std::optional<TraceWriter> trace;
  if (!options.trace.empty()) {
    Result<std::vector<TraceColumn>> columns = read_trace_columns(options.columns);
    if (!columns) {
      return fail("--columns: " + columns.error().text);
    }
    Result<TraceWriter> created =
        TraceWriter::create(options.trace, tool_names(session.scene), std::move(columns).value());
    if (!created) {
      return fail(created.error().text);
    }
    trace = std::move(created).value();
  }
  std::optional<RegionTrace> regions;
  if (!options.regions.empty()) {
    Result<RegionTrace> created = RegionTrace::create(options.regions);
    if (!created) {
      return fail(created.error().text);
    }
    regions = std::move(created).value();
  }
  std::optional<RecordingWriter> record;
  if (!options.record.empty()) {
    Result<RecordingWriter> created = RecordingWriter::create(
        options.record, begin_recording(session, options.scene.prepare_options()));
    if (!created) {
      return fail(created.error().text);
    }
    record = std::move(created).value();
  }
  Replay replay{replayed ? &*replayed : nullptr, 0};
  const RunFiles files{&interrupt,
                       trace ? &*trace : nullptr,
                       regions ? &*regions : nullptr,
                       record ? &*record : nullptr,
                       replayed ? &replay : nullptr,
                       options.quiet || options.json};
  RunFacts facts;
  const std::uint64_t steps = steps_of_run(options, session, replay.recording);
  const Result<RunStatistics> ran = run(options, session, steps, files, facts);
  if (!ran) {
    return fail(ran.error().text);
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
  subcommand->add_option("--seconds", options->seconds, "How long; else the animation's length")
      ->check(CLI::Range(0.0, 1e6));
  CLI::Option* realtime = subcommand->add_flag("--realtime", options->realtime,
                                               "Run on the clock, not as fast as it goes");
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
