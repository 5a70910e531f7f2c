#pragma once

#include <cstdint>

namespace torsion::engine {

/// Times on CLOCK_MONOTONIC, ns.
using Nanoseconds = std::int64_t;

Nanoseconds monotonic_now();

/// When the steps of a run are due: one period apart, at absolute times, so that lateness does not
/// add up. A run that falls behind makes up for at most kMostBehind periods; what is beyond moves
/// the rest of the schedule, because a thread that never sleeps starves the machine (and Linux
/// stops SCHED_FIFO threads that run for 0.95 s on end).
struct StepSchedule {
  static constexpr Nanoseconds kMostBehind = 4;  // periods
  Nanoseconds period = 1'000'000;
  Nanoseconds due = 0;        // of the next step
  std::uint64_t skipped = 0;  // periods by which the schedule was moved
};

/// The next step begins at `now`: how late it is [ns, negative: early], and the schedule goes on.
Nanoseconds begin_step(StepSchedule& schedule, Nanoseconds now);

/// Lets the schedule drift, by at most 0.5 % of the time, so that steps begin a tenth of a period
/// after the samples of a device of the same rate arrive: the answer is then ready when the next
/// sample comes. Where both clocks run free, a step that is under way at that moment answers a
/// whole period later.
/// @param arrived  when the newest sample did
void follow_samples(StepSchedule& schedule, Nanoseconds arrived);

/// Sleeps until `due`; with `spin` the last bit of it awake, which takes the wake-up's own delay
/// away at the cost of 6 % of a core at 1 kHz.
void wait_until(Nanoseconds due, bool spin);

}  // namespace torsion::engine
