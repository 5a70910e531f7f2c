#include "systems/patch/band.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

#include "systems/contact/region_grid.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/grid.hpp"
#include "systems/patch/growth.hpp"
#include "systems/patch/overlap_pass.hpp"

namespace torsion::engine {
namespace {

constexpr double kFound = 1e-6;  // of the grid: so little is left to do; cells often tell no more
constexpr double kLeastAngle = 1e-9;  // rad: likewise
constexpr double kCellsAcross = 3.0;  // a band: from so many its direction can be told
constexpr double kCellsTurned = 1.5;  // likewise, where it lies nearly along the grid
constexpr double kBand = 0.2;  // width over length: of a contact that is longer than its grid

/// Lays a square grid's y along a band: the band's middle then runs through the middle of a column
/// (patch_middle), where even cells that are wider than the band see how deep it is.
void turn_along(const Grid& grid, const ContactAxes& axes) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  turn_axes(grid.frame, axes.size.x > axes.size.y ? axes.angle + kQuarter : axes.angle);
}

/// The middle of the deepest of the covered cells, m.
glm::dvec2 deepest_cell(const Grid& grid) {
  glm::dvec2 deepest(0.0);
  double depth = -1e300;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      if (grid.cells[cell].coverage > 0.0 && grid.cells[cell].depth > depth) {
        depth = grid.cells[cell].depth;
        deepest = cell_center(grid.frame, grid.side, i, j);
      }
    }
  }
  return deepest;
}

/// Makes a grid square and so small that the band is some cells wide, and finds its cells.
void shrink_onto_band(const Grid& grid, const RegionPoints& contact, double start_depth) {
  constexpr int kPasses = 4;
  constexpr double kSmaller = 0.25;
  const glm::dvec2 half(std::min(grid.frame.half_size.x, grid.frame.half_size.y));
  lay(grid, glm::dvec2(0.0), half);
  restart_heights(grid, start_depth);
  find_cells(grid, contact);
  for (int pass = 0; pass < kPasses && !is_wide(grid, kCellsAcross); ++pass) {
    const RegionFrame before = grid.frame;
    lay(grid, deepest_cell(grid), kSmaller * grid.frame.half_size);
    restart_heights(grid, start_depth);
    if (covered_box(grid, find_cells(grid, contact)).empty()) {
      grid.frame = before;
      restart_heights(grid, start_depth);
      find_cells(grid, contact);
      return;
    }
  }
}

/// The lengths, as half sides, between which a grid that just holds a band lies.
class LengthBracket {
 public:
  /// @param cut  whether a grid of this length cuts the band off
  void note(double half_length, bool cut) {
    (cut ? longest_cut_ : shortest_whole_) =
        cut ? std::max(longest_cut_, half_length) : std::min(shortest_whole_, half_length);
  }
  /// The length itself, or one between the limits: at the edge of a grid that cuts it off, a band
  /// does not tell how much longer it is, and cells that are as long as the band not how long.
  [[nodiscard]] double within(double half_length) const {
    const bool known = longest_cut_ > 0.0 && shortest_whole_ < kNone;
    return known && (half_length <= longest_cut_ || half_length >= shortest_whole_)
               ? std::sqrt(longest_cut_ * shortest_whole_)
               : half_length;
  }

 private:
  static constexpr double kNone = 1e300;

  double longest_cut_ = 0.0;
  double shortest_whole_ = kNone;
};

}  // namespace

bool is_narrow_band(const Grid& grid, const CellBits& covered) {
  constexpr double kLittle = 0.25;  // of the largest depth
  const ContactAxes axes = contact_axes(grid, covered_moments(grid));
  return axes.is_long() && axes.allowance < kBand &&
         (growth_at_edges(grid, covered, kLittle) != glm::dvec2(1.0) ||
          !is_wide(grid, kCellsBetweenRims));
}

void find_band(const Grid& grid, const RegionPoints& contact, double start_depth) {
  constexpr int kPasses = 10;
  constexpr double kLittle = 0.1;  // of the largest depth
  shrink_onto_band(grid, contact, start_depth);
  turn_along(grid, contact_axes(grid, covered_moments(grid)));
  restart_heights(grid, start_depth);
  FixedPoint seeker;
  LengthBracket lengths;
  for (int pass = 0; pass < kPasses; ++pass) {
    CellBits covered = find_cells(grid, contact);
    const ContactAxes axes = contact_axes(grid, covered_moments(grid));
    // Of a band that is narrower than its cells, those tell no angle.
    if (is_wide(grid, kCellsTurned) && std::abs(axes.angle) > kLeastAngle) {
      turn_axes(grid.frame, axes.angle);
      restart_heights(grid, start_depth);
      covered = find_cells(grid, contact);
    }
    const PlaneBox box = covered_box(grid, covered);
    if (box.empty()) {
      return;
    }
    const glm::dvec2 before = grid.frame.half_size;
    const glm::dvec2 growth = growth_at_edges(grid, covered, kLittle);
    const glm::dvec2 middle = overlap_middle(grid);
    const glm::dvec2 reach =
        glm::max(glm::max(box.highest - middle, middle - box.lowest), glm::dvec2(kSmallestHalf));
    lengths.note(before.y, growth.y > 1.0 || kGridMargin * reach.y > before.y);
    const glm::dvec2 half = tabulated_half_size(
        {growth.x > 1.0 ? growth.x * before.x : kGridMargin * reach.x,
         lengths.within(growth.y > 1.0 ? growth.y * before.y : kGridMargin * reach.y)});
    GridStep step{middle - middle_in_grid(grid.side) * half, half - before};
    const bool whole = growth == glm::dvec2(1.0);
    if (whole && largest_share(step, half) < kFound) {
      return;
    }
    if (whole && table_aspect(half) == table_aspect(before)) {
      step = seeker.next(step);
    } else {
      seeker.forget();
    }
    lay(grid, step.shift, glm::max(before + step.growth, kLeastShare * before));
    turn_normal_to(grid.frame, body_normal(grid, grid.frame.origin));
    restart_heights(grid, start_depth);
  }
  find_cells(grid, contact);
}

}  // namespace torsion::engine
