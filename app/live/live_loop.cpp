#include "app/live/live_loop.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "app/live/rebuild.hpp"
#include "device/scripted_motion.hpp"
#include "systems/hold/virtual_coupling.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

constexpr double kRingSeconds = 30.0;
constexpr std::size_t kCommands = 256;
// s: after a change of models contacts form anew, and their forces rise within 10 ms; a tool
// without mass would fall through until then.
constexpr double kSettle = 0.05;
constexpr double kDeadline = 1000.0;  // us: later than that and a hand may feel it

void take_sample(LiveTool& tool) {
  tool.arrived = 0;
  if (tool.slot == nullptr || !tool.slot->sample.refresh()) {
    return;
  }
  const HandleSample& sample = tool.slot->sample.front();
  if (tool.sample == 0) {
    tool.last_handle = sample.pose;
    restart_smoothing(tool.smoothing, sample.pose);
  }
  if (sample.epoch != tool.epoch) {
    tool.epoch = sample.epoch;
    tool.coupling = choose_coupling(sample.traits).coupling;
    tool.last_handle = sample.pose;
  }
  // A device's, and one for each step: it has about the steps' own rate.
  const bool in_step = sample.epoch != 0 && sample.number == tool.sample + 1;
  tool.arrived = in_step ? sample.time_ns : 0;
  tool.handle = sample.pose;
  tool.sample = sample.number;
}

/// Where the animation has a tool in the next step, or a place on the way back to that.
Pose next_scripted_pose(LiveTool& tool, const MotionScript& script, const World& world) {
  const Pose scripted = scripted_pose(script, next_time(world));
  if (tool.returning >= 1.0) {
    return scripted;
  }
  tool.returning += world.model.dt / kReturnTime;
  const double share = smooth_step(tool.returning);
  return {glm::mix(tool.let_go.position, scripted.position, share),
          glm::slerp(tool.let_go.rotation, scripted.rotation, share)};
}

/// @param now  where the tool is
void change_source(LiveTool& tool, const Pose& now, PoseFrom from) {
  if (tool.from == PoseFrom::kHandle && from == PoseFrom::kScript) {
    tool.let_go = now;
    tool.returning = 0.0;
  } else if (tool.from == PoseFrom::kScript && from == PoseFrom::kHandle) {
    // Who takes it has said where the handle is before this; what was before somebody let go of it
    // does not count.
    take_sample(tool);
    tool.last_handle = tool.handle;
    tool.books = PassivityState{};
    restart_smoothing(tool.smoothing, tool.handle);
  }
  tool.from = from;
}

/// The pose that a tool takes in the next step; fills `handle` with what asked for it.
Pose next_pose(LiveLoop& loop, std::uint32_t row, Pose& handle) {
  LiveTool& tool = loop.tools[row];
  const World& world = loop.simulation->world;
  take_sample(tool);
  if (tool.from == PoseFrom::kScript || world.state.clock.step == 0) {
    handle = next_scripted_pose(tool, loop.session->scene.tools[row].script, world);
    return handle;
  }
  if (tool.sample == 0) {  // nobody has taken it yet: it stays
    handle = world.state.tools.at<ToolPose>(row).now;
    return handle;
  }
  if (tool.smoothing.on && tool.epoch == 0) {
    tool.handle = smooth(tool.smoothing, tool.slot->sample.front().pose, world.model.dt);
  }
  handle = tool.handle;
  if (tool.still_steps > 0) {
    tool.still_steps -= 1;
    return world.state.tools.at<ToolPose>(row).now;
  }
  return next_held_pose(world.model, world.state, row, tool.hold, tool.coupling, handle);
}

/// What the handle is to feel of the step just done.
void answer(LiveLoop& loop, std::uint32_t row) {
  LiveTool& tool = loop.tools[row];
  if (tool.slot == nullptr) {
    return;
  }
  const World& world = loop.simulation->world;
  HandleAnswer& out = tool.slot->answer.back();
  out.tool = world.state.tools.at<ToolPose>(row).now;
  out.faults = world.state.clock.faults;
  out.sample = tool.sample;
  out.contact = wrench_about_frame(world.state, row);
  out.wrench = Wrench{};
  out.distance = 0.0;
  if (tool.from == PoseFrom::kHandle && tool.sample != 0) {
    out.wrench =
        keep_passive(tool.books, tool.limits,
                     felt_wrench(tool.hold, tool.coupling, tool.handle, out.tool, out.contact),
                     tool.handle.position - tool.last_handle.position,
                     turn_between(tool.last_handle.rotation, tool.handle.rotation), world.model.dt);
    tool.last_handle = tool.handle;
    out.distance = glm::length(tool.handle.position - out.tool.position);
  }
  out.time_ns = monotonic_now();
  tool.slot->answer.publish();
}

void push_input(LiveLoop& loop, const InputEntry& entry) {
  if (loop.wants_inputs && !loop.inputs.push(entry)) {
    loop.statistics.lost_inputs += 1;
  }
}

