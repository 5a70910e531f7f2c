#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/contact/region_grid.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/grid.hpp"

namespace torsion::engine {
namespace {

constexpr double kFill = 0.81;       // of a new grid by the cells with pressure
constexpr double kLeastFill = 0.62;  // likewise, so that it is not at once found too large
constexpr double kSharp = 1.25;      // overlap over what is loaded: a round contact has 1.4
constexpr double kRectangularOverlap = 0.85;  // of its box is covered; of an ellipse's 0.79

glm::dvec2 origin_shift(const PlaneBox& box, const glm::dvec2& middle_cell, const glm::dvec2& cell,
                        std::uint32_t side) {
  return 0.5 * (box.lowest + box.highest) - (middle_cell - 0.5 * static_cast<double>(side)) * cell;
}

/// How many cells lie between the rims, and their shape.
struct CellsBetween {
  double x = 1.0;
  double y = 1.0;
  std::int32_t aspect = 0;
};

/// The cell counts for which the error of the rims along y is smallest while the rims along x are
/// exact, and which are many.
CellsBetween choose_cells(const glm::dvec2& size, std::uint32_t side) {
  constexpr double kCoarse = 0.3;  // relative error of the torque per cell's width over the contact
  constexpr double kKnown = 0.02;  // relative: the rims are not known better
  const double most = std::floor(fill_of_new(side) * static_cast<double>(side));
  const double least = kLeastFill * static_cast<double>(side);
  CellsBetween best;
  double least_cost = 1e300;
  for (std::int32_t aspect = -kMostAspect; aspect <= kMostAspect; ++aspect) {
    for (double x = 1.0; x <= most; x += 1.0) {
      const double wanted = size.y / size.x * x * std::ldexp(1.0, aspect);
      const double y = std::max(std::round(wanted), 1.0);
      if (y > most || std::max(x, y) < least) {
        continue;
      }
      const double cost =
          std::max(std::abs(wanted - y) / y, kKnown) + kCoarse * (1.0 / x + 1.0 / y);
      if (cost < least_cost) {
        least_cost = cost;
        best = {x, y, aspect};
      }
    }
  }
  return best;
}

/// Place of the middle of so many cells, counted from the corner, for which rims fall between
/// cells.
double middle_of(double cells, double wanted) {
  return std::round(wanted - 0.5 * cells) + 0.5 * cells;
}

/// Whether the covered cells cover so much of their box as those of a punch with straight rims.
bool cover_their_box(const Grid& grid, double covered, const PlaneBox& box) {
  const glm::dvec2 size = box.highest - box.lowest;
  return covered * cell_area(grid.frame, grid.side) > kRectangularOverlap * size.x * size.y;
}

}  // namespace

double fill_of_new(std::uint32_t side) {
  constexpr double kLess = 0.04;  // of a cell
  const double free = static_cast<double>(patch_spare(side)) + 1.0 + kLess;
  return std::min(kFill, std::max(1.0 - free / static_cast<double>(side), 0.5));
}

GridLayout layout_around(const PlaneBox& loaded, std::uint32_t side) {
  const glm::dvec2 half = 0.5 * (loaded.highest - loaded.lowest);
  const glm::dvec2 half_size = tabulated_half_size(half / fill_of_new(side));
  return {half_size, origin_shift(loaded, patch_middle(side),
                                  2.0 * half_size / static_cast<double>(side), side)};
}

GridLayout layout_between_rims(const PlaneBox& covered, bool sharp_x, bool sharp_y,
                               std::uint32_t side) {
  // An overlap that is thinner than the longest cells allow leaves room beside it.
  const glm::dvec2 covers = covered.highest - covered.lowest;
  const glm::dvec2 size =
      glm::max(covers, glm::dvec2(std::ldexp(std::max(covers.x, covers.y), -kMostAspect)));
  const double most = std::floor(fill_of_new(side) * static_cast<double>(side));
  CellsBetween cells{most, most, 0};
  glm::dvec2 cell = size / most;
  if (sharp_x && sharp_y) {
    cells = choose_cells(size, side);
    cell.x = size.x / cells.x;
    cell.y = std::ldexp(cell.x, -cells.aspect);
  } else {
    const double ratio = std::log2(cell.x / cell.y);
    // The other axis takes the size that the cells' shape leaves, but at least what it needs.
    const auto aspect = static_cast<std::int32_t>(std::clamp(
        sharp_x ? std::floor(ratio) : std::ceil(ratio), -1.0 * kMostAspect, 1.0 * kMostAspect));
    (sharp_x ? cell.y : cell.x) = std::ldexp(sharp_x ? cell.x : cell.y, sharp_x ? -aspect : aspect);
  }
  const glm::dvec2 wanted = patch_middle(side);
  const glm::dvec2 middle(sharp_x ? middle_of(cells.x, wanted.x) : wanted.x,
                          sharp_y ? middle_of(cells.y, wanted.y) : wanted.y);
  return {0.5 * static_cast<double>(side) * cell, origin_shift(covered, middle, cell, side)};
}

void lay_along_contact(const Grid& grid, const RegionPoints& contact, double depth,
                       const glm::dvec2& loaded) {
  restart_heights(grid, depth);
  CellBits covered = find_cells(grid, contact);
  CellMoments moments = covered_moments(grid);
  ContactAxes axes = contact_axes(grid, moments);
  if (std::abs(axes.angle) > kAligned * axes.allowance) {
    turn_axes(grid.frame, axes.angle);
    restart_heights(grid, depth);
    covered = find_cells(grid, contact);
    moments = covered_moments(grid);
    axes = contact_axes(grid, moments);
  }
  const PlaneBox box = covered_box(grid, covered);
  if (box.empty() || !cover_their_box(grid, moments.weight, box)) {
    return;
  }
  const bool sharp_x = loaded.x == 0.0 || axes.size.x < kSharp * loaded.x;
  const bool sharp_y = loaded.y == 0.0 || axes.size.y < kSharp * loaded.y;
  if (!sharp_x && !sharp_y) {
    return;
  }
  // The pressure ends in the middle of a wider overlap.
  const glm::dvec2 half(sharp_x ? 0.5 * axes.size.x : 0.5 * loaded.x,
                        sharp_y ? 0.5 * axes.size.y : 0.5 * loaded.y);
  const GridLayout layout =
      layout_between_rims({axes.middle - half, axes.middle + half}, sharp_x, sharp_y, grid.side);
  shift_origin(grid, layout.shift);
  grid.frame.half_size = layout.half_size;
}

void shift_origin(const Grid& grid, const glm::dvec2& shift) {
  const glm::dvec3 before = grid.frame.origin;
  lay(grid, shift, grid.frame.half_size);
  const double turn = glm::length(grid.carrier.rotation);
  if (turn > 0.0) {
    const glm::dvec3 way = grid.frame.origin - before;
    grid.carrier.translation += glm::angleAxis(turn, grid.carrier.rotation / turn) * way - way;
  }
}

}  // namespace torsion::engine
