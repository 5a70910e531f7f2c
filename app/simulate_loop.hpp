#pragma once

#include "app/progress.hpp"
#include "app/run_statistics.hpp"
#include "app/session.hpp"
#include "app/trace.hpp"

namespace torsion {

/// Steps as fast as they go. `trace` may be null.
RunStatistics run_fast(Session& session, std::uint64_t steps, TraceWriter* trace,
                       Progress& progress);

/// Steps on the clock, one period apart, each at an absolute time. Nothing but the step happens in
/// this thread: rows go through a ring to a thread that writes them.
RunStatistics run_realtime(Session& session, std::uint64_t steps, TraceWriter* trace,
                           Progress& progress);

}  // namespace torsion
