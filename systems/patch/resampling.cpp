#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "systems/math/frames.hpp"
#include "systems/patch/cells.hpp"
#include "systems/patch/grid.hpp"

namespace torsion::engine {
namespace {

/// The cells before the grid moved.
struct Before {
  std::span<const double> held_x, held_y;  // m
  std::span<const CellTraction> tractions;
  int side;
  int spare;  // columns that hold nothing

  [[nodiscard]] bool has(const glm::ivec2& cell) const {
    return cell.x >= spare && cell.y >= 0 && cell.x < side && cell.y < side;
  }
  [[nodiscard]] std::size_t index(const glm::ivec2& cell) const {
    return static_cast<std::size_t>(cell.y * side + cell.x);
  }
};

/// Rounds a place that is a cell's centre but for rounding to the centre, so that mirror images
/// fall on the same side.
glm::dvec2 on_centers(const glm::dvec2& place) {
  constexpr double kOnCenter = 1e-6;
  const glm::dvec2 nearest = glm::round(place);
  return {std::abs(place.x - nearest.x) < kOnCenter ? nearest.x : place.x,
          std::abs(place.y - nearest.y) < kOnCenter ? nearest.y : place.y};
}

/// Pressure and traction, interpolated between the four cells around a place; zero outside of the
/// grid.
CellTraction linear_traction(const Before& before, const glm::dvec2& place) {
  const glm::dvec2 low = glm::floor(place);
  const glm::dvec2 part = place - low;
  CellTraction result;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) {
      const glm::ivec2 at = glm::ivec2(low) + glm::ivec2(x, y);
      if (before.has(at)) {
        const double weight = (x == 0 ? 1.0 - part.x : part.x) * (y == 0 ? 1.0 - part.y : part.y);
        const CellTraction& from = before.tractions[before.index(at)];
        result.pressure += weight * from.pressure;
        result.traction += weight * from.traction;
        result.kinetic_share += weight * from.kinetic_share;
      }
    }
  }
  return result;
}

/// Catmull-Rom's weights at a place between the second and the third of four values.
std::array<double, 4> cubic_weights(double x) {
  return {x * (-0.5 + x * (1.0 - 0.5 * x)), 1.0 + x * x * (-2.5 + 1.5 * x),
          x * (0.5 + x * (2.0 - 1.5 * x)), x * x * (-0.5 + 0.5 * x)};
}

/// The displacement is smooth: interpolation by four points a direction keeps it, by two would
/// flatten it.
/// @return false if not all of them lie in the grid
bool cubic_held(const Before& before, const glm::dvec2& place, glm::dvec2& held) {
  const glm::dvec2 low = glm::floor(place);
  const glm::dvec2 part = place - low;
  const glm::ivec2 corner(low);
  const glm::ivec2 between(part.x > 0.0 ? 1 : 0, part.y > 0.0 ? 1 : 0);
  if (!before.has(corner - between) || !before.has(corner + 2 * between)) {
    return false;
  }
  const std::array<double, 4> along_x = cubic_weights(part.x);
  const std::array<double, 4> along_y = cubic_weights(part.y);
  held = glm::dvec2(0.0);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      const std::size_t cell = before.index(corner + between * glm::ivec2(x - 1, y - 1));
      held += along_x[static_cast<std::size_t>(x)] * along_y[static_cast<std::size_t>(y)] *
              glm::dvec2(before.held_x[cell], before.held_y[cell]);
    }
  }
  return true;
}

/// How the loaded cells around a place slip.
struct Slip {
  glm::dvec2 along{0.0};  // unit: of the traction on the tool; zero where they stick
  double kinetic_share = 0.0;
};

/// From the nearest loaded cells: linear between those next to the place, and beyond the contact's
/// rim from those up to two cells away.
Slip slip_at(const Before& before, const glm::dvec2& place) {
  constexpr double kReach = 2.0;        // cells
  constexpr double kFar = 1e-6;         // what a cell that is not next to the place counts
  constexpr double kMost = 1.0 + 1e-6;  // half and half sticks, whatever the rounding
  const glm::ivec2 low(glm::floor(place));
  double weights = 0.0;
  double slips = 0.0;
  Slip result;
  for (int y = -1; y <= 2; ++y) {
    for (int x = -1; x <= 2; ++x) {
      const glm::ivec2 at = low + glm::ivec2(x, y);
      if (!before.has(at) || before.tractions[before.index(at)].pressure <= 0.0) {
        continue;
      }
      const CellTraction& from = before.tractions[before.index(at)];
      const glm::dvec2 away = glm::abs(glm::dvec2(at) - place);
      // All cells that are nearer than the reach along both axes are among the sixteen.
      const double near = std::max(1.0 - away.x, 0.0) * std::max(1.0 - away.y, 0.0);
      const double far = std::max(kReach - away.x, 0.0) * std::max(kReach - away.y, 0.0);
      const double weight = near + kFar * far;
      weights += weight;
      result.kinetic_share += weight * from.kinetic_share;
      if (from.sticks == 0) {
        slips += weight;
        const double size = glm::length(from.traction);
        result.along += size > 0.0 ? weight / size * from.traction : glm::dvec2(0.0);
      }
    }
  }
  const double size = glm::length(result.along);
  if (weights > 0.0) {
    result.kinetic_share /= weights;
  }
  result.along =
      2.0 * slips > kMost * weights && size > 0.0 ? result.along / size : glm::dvec2(0.0);
  return result;
}

}  // namespace

