#include "systems/patch/overlap_pass.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "systems/contact/region_grid.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

GridStep operator+(GridStep a, const GridStep& b) {
  return a += b;
}

GridStep operator*(double scale, const GridStep& step) {
  return {scale * step.shift, scale * step.growth};
}

double product(const GridStep& a, const GridStep& b) {
  return glm::dot(a.shift, b.shift) + glm::dot(a.growth, b.growth);
}

}  // namespace

GridStep FixedPoint::next(const GridStep& left) {
  if (any_) {
    std::swap(changes_[0], changes_[1]);
    changes_[0] = {step_, left + -1.0 * left_};
    count_ = std::min<std::size_t>(count_ + 1, changes_.size());
  }
  any_ = true;
  left_ = left;
  step_ = left;
  GridStep rest = left;
  // By Gram and Schmidt: each change of the residual removes its component. The older change is
  // made normal to the newer one first.
  std::array<Change, 2> normal = changes_;
  for (std::size_t k = 0; k < count_; ++k) {
    for (std::size_t before = 0; before < k; ++before) {
      const double part = product(normal[k].left, normal[before].left) /
                          product(normal[before].left, normal[before].left);
      normal[k].left += -part * normal[before].left;
      normal[k].step += -part * normal[before].step;
    }
    const double square = product(normal[k].left, normal[k].left);
    if (square <= kSame * product(changes_[k].left, changes_[k].left) || square == 0.0) {
      count_ = k;
      break;
    }
    const double part = product(rest, normal[k].left) / square;
    rest += -part * normal[k].left;
    step_ += -part * (normal[k].step + normal[k].left);
  }
  if (product(step_, step_) > kFarthest * kFarthest * product(left, left)) {
    step_ = left;
  }
  return step_;
}

double largest_share(const GridStep& step, const glm::dvec2& half_size) {
  const glm::dvec2 share = glm::max(glm::abs(step.shift), glm::abs(step.growth)) / half_size;
  return std::max(share.x, share.y);
}

glm::dvec2 overlap_middle(const Grid& grid) {
  double sum = 0.0;
  glm::dvec2 moment(0.0);
  double covered = 0.0;
  glm::dvec2 moment_of_covered(0.0);
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const double weight = grid.cells[cell].coverage * std::max(grid.cells[cell].depth, 0.0);
      const glm::dvec2 center = cell_center(grid.frame, grid.side, i, j);
      sum += weight;
      moment += weight * center;
      covered += grid.cells[cell].coverage;
      moment_of_covered += grid.cells[cell].coverage * center;
    }
  }
  if (sum > 0.0) {
    return moment / sum;
  }
  // What is narrower than a cell may be deep at no cell's centre.
  return covered > 0.0 ? moment_of_covered / covered : glm::dvec2(0.0);
}

bool is_wide(const Grid& grid, double least) {
  const ContactAxes axes = contact_axes(grid, covered_moments(grid));
  const glm::dvec2 cell = 2.0 * cell_half_size(grid);
  return !axes.is_long() ||
         axes.allowance * glm::length(axes.size) > least * std::min(cell.x, cell.y);
}

}  // namespace torsion::engine
