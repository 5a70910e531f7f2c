#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "app/live/input_entry.hpp"
#include "app/live/periodic_clock.hpp"
#include "app/live/realtime_mode.hpp"
#include "app/run_statistics.hpp"
#include "app/session.hpp"
#include "app/trace.hpp"
#include "device/handle_slot.hpp"
#include "ecs/frame_world.hpp"
#include "ecs/ring.hpp"
#include "ecs/snapshot.hpp"
#include "ecs/triple_buffer.hpp"
#include "systems/hold/handle_side.hpp"
#include "systems/hold/handle_smoothing.hpp"
#include "systems/hold/tool_hold.hpp"

namespace torsion::engine {

enum class PoseFrom : std::uint32_t {
  kScript,  // the scene's animation, imposed
  kHandle,  // a mouse or a device, through the virtual coupling
};

// s, of the scene: the way of a tool that was let go of back to its script
inline constexpr double kReturnTime = 1.0;

/// What moves one tool. Written by the physics thread once that runs.
struct LiveTool {
  PoseFrom from = PoseFrom::kScript;
  PoseFrom at_start = PoseFrom::kScript;  // where a restart goes back to
  HandleSlot* slot = nullptr;  // where handle poses come from and wrenches go; may be null
  VirtualCoupling coupling;
  PassivityLimits limits;  // of the device; as they are made, the controller adds nothing
  PassivityState books;
  Pose handle;               // of the last sample, smoothed if `smoothing` is on
  Pose last_handle;          // at the step before
  std::uint64_t sample = 0;  // its number; 0: there was none
  // When the sample of this step arrived, if it is a device's and the next after the last step's;
  // else 0.
  Nanoseconds arrived = 0;
  std::uint32_t epoch = 0;        // of the device that it is from
  std::uint32_t still_steps = 0;  // for which a held tool stays where it is
  ToolHold hold = ToolHold::kMassless;
  HandleSmoothing smoothing;  // of a mouse
  // A tool that was let go of goes back to its script from where it was, from `returning` = 0 to 1.
  Pose let_go;
  double returning = 1.0;
};

/// A prepared world that the physics thread may go over to, and what draws it.
struct Generation {
  Simulation simulation;
  FrameWorld frame;
  std::vector<BodyPick> picks;  // (bodies), of which it was prepared
  std::uint64_t number = 0;
};

enum class LiveCommandKind : std::uint32_t {
  kPause,     // number: 0 or 1
  kStepOnce,  // while paused
  kSlowness,  // number: periods of the clock to a step
  kPoseFrom,  // index: tool, number: PoseFrom; from a handle to the script it goes in kReturnTime
  kCoupling,  // index: tool, coupling
  kSwap,      // generation; goes on where the old one was
  kRestart,   // generation; from its own start
};

struct LiveCommand {
  LiveCommandKind kind = LiveCommandKind::kPause;
  std::uint32_t index = 0;
  std::uint64_t number = 0;
  Generation* generation = nullptr;  // the sender keeps it alive until a frame of the next one
  VirtualCoupling coupling{};
};

/// One tool in one step, for traces and plots.
struct LiveRow {
  TraceRow trace;
  double late_us = 0.0;
  // Of the tool's oldest region; without one zero.
  glm::dvec3 normal{0.0};     // world, unit
  glm::dvec3 tangent_x{0.0};  // world, unit
  double turn = 0.0;          // rad: of the tool, since the region formed
  double couple = 0.0;        // N m: about the normal through the pressure centre, on the tool
  double radius = 0.0;        // m: of the contact
  std::uint64_t contact = 0;  // 1 + the order of its formation; 0: there is none
  std::uint64_t generation = 0;
  std::uint32_t tool = 0;
  std::uint32_t faults = 0;
};

/// A cell that carries pressure, for who draws it.
struct CellMark {
  glm::vec3 place{0.0F};  // m, world
  std::uint32_t sticks = 0;
};
inline constexpr std::uint32_t kMostCellMarks = 4096;

/// What the physics thread shows of itself after a step, whole.
struct LiveFrame {
  Snapshot snapshot;
  RunStatistics statistics;
  std::vector<CellMark> cells;  // up to kMostCellMarks, if anybody wants them
  std::uint64_t generation = 0;
  std::uint64_t skipped = 0;  // periods by which the clock was moved
  std::uint32_t slowness = 1;
  bool paused = false;
};

/// Everything of a session on the clock. The physics thread owns what is not a ring, a triple
/// buffer or an atomic; between threads go only those.
struct LiveLoop {
  Session* session = nullptr;  // its scene is constant while the thread runs
  Simulation* simulation = nullptr;
  std::uint64_t generation = 0;
  std::vector<LiveTool> tools;
  StepSchedule schedule;
  std::uint64_t steps_left = UINT64_MAX;
  std::uint64_t ticks = 0;
  std::uint64_t next_frame = 0;  // tick in which one is due, whether the last was taken or not
  std::uint32_t slowness = 1;
  bool paused = false;
  std::uint32_t single_steps = 0;
  bool wants_privileges = true;  // SCHED_FIFO and locked memory; tests do without
  bool wants_rows = false;       // whether anybody takes `rows`
  bool wants_pictures = false;   // whether anybody draws `frames`: else they have only the state
  bool wants_inputs = false;     // whether anybody takes `inputs`
  RunStatistics statistics;

  Ring<LiveCommand> commands;      // to the physics thread
  Ring<LiveRow> rows;              // from it: every row
  Ring<InputEntry> inputs;         // from it: everything that went in
  TripleBuffer<LiveFrame> frames;  // from it: the state, once the last was taken, or after 8 ms
  RealtimeMode mode;               // valid once `ready`
  std::atomic<bool> wants_cells = false;
  std::atomic<bool> ready = false;
  std::atomic<bool> stop = false;
  std::atomic<bool> over = false;  // all steps are taken, or stop was seen
};

/// Takes all memory, after the `wants_` are set: rings of half a minute, frames, tools that follow
/// their scripts.
/// @param simulation  of the session's scene, with which the loop begins
void reserve(LiveLoop& loop, Session& session, Simulation& simulation);

/// Does what was asked since the last call. Allocates nothing.
void take_commands(LiveLoop& loop);

/// One period of the clock: commands, poses, a step unless paused, and what goes out.
/// Allocates nothing, takes no lock.
/// @param late_us  how late the period began, us
void live_tick(LiveLoop& loop, double late_us);

/// The physics thread: ticks on the clock until `stop` or the last step.
void run_live(LiveLoop& loop);

}  // namespace torsion::engine