void go_over(LiveLoop& loop, Generation& to, bool carry) {
  const World& from = loop.simulation->world;
  const std::uint64_t step = from.state.clock.step;
  if (carry) {
    carry_over(from, to.simulation.world);
    for (std::uint32_t body = 0; body < to.picks.size(); ++body) {
      push_input(loop, body_entry(step, body, to.picks[body]));
    }
    push_input(loop, {InputKind::kRebuild, 0, step, {}});
    const double dt = to.simulation.world.model.dt;
    for (LiveTool& tool : loop.tools) {
      tool.still_steps = static_cast<std::uint32_t>(std::ceil(kSettle / dt));
    }
  } else {
    loop.statistics = RunStatistics{};
    for (LiveTool& tool : loop.tools) {
      tool.from = tool.at_start;
      tool.returning = 1.0;
      tool.sample = 0;
      tool.books = PassivityState{};
    }
  }
  loop.simulation = &to.simulation;
  loop.generation = to.number;
}

void do_command(LiveLoop& loop, const LiveCommand& command) {
  switch (command.kind) {
    case LiveCommandKind::kPause:
      loop.paused = command.number != 0;
      loop.single_steps = 0;
      break;
    case LiveCommandKind::kStepOnce:
      loop.single_steps += 1;
      break;
    case LiveCommandKind::kSlowness:
      loop.slowness = static_cast<std::uint32_t>(std::max<std::uint64_t>(command.number, 1));
      break;
    case LiveCommandKind::kPoseFrom:
      change_source(loop.tools[command.index],
                    loop.simulation->world.state.tools.at<ToolPose>(command.index).now,
                    static_cast<PoseFrom>(command.number));
      break;
    case LiveCommandKind::kCoupling:
      loop.tools[command.index].coupling = command.coupling;
      break;
    case LiveCommandKind::kSwap:
      go_over(loop, *command.generation, true);
      break;
    case LiveCommandKind::kRestart:
      go_over(loop, *command.generation, false);
      break;
  }
}

/// Whether this tick takes a step.
bool due_now(LiveLoop& loop) {
  if (loop.paused) {
    if (loop.single_steps == 0) {
      return false;
    }
    loop.single_steps -= 1;
    return true;
  }
  return loop.ticks % loop.slowness == 0;
}

LiveRow live_row(const LiveLoop& loop, std::uint32_t tool, double step_us, double late_us) {
  const World& world = loop.simulation->world;
  LiveRow row;
  row.trace = trace_row(world, tool, step_us);
  row.late_us = late_us;
  row.generation = loop.generation;
  row.tool = tool;
  row.faults = world.state.clock.faults;
  for (std::uint32_t region = 0; region < world.state.regions.size(); ++region) {
    const RegionIdentity& identity = world.state.regions.at<RegionIdentity>(region);
    if (identity.tool == tool) {
      const glm::dquat& to_world = world.state.bodies.at<BodyPose>(identity.body).now.rotation;
      row.normal = to_world * world.state.regions.at<RegionFrame>(region).normal;
      row.tangent_x = to_world * world.state.regions.at<RegionFrame>(region).tangent_x;
      row.turn = world.state.regions.at<RegionMotion>(region).turn;
      row.couple = world.state.regions.at<RegionFriction>(region).couple;
      row.radius = world.state.regions.at<Contact>(region).radius;
      row.contact = identity.order + 1;
      break;
    }
  }
  return row;
}

/// Where the cells are that carry pressure.
void mark_cells(const World& world, std::vector<CellMark>& marks) {
  marks.clear();
  const std::uint32_t side = world.model.settings.grid_side;
  for (std::uint32_t region = 0; region < world.state.regions.size(); ++region) {
    const RegionIdentity& identity = world.state.regions.at<RegionIdentity>(region);
    const RegionFrame& frame = world.state.regions.at<RegionFrame>(region);
    const Pose& body = world.state.bodies.at<BodyPose>(identity.body).now;
    const auto tractions = world.state.cells.rows<CellTraction>(identity.cells);
    const auto geometry = world.state.cells.rows<CellGeometry>(identity.cells);
    for (std::uint32_t i = 0; i < tractions.size() && marks.size() < kMostCellMarks; ++i) {
      if (tractions[i].pressure > 0.0) {
        const std::uint32_t row = i / side;
        const glm::dvec2 center = cell_center(frame, side, i % side, row);
        const glm::dvec3 place = grid_to_body(frame, {center, geometry[i].height});
        marks.push_back({glm::vec3(body.position + body.rotation * place), tractions[i].sticks});
      }
    }
  }
}

