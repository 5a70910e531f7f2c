#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ecs/world.hpp"

namespace torsion {

/// A histogram of times with two bins to every doubling, from 1/8 us to over a second: fixed
/// memory, any number of entries.
class TimeHistogram {
 public:
  void add(double microseconds);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double largest() const { return largest_; }  // us
  /// The time below which this share of the entries lies, within a bin's width (41 %), us.
  [[nodiscard]] double quantile(double share) const;
  /// Lines "from - to: count" of the bins that are not empty.
  [[nodiscard]] std::string text() const;

  struct Bin {
    double from = 0.0;  // us
    double to = 0.0;    // us
    std::uint64_t count = 0;
  };
  /// The bins that are not empty, in order.
  [[nodiscard]] std::vector<Bin> bins() const;

 private:
  static constexpr std::size_t kBins = 48;
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double largest_ = 0.0;
};

/// What a run was like, gathered step by step without allocation.
struct RunStatistics {
  std::uint64_t steps = 0;
  std::uint64_t contact_steps = 0;
  TimeHistogram step_times;
  TimeHistogram lateness;  // of the start of a step on the clock; empty when not in real time
  std::uint64_t missed_deadlines = 0;  // periods that began more than 1 ms late
  std::uint64_t overruns = 0;          // steps that took longer than a period
  std::uint64_t lost_rows = 0;         // of the trace, when the disk could not follow
  std::uint64_t lost_inputs = 0;       // of the recording, likewise
  double wall_time = 0.0;              // s, all steps together
  std::uint32_t most_regions = 0;
  double peak_force = 0.0;   // N, largest over tools
  double peak_torque = 0.0;  // N m

  void add_step(const World& world, double step_us);
};

}  // namespace torsion
