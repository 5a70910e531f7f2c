#include "app/simulate_loop.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "app/live/live_loop.hpp"

namespace torsion::engine {
namespace {

using SteadyClock = std::chrono::steady_clock;

double microseconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double, std::micro>(SteadyClock::now() - start).count();
}

/// Steps once and says how long it took, us.
double timed_step(Session& session) {
  const auto start = SteadyClock::now();
  step(session.simulation, session.tool_poses);
  return microseconds_since(start);
}

/// Snapshots that a run without pictures takes to say what its steps save by not taking any.
constexpr std::uint64_t kTimedSnapshots = 16;

/// Times a snapshot of the step if the step is one of kTimedSnapshots spread over the run, and
/// there are contacts in it.
void time_snapshot(const Session& session, std::uint64_t step, std::uint64_t steps, double step_us,
                   Snapshot& snapshot, RunStatistics& statistics) {
  const std::uint64_t interval = std::max<std::uint64_t>(steps / kTimedSnapshots, 1);
  if (step % interval != interval / 2 || session.simulation.world.state.regions.empty()) {
    return;
  }
  take_snapshot(session.simulation, snapshot);  // the first one finds its memory cold
  const auto start = SteadyClock::now();
  take_snapshot(session.simulation, snapshot);
  statistics.snapshot_us += microseconds_since(start);
  statistics.snapshot_step_us += step_us;
  ++statistics.snapshots;
}

void write_trace(const Session& session, double step_us, std::vector<TraceRow>& rows,
                 TraceWriter& trace) {
  for (std::uint32_t tool = 0; tool < rows.size(); ++tool) {
    rows[tool] = trace_row(session.simulation.world, tool, step_us);
  }
  trace.append(rows);
}

void record_poses(const Session& session, RecordingWriter& recording) {
  const std::uint64_t step = session.simulation.world.state.clock.step;
  for (std::uint32_t tool = 0; tool < session.tool_poses.size(); ++tool) {
    const Pose& pose = session.tool_poses[tool];
    recording.add(pose_entry(step, tool, pose, pose));
  }
}

/// Writes what the rings hold.
void drain(LiveLoop& loop, const RunFiles& files, std::vector<TraceRow>& rows) {
  while (const auto row = loop.rows.pop()) {
    rows[row->tool] = row->trace;
    if (row->tool + 1 == rows.size()) {
      files.trace->append(rows);
    }
  }
  while (const auto entry = loop.inputs.pop()) {
    files.record->add(*entry);
  }
}

/// As soon as nothing more can be recorded whoever holds the tool should know, and may go on.
void tell_of_problem(const RunFiles& files, bool& told) {
  const std::string problem = files.record != nullptr && !told ? files.record->problem() : "";
  if (!problem.empty()) {
    told = true;
    fmt::print(stderr, "torsion: {}; the session goes on without a recording\n", problem);
  }
}

}  // namespace

Result<RunStatistics> run_fast(Session& session, std::uint64_t steps, const RunFiles& files,
                               Progress& progress) {
  RunStatistics statistics;
  std::vector<TraceRow> rows(session.scene.tools.size());
  Snapshot snapshot;
  snapshot.reserve(session.simulation.world.model, session.simulation.world.state);
  double watched_us = 0.0;  // no part of the run
  const auto start = SteadyClock::now();
  for (std::uint64_t i = 0; i < steps; ++i) {
    if (files.replay != nullptr) {
      const Result<Done> done = replay_inputs(*files.replay, session, files.quiet);
      if (!done) {
        return done.error();
      }
    } else {
      set_scripted_poses(session);
    }
    if (files.record != nullptr) {
      record_poses(session, *files.record);
    }
    const double step_us = timed_step(session);
    statistics.add_step(session.simulation.world, step_us);
    time_snapshot(session, i, steps, step_us, snapshot, statistics);
    if (files.trace != nullptr) {
      write_trace(session, step_us, rows, *files.trace);
    }
    if (files.regions != nullptr) {
      files.regions->append(session.simulation.world);
    }
    if (files.watch) {
      const auto before = SteadyClock::now();
      files.watch(session, i);
      watched_us += microseconds_since(before);
    }
    if (i % 256 == 0) {
      progress.show(static_cast<double>(i) / static_cast<double>(steps));
      if (files.interrupt != nullptr && files.interrupt->within(0)) {
        break;
      }
    }
  }
  statistics.wall_time = 1e-6 * (microseconds_since(start) - watched_us);
  return statistics;
}

RunStatistics run_realtime(Session& session, std::uint64_t steps, const RunFiles& files,
                           const RunDevice& device, Progress& progress, RealtimeMode& mode) {
  LiveLoop loop;
  loop.wants_rows = files.trace != nullptr;
  loop.wants_inputs = files.record != nullptr;
  reserve(loop, session, session.simulation);
  loop.steps_left = steps;
  std::vector<TraceRow> rows(session.scene.tools.size());
  if (device.link != nullptr) {
    loop.tools[device.tool].from = PoseFrom::kHandle;
    loop.tools[device.tool].slot = &device.link->slot();
    loop.tools[device.tool].hold = device.hold;
  }
  bool told = false;
  std::thread physics(run_live, std::ref(loop));
  while (!loop.over.load(std::memory_order_acquire)) {
    constexpr long kPause = 5;  // ms
    if (files.interrupt == nullptr) {
      std::this_thread::sleep_for(std::chrono::milliseconds(kPause));
    } else if (files.interrupt->within(kPause)) {
      loop.stop.store(true, std::memory_order_release);
    }
    drain(loop, files, rows);
    tell_of_problem(files, told);
    if (loop.frames.refresh()) {
      progress.show(static_cast<double>(loop.frames.front().statistics.steps) /
                    static_cast<double>(steps));
    }
  }
  physics.join();
  drain(loop, files, rows);
  mode = loop.mode;
  return loop.statistics;
}

}  // namespace torsion::engine