void step_and_tell(LiveLoop& loop, double late_us) {
  World& world = loop.simulation->world;
  const std::uint64_t number = world.state.clock.step;
  const Nanoseconds start = monotonic_now();
  std::vector<Pose>& poses = loop.session->tool_poses;
  for (std::uint32_t row = 0; row < poses.size(); ++row) {
    Pose handle;
    poses[row] = next_pose(loop, row, handle);
    push_input(loop, pose_entry(number, row, poses[row], handle));
  }
  step(*loop.simulation, poses);
  for (std::uint32_t row = 0; row < poses.size(); ++row) {
    answer(loop, row);
  }
  const double step_us = 1e-3 * static_cast<double>(monotonic_now() - start);
  loop.statistics.add_step(world, step_us);
  loop.statistics.overruns += 1e3 * step_us > static_cast<double>(loop.schedule.period) ? 1U : 0U;
  for (std::uint32_t row = 0; loop.wants_rows && row < poses.size(); ++row) {
    loop.statistics.lost_rows += loop.rows.push(live_row(loop, row, step_us, late_us)) ? 0U : 1U;
  }
  const auto led =
      std::ranges::find_if(loop.tools, [](const LiveTool& tool) { return tool.arrived != 0; });
  if (led != loop.tools.end()) {
    follow_samples(loop.schedule, led->arrived);
  }
  loop.steps_left -= 1;
}

void fill_snapshot(const LiveLoop& loop, const Simulation& simulation, Snapshot& snapshot) {
  if (loop.wants_pictures) {
    take_snapshot(simulation, snapshot);
  } else {
    capture(simulation.world.model, simulation.world.state, snapshot);
  }
}

void publish_frame(LiveLoop& loop) {
  LiveFrame& frame = loop.frames.back();
  fill_snapshot(loop, *loop.simulation, frame.snapshot);
  frame.statistics = loop.statistics;
  frame.cells.clear();
  if (loop.wants_cells.load(std::memory_order_relaxed)) {
    mark_cells(loop.simulation->world, frame.cells);
  }
  frame.generation = loop.generation;
  frame.skipped = loop.schedule.skipped;
  frame.slowness = loop.slowness;
  frame.paused = loop.paused;
  loop.frames.publish();
}

/// What a picture needs may take a tenth of a millisecond: it is found for the frames that are
/// drawn, and in between often enough that the one which is taken next is not old.
void publish_if_due(LiveLoop& loop) {
  constexpr Nanoseconds kInterval = 8'000'000;
  if (loop.frames.taken() || loop.ticks >= loop.next_frame) {
    publish_frame(loop);
    loop.next_frame =
        loop.ticks + static_cast<std::uint64_t>(std::max<Nanoseconds>(
                         kInterval / std::max<Nanoseconds>(loop.schedule.period, 1), 1));
  }
}

}  // namespace

void reserve(LiveLoop& loop, Session& session, Simulation& simulation) {
  const World& world = simulation.world;
  const double dt = world.model.dt;
  loop.session = &session;
  loop.simulation = &simulation;
  loop.schedule.period = static_cast<Nanoseconds>(std::llround(1e9 * dt));
  loop.tools.assign(session.scene.tools.size(), LiveTool{});
  const std::size_t rows =
      static_cast<std::size_t>(kRingSeconds / dt) * std::max<std::size_t>(loop.tools.size(), 1);
  loop.rows.reserve(loop.wants_rows ? rows : 1);
  loop.inputs.reserve(loop.wants_inputs ? rows : 1);
  loop.commands.reserve(kCommands);
  loop.frames.prepare([&](LiveFrame& frame) {
    frame.snapshot.reserve(world.model, world.state);
    frame.cells.reserve(kMostCellMarks);
    fill_snapshot(loop, simulation, frame.snapshot);
  });
}

void take_commands(LiveLoop& loop) {
  while (const auto command = loop.commands.pop()) {
    do_command(loop, *command);
  }
}

void live_tick(LiveLoop& loop, double late_us) {
  take_commands(loop);
  loop.statistics.lateness.add(late_us);
  loop.statistics.missed_deadlines += late_us > kDeadline ? 1U : 0U;
  if (due_now(loop)) {
    step_and_tell(loop, late_us);
  }
  loop.ticks += 1;
  publish_if_due(loop);
}

void run_live(LiveLoop& loop) {
  if (loop.wants_privileges) {
    loop.mode = become_realtime();
  }
  loop.ready.store(true, std::memory_order_release);
  const Nanoseconds start = monotonic_now();
  loop.schedule.due = start + loop.schedule.period;
  while (loop.steps_left > 0 && !loop.stop.load(std::memory_order_acquire)) {
    wait_until(loop.schedule.due, loop.mode.fifo);
    const Nanoseconds late = begin_step(loop.schedule, monotonic_now());
    live_tick(loop, 1e-3 * static_cast<double>(std::max<Nanoseconds>(late, 0)));
    loop.statistics.wall_time = 1e-9 * static_cast<double>(monotonic_now() - start);
  }
  publish_frame(loop);
  loop.over.store(true, std::memory_order_release);
}

}  // namespace torsion::engine
