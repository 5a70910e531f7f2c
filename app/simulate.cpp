#include <memory>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/simulate_loop.hpp"
#include "app/summary.hpp"

namespace torsion {
namespace {

struct SimulateOptions {
  SceneOptions scene;
  std::string trace;
  double seconds = -1.0;  // s; negative: to the end of the longest animation
  bool realtime = false;
  bool json = false;
  bool quiet = false;
};

std::vector<std::string> tool_names(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const ToolDescription& tool : scene.tools) {
    names.push_back(tool.node);
  }
  return names;
}

int simulate(const SimulateOptions& options) {
  Result<Session> opened = open_session(options.scene.scene, options.scene.prepare_options(),
                                        options.quiet || options.json);
  if (!opened) {
    return fail(opened.error().text);
  }
  Session& session = opened.value();
  if (options.seconds < 0.0 && session.scene.duration <= 0.0) {
    return fail(session.scene.path +
                ": no animation moves a tool, so there is no end to run to; say --seconds");
  }
  std::optional<TraceWriter> trace;
  if (!options.trace.empty()) {
    Result<TraceWriter> created = TraceWriter::create(options.trace, tool_names(session.scene));
    if (!created) {
      return fail(created.error().text);
    }
    trace = std::move(created).value();
  }
  const double seconds = options.seconds < 0.0 ? session.scene.duration : options.seconds;
  const std::uint64_t steps = steps_in(session, seconds);
  RunStatistics statistics;
  {
    Progress progress("simulating", options.quiet);
    TraceWriter* writer = trace ? &*trace : nullptr;
    statistics = options.realtime ? run_realtime(session, steps, writer, progress)
                                  : run_fast(session, steps, writer, progress);
  }
  if (statistics.lost_rows > 0) {
    return fail(fmt::format("{}: {} rows are lost: the disk is too slow for a run in real time",
                            options.trace, statistics.lost_rows));
  }
  if (trace) {
    const Result<Done> done = trace->finish();
    if (!done) {
      return fail(done.error().text);
    }
  }
  if (options.json) {
    fmt::print("{}", summary_json(session, statistics, options.trace));
  } else if (!options.quiet) {
    fmt::print("{}", summary_text(session, statistics, options.trace));
  }
  return kDone;
}

}  // namespace

void add_simulate(CLI::App& app, Command& command) {
  CLI::App* subcommand = app.add_subcommand(
      "simulate", "Run a scene without a window; write force and torque at every step");
  auto options = std::make_shared<SimulateOptions>();
  options->scene.add_to(*subcommand);
  subcommand->add_option("--trace", options->trace, "CSV file to write, one row a step");
  subcommand->add_option("--seconds", options->seconds, "How long; else the animation's length")
      ->check(CLI::Range(0.0, 1e6));
  subcommand->add_flag("--realtime", options->realtime, "Run on the clock, not as fast as it goes");
  subcommand->add_flag("--json", options->json, "Print the summary as JSON");
  subcommand->add_flag("--quiet", options->quiet, "Print no progress and no summary text");
  subcommand->callback([options, &command] {
    command = [options] {
      return simulate(*options);
    };
  });
}

}  // namespace torsion