CellMove move_between(const RegionFrame& before, const RegionFrame& now, std::uint32_t side) {
  CellMove move;
  move.turn = glm::dmat2(
      glm::dot(before.tangent_x, now.tangent_x), glm::dot(before.tangent_y, now.tangent_x),
      glm::dot(before.tangent_x, now.tangent_y), glm::dot(before.tangent_y, now.tangent_y));
  const glm::dvec2 old_cell = 2.0 / static_cast<double>(side) * before.half_size;
  const glm::dvec2 cell = 2.0 / static_cast<double>(side) * now.half_size;
  const double middle = 0.5 * (static_cast<double>(side) - 1.0);
  const glm::dvec2 origin(body_to_grid(before, now.origin));
  move.by = glm::dmat2(move.turn[0] * cell.x / old_cell, move.turn[1] * cell.y / old_cell);
  move.origin = origin / old_cell + middle - move.by * glm::dvec2(middle);
  return move;
}

void move_cells(const Grid& grid, PatchScratch& scratch, const CellMove& move, double depth,
                double ahead) {
  const PatchRows rows = patch_rows(grid.state, grid.identity.cells);
  std::ranges::copy(rows.surface.held_x, scratch.held_before.x.begin());
  std::ranges::copy(rows.surface.held_y, scratch.held_before.y.begin());
  std::ranges::copy(rows.tractions, scratch.tractions_before.begin());
  const Before before{scratch.held_before.x, scratch.held_before.y, scratch.tractions_before,
                      static_cast<int>(grid.side), static_cast<int>(patch_spare(grid.side))};
  const glm::dmat2 to_new = glm::transpose(move.turn);
  grid.state.patch_cells.zero(grid.identity.cells);
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const glm::dvec2 here(static_cast<double>(i), static_cast<double>(j));
      const glm::dvec2 place = on_centers(move.origin + move.by * here);
      CellTraction traction = linear_traction(before, place);
      glm::dvec2 held(0.0);
      bool known = cubic_held(before, place, held);
      if (ahead > 0.0) {
        const Slip slip = slip_at(before, place);
        traction.kinetic_share = slip.kinetic_share;
        if (slip.along != glm::dvec2(0.0)) {
          traction.traction = glm::length(traction.traction) * slip.along;
          held -= ahead * slip.along;  // the traction on the tool is against its way
          known = true;
        }
      }
      traction.traction = to_new * traction.traction;
      held = to_new * held;
      rows.surface.held_x[cell] = held.x;
      rows.surface.held_y[cell] = held.y;
      rows.surface.known[cell] = known ? 1.0 : 0.0;
      rows.tractions[cell] = traction;
      grid.cells[cell].height = -depth;
    }
  }
}

void grow_pressures(const Grid& grid, const PatchScratch& scratch, const CellMove& move,
                    const glm::dvec2& middle, const glm::dvec2& ratio, double more) {
  const PatchRows rows = patch_rows(grid.state, grid.identity.cells);
  const Before before{{},
                      {},
                      scratch.tractions_before,
                      static_cast<int>(grid.side),
                      static_cast<int>(patch_spare(grid.side))};
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const glm::dvec2 here(static_cast<double>(i), static_cast<double>(j));
      const glm::dvec2 place = middle + (move.origin + move.by * here - middle) / ratio;
      rows.tractions[cell].pressure = more * linear_traction(before, on_centers(place)).pressure;
    }
  }
}

void add_cells(const Grid& grid, const CellMove& move, std::span<const CellTraction> others) {
  const Before before{
      {}, {}, others, static_cast<int>(grid.side), static_cast<int>(patch_spare(grid.side))};
  const PatchRows rows = patch_rows(grid.state, grid.identity.cells);
  const glm::dmat2 to_new = glm::transpose(move.turn);
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const glm::dvec2 here(static_cast<double>(i), static_cast<double>(j));
      const CellTraction more = linear_traction(before, on_centers(move.origin + move.by * here));
      CellTraction& traction = rows.tractions[cell];
      if (more.pressure > traction.pressure) {
        traction = more;
        traction.traction = to_new * more.traction;
      }
    }
  }
}

}  // namespace torsion::engine
