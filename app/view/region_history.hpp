#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ecs/snapshot.hpp"

namespace torsion::engine {

/// One region of a tool at one time.
struct RegionPoint {
  std::uint64_t order = 0;    // of its formation, as RegionIdentity has it
  double normal_force = 0.0;  // N
  double couple = 0.0;        // N m: about the normal, on the tool
  double stick_share = 0.0;   // of the area
};

/// The last seconds of the regions of one tool, as often as pictures are drawn. Fixed memory; the
/// oldest goes first.
class RegionHistory {
 public:
  static constexpr std::size_t kMoments = 1024;
  static constexpr std::size_t kMost = 10;  // regions at a time, the oldest
  static constexpr double kPeriod = 16e-3;  // s: between moments

  struct Moment {
    double time = 0.0;  // s
    std::size_t count = 0;
    std::array<RegionPoint, kMost> regions;
    [[nodiscard]] std::span<const RegionPoint> span() const { return {regions.data(), count}; }
  };

  void add(const Snapshot& snapshot, std::uint32_t tool);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// @param i  0: the oldest
  [[nodiscard]] const Moment& operator[](std::size_t i) const {
    return moments_[(first_ + i) % kMoments];
  }

 private:
  std::vector<Moment> moments_ = std::vector<Moment>(kMoments);
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace torsion::engine
