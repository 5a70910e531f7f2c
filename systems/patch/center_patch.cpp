// The grid of a new region of contact model `patch`.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/contact/region_grid.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/band.hpp"
#include "systems/patch/grid.hpp"
#include "systems/patch/overlap_pass.hpp"

namespace torsion::engine {
namespace {

constexpr int kMostPasses = 12;
constexpr double kCentered = 1e-9;  // of the grid: so little is left to do
constexpr double kNearGrid = 2e-3;  // of the grid: so near, cells keep what they know of the tool

/// Whether passes converge.
class Progress {
 public:
  /// @param left  the residual, as a share of the grid
  void note(double left) {
    const bool nearer = left < kNearer * least_;
    stalled_ = nearer ? 0 : stalled_ + 1;
    blurred_ = !nearer && left < kBlurred;
    least_ = std::min(least_, left);
  }
  [[nodiscard]] bool is_at_end() const {
    return least_ < kCentered || blurred_ || stalled_ > kMostStalled;
  }
  /// Steps as along a staircase (the rim of a flat face moves by whole cells) do not converge.
  [[nodiscard]] bool stalls() const { return stalled_ > 2; }

 private:
  static constexpr double kNearer = 0.5;    // of what was left to do
  static constexpr double kBlurred = 1e-5;  // distances to a mesh may say no more
  static constexpr int kMostStalled = 5;

  double least_ = 1.0;
  int stalled_ = 0;
  bool blurred_ = false;
};

/// How much a grid may grow in one pass: many samples in contact show already how large the contact
/// is.
double most_growth(const Grid& grid, const RegionPoints& contact) {
  constexpr std::ptrdiff_t kMany = 4;
  const auto own = [&contact](const ContactPoint& point) {
    return point.cluster == contact.cluster;
  };
  return std::ranges::count_if(points_of(grid.scratch, contact), own) < kMany ? 16.0 : 1.5;
}

/// By what factor a grid that cuts the contact off must grow (1 if none does), from the depth at
/// its edges, as if the depth fell with the square of the distance.
double growth_beyond_edges(const Grid& grid, const CellBits& covered, double most) {
  constexpr double kLeast = 1.25;
  constexpr double kShallow = 0.25;  // of the largest depth: the next pass finds that as well
  const std::uint32_t last = grid.side - 1;
  const std::uint32_t first = patch_spare(grid.side);
  double edge = -1.0;  // m: the depth of what is cut
  double deepest = 0.0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = first; i < grid.side; ++i) {
      const CellGeometry& cell = grid.cells[j * grid.side + i];
      const bool is_covered = (covered[j] >> i & 1U) != 0;
      const bool outermost = i == first || i == last || j == 0 || j == last;
      if (is_covered) {
        deepest = std::max(deepest, cell.depth);
        if (outermost && cell.coverage >= 1.0) {
          edge = std::max(edge, cell.depth);
        }
      }
    }
  }
  if (edge <= kShallow * deepest) {
    return 1.0;
  }
  const double fall = 1.0 - edge / deepest;
  return fall > 0.0 ? std::clamp(kGridMargin / std::sqrt(fall), kLeast, most) : most;
}

/// Half sides of a grid that holds the whole overlap on both sides of its middle. A grid that cuts
/// it off sees a smaller overlap, and passes would not leave that state.
glm::dvec2 half_size_around(const Grid& grid, const glm::dvec2& middle, const PlaneBox& box) {
  const glm::dvec2 reach = glm::max(box.highest - middle, middle - box.lowest);
  const glm::dvec2 least = kGridMargin * glm::max(reach, glm::dvec2(kSmallestHalf));
  // Cells are made longer only where the overlap is longer by more than a doubling and a half:
  // otherwise they might alternate between two shapes.
  constexpr double kLonger = 0.6;  // of a doubling
  const std::int32_t now = table_aspect(grid.frame.half_size);
  const std::int32_t wanted = table_aspect(least);
  const bool longer = std::abs(wanted) > std::abs(now);
  const bool keeps = longer && std::abs(std::log2(least.x / least.y) - now) < kLonger;
  return tabulated_half_size(least, keeps ? now : wanted);
}

/// Passes over a grid with constant axes until it lies around the contact.
/// @return whether that is a narrow band, along which it lies then
bool find_middle(const Grid& grid, const RegionPoints& contact, double start_depth) {
  const glm::dvec2 off = middle_in_grid(grid.side);
  grid.frame.half_size = glm::dvec2(std::max(grid.frame.half_size.x, grid.frame.half_size.y));
  const double most = most_growth(grid, contact);
  FixedPoint seeker;
  Progress progress;
  bool seen_whole = false;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const CellBits covered = find_cells(grid, contact);
    const PlaneBox box = covered_box(grid, covered);
    if (box.empty()) {
      return false;
    }
    const glm::dvec2 before = grid.frame.half_size;
    if (is_narrow_band(grid, covered)) {
      find_band(grid, contact, start_depth);
      return true;
    }
    // Until it has held the whole contact once: later passes cut off little of it.
    const double beyond = seen_whole ? 1.0 : growth_beyond_edges(grid, covered, most);
    seen_whole = beyond == 1.0;
    const glm::dvec2 middle = overlap_middle(grid);
    const glm::dvec2 half = beyond > 1.0 ? beyond * before : half_size_around(grid, middle, box);
    GridStep step{middle - off * half, half - before};
    if (beyond > 1.0) {
      seeker.forget();
    } else {
      progress.note(largest_share(step, half));
      if (progress.is_at_end()) {
        return false;
      }
      if (progress.stalls() || table_aspect(half) != table_aspect(before)) {
        seeker.forget();
      } else {
        step = seeker.next(step);
      }
    }
    lay(grid, step.shift, glm::max(before + step.growth, kLeastShare * before));
    turn_normal_to(grid.frame, body_normal(grid, grid.frame.origin));
    if (largest_share(step, before) > kNearGrid) {
      restart_heights(grid, start_depth);
    }
  }
  find_cells(grid, contact);
  return false;
}

}  // namespace

void center_patch(const Grid& grid, const RegionPoints& contact, double start_depth) {
  const bool is_band = find_middle(grid, contact, start_depth);
  const ContactAxes axes = contact_axes(grid, covered_moments(grid));
  if (!is_band && axes.is_askew()) {
    turn_axes(grid.frame, axes.angle);
    // What fits along the grid's diagonal then fits along its sides.
    grid.frame.half_size *= std::numbers::sqrt2;
    restart_heights(grid, start_depth);
    find_middle(grid, contact, start_depth);
  }
  if (axes.is_long() && is_wide(grid, kCellsBetweenRims)) {
    lay_along_contact(grid, contact, start_depth, glm::dvec2(0.0));
    restart_heights(grid, start_depth);
    find_cells(grid, contact);
  }
}

}  // namespace torsion::engine
