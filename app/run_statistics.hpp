#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ecs/world.hpp"

namespace torsion::engine {

/// A histogram with two bins to every doubling, over 24 doublings: fixed memory, any number of
/// entries. What is below or above them is in the first bin or the last.
class Histogram {
 public:
  /// @param first  where the doublings begin, above 0
  explicit Histogram(double first) : first_(first) {}
  void add(double value);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double largest() const { return largest_; }
  /// The value below which this share of the entries lies, within a bin's width (41 %).
  [[nodiscard]] double quantile(double share) const;
  /// Lines "from - to: count" of the bins that are not empty, of times in us.
  [[nodiscard]] std::string text() const;

  struct Bin {
    double from = 0.0;
    double to = 0.0;
    std::uint64_t count = 0;
  };
  /// The bins that are not empty, in order.
  [[nodiscard]] std::vector<Bin> bins() const;

 private:
  static constexpr std::size_t kBins = 48;
  [[nodiscard]] double lower_edge(std::size_t bin) const;
  double first_;
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double largest_ = 0.0;
};

/// Where a histogram of times begins, us: with it it goes to over a second.
inline constexpr double kShortestTime = 0.125;
/// Where one of residuals begins: a change of a millionth of the pressure is nothing beside any
/// model's error.
inline constexpr double kLeastResidual = 1e-6;

/// How closely contact model patch solved its regions: an entry is one region in one step.
struct PatchStatistics {
  Histogram residuals{kLeastResidual};  // as in PatchState
  std::uint64_t iterations = 0;         // of all together
  std::uint32_t most_iterations = 0;

  void add(const PatchState& state);
  [[nodiscard]] std::uint64_t region_steps() const { return residuals.count(); }
  /// @pre region_steps() > 0
  [[nodiscard]] double mean_iterations() const;
};

/// How near the run was to where linear elasticity ends (systems/contact/strain.hpp).
struct StrainStatistics {
  std::uint64_t region_steps = 0;  // an entry is one region in one step
  std::uint64_t large = 0;         // those of more than kLargeTraction or kLargeTilt
  double most_traction = 0.0;      // over E*
  double most_tilt = 0.0;          // rad

  void add(const World& world, std::uint32_t region);
  /// @pre region_steps > 0
  [[nodiscard]] double large_share() const;
};

/// What a run was like, gathered step by step without allocation.
struct RunStatistics {
  std::uint64_t steps = 0;
  std::uint64_t contact_steps = 0;
  Histogram step_times{kShortestTime};  // us
  Histogram lateness{kShortestTime};    // us: of the start of a step on the clock; empty when not
                                        // in real time
  std::uint64_t missed_deadlines = 0;   // periods that began more than 1 ms late
  std::uint64_t overruns = 0;           // steps that took longer than a period
  std::uint64_t lost_rows = 0;          // of the trace, when the disk could not follow
  std::uint64_t lost_inputs = 0;        // of the recording, likewise
  double wall_time = 0.0;               // s, all steps together
  std::uint32_t snapshots = 0;          // timed beside the steps, which contain none
  double snapshot_us = 0.0;             // us, of all of them together
  double snapshot_step_us = 0.0;        // us, of the steps that they were taken of
  std::uint32_t most_regions = 0;
  double peak_force = 0.0;   // N, largest over tools
  double peak_torque = 0.0;  // N m
  PatchStatistics patch;     // empty when no region had that contact model
  StrainStatistics strain;

  void add_step(const World& world, double step_us);
};

}  // namespace torsion::engine
