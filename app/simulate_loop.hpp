#pragma once

#include <cstdint>
#include <functional>

#include "app/live/device_link.hpp"
#include "app/live/interrupt.hpp"
#include "app/live/realtime_mode.hpp"
#include "app/live/recording_file.hpp"
#include "app/progress.hpp"
#include "app/region_trace.hpp"
#include "app/run_statistics.hpp"
#include "app/session.hpp"
#include "app/trace.hpp"

namespace torsion::engine {

/// What a run without a window reads and writes; each may be null.
struct RunFiles {
  const Interrupt* interrupt = nullptr;  // ends the run early; what was written so far stays
  TraceWriter* trace = nullptr;
  RegionTrace* regions = nullptr;  // not on the clock
  RecordingWriter* record = nullptr;
  /// Who looks at the session after each step, by its number; may be empty. Not on the clock.
  std::function<void(const Session& session, std::uint64_t step)> watch;
  Replay* replay = nullptr;  // where poses come from instead of the scene's animations
  bool quiet = false;
};

/// Devices that hold a tool in a run on the clock; null without.
struct RunDevice {
  DeviceLink* link = nullptr;
  std::uint32_t tool = 0;
  ToolHold hold = ToolHold::kMassless;
};

/// Steps as fast as they go. Fails only where a replay switches to models that cannot be prepared.
Result<RunStatistics> run_fast(Session& session, std::uint64_t steps, const RunFiles& files,
                               Progress& progress);

/// Steps on the clock, in a thread of its own in which nothing but that happens: rows and inputs go
/// through rings to this thread, which writes them. No replay.
/// @param mode  out: what the system granted that thread
RunStatistics run_realtime(Session& session, std::uint64_t steps, const RunFiles& files,
                           const RunDevice& device, Progress& progress, RealtimeMode& mode);

}  // namespace torsion::engine
