#pragma once

#include <vector>

#include "systems/geometry/distance.hpp"

namespace torsion::engine::test {

/// Memory for many points' distances at once.
class PointBatch {
 public:
  explicit PointBatch(std::span<const glm::dvec3> points)
      : count_(points.size()), memory_(7 * count_) {
    for (std::size_t i = 0; i < count_; ++i) {
      memory_[i] = points[i].x;
      memory_[count_ + i] = points[i].y;
      memory_[2 * count_ + i] = points[i].z;
    }
  }

  DistanceColumns columns() {
    return {column(0), column(1), column(2), column(3), column(4), column(5), column(6)};
  }

  [[nodiscard]] Distance at(std::size_t i) const {
    return {memory_[3 * count_ + i],
            {memory_[4 * count_ + i], memory_[5 * count_ + i], memory_[6 * count_ + i]}};
  }

 private:
  std::span<double> column(std::size_t k) { return std::span(memory_).subspan(k * count_, count_); }

  std::size_t count_;
  std::vector<double> memory_;
};

}  // namespace torsion::engine::test
