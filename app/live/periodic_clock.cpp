#include "app/live/periodic_clock.hpp"

#include <algorithm>
#include <ctime>

namespace torsion::engine {
namespace {

constexpr Nanoseconds kSecond = 1'000'000'000;
// Wake-ups of a SCHED_FIFO thread beside full drawing: 99 % within 40-60 us.
constexpr Nanoseconds kSpin = 60'000;

}  // namespace

Nanoseconds monotonic_now() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return Nanoseconds{now.tv_sec} * kSecond + now.tv_nsec;
}

Nanoseconds begin_step(StepSchedule& schedule, Nanoseconds now) {
  const Nanoseconds late = now - schedule.due;
  const Nanoseconds behind = late / schedule.period - StepSchedule::kMostBehind;
  if (behind > 0) {
    schedule.skipped += static_cast<std::uint64_t>(behind);
    schedule.due += behind * schedule.period;
  }
  schedule.due += schedule.period;
  return late;
}

void follow_samples(StepSchedule& schedule, Nanoseconds arrived) {
  constexpr Nanoseconds kCatchUp = 16;         // steps: a sample's jitter counts that much less
  constexpr Nanoseconds kShareOfPeriod = 200;  // the most that a step moves it by is 1/200
  const Nanoseconds period = schedule.period;
  const Nanoseconds after = schedule.due - arrived - period / 10;
  const Nanoseconds past = ((after % period) + period) % period;
  const Nanoseconds off = past > period / 2 ? past - period : past;
  const Nanoseconds most = period / kShareOfPeriod;
  schedule.due -= std::clamp(off / kCatchUp, -most, most);
}

void wait_until(Nanoseconds due, bool spin) {
  const Nanoseconds wake = due - (spin ? kSpin : 0);
  const timespec until{wake / kSecond, wake % kSecond};
  if (wake > monotonic_now()) {
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) {
    }
  }
  while (spin && monotonic_now() < due) {
  }
}

}  // namespace torsion::engine
