#pragma once

// Passes over the grid of a new region: what they see of the overlap, and how they move the grid.

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>

#include "systems/contact/grid_cells.hpp"

namespace torsion::engine {

/// How a pass moves and resizes a grid, in its plane, m.
struct GridStep {
  glm::dvec2 shift{0.0};
  glm::dvec2 growth{0.0};  // of the half sides

  GridStep& operator+=(const GridStep& other) {
    shift += other.shift;
    growth += other.growth;
    return *this;
  }
};

/// Solves x = g(x) from the residuals g(x) - x at the places visited (Anderson, J. ACM 12 (1965)
/// 547, with the last two steps): on meshes, each plain pass leaves three quarters of the residual.
class FixedPoint {
 public:
  /// @param left  residual at the place to which the last step has led
  /// @return the step to take
  GridStep next(const GridStep& left);

  void forget() {
    count_ = 0;
    any_ = false;
  }

 private:
  static constexpr double kSame = 1e-4;     // of a change's square: it says nothing that is new
  static constexpr double kFarthest = 8.0;  // times what is left

  struct Change {
    GridStep step;  // gone
    GridStep left;  // how much more there is left to do then
  };
  std::array<Change, 2> changes_;  // the last one first
  std::size_t count_ = 0;
  GridStep left_;
  GridStep step_;
  bool any_ = false;
};

/// The larger of a step's parts, over the grid's half sides.
double largest_share(const GridStep& step, const glm::dvec2& half_size);

inline constexpr double kLeastShare = 1.0 / 32;  // of its size, that a grid has after a pass

/// Middle of the overlap in the grid's plane, weighted with its depth, m.
glm::dvec2 overlap_middle(const Grid& grid);

inline constexpr double kCellsBetweenRims = 2.0;  // at least, where rims run between cells

/// Whether the overlap, if it is long, is wider than so many cells.
bool is_wide(const Grid& grid, double least);

}  // namespace torsion::engine
