#include "systems/patch/loaded_cells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/mat2x2.hpp>
#include <glm/vector_relational.hpp>

#include "systems/math/frames.hpp"
#include "systems/patch/grid.hpp"

namespace torsion::engine {
namespace {

glm::dmat2 rotation_by(double angle) {
  return {std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)};
}

}  // namespace

LoadedArea loaded_cells(const Grid& grid, double least) {
  const auto tractions = grid.state.cells.rows<CellTraction>(grid.identity.cells);
  const auto side = static_cast<int>(grid.side);
  LoadedArea loaded{{{side, side}, {0, 0}}, {}, {}};
  for (int j = 0; j < side; ++j) {
    const CellTraction* const row = &tractions[static_cast<std::size_t>(j * side)];
    const CellGeometry* const places = &grid.cells[static_cast<std::size_t>(j * side)];
    std::uint64_t bits = 0;
    for (int i = 0; i < side; ++i) {
      bits |= static_cast<std::uint64_t>(is_loaded(row[i], places[i], least)) << i;
    }
    loaded.cells[static_cast<std::size_t>(j)] = bits;
    for (std::uint64_t left = bits; left != 0;) {
      const int first = std::countr_zero(left);
      const int count = std::countr_one(left >> first);
      const int end = first + count;
      loaded.moments.add_run(first, count, j);
      loaded.box.first = glm::min(loaded.box.first, glm::ivec2(first, j));
      loaded.box.end = glm::max(loaded.box.end, glm::ivec2(end, j + 1));
      left = end < 64 ? left >> end << end : 0;
    }
  }
  return loaded;
}

bool reaches_edge(const Grid& grid, const CellBox& box) {
  const auto side = static_cast<int>(grid.side);
  const auto spare = static_cast<int>(patch_spare(grid.side));
  return box.first.x < 1 + spare || box.first.y < 1 || box.end.x > side - 1 || box.end.y > side - 1;
}

bool holds(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 cell = cell_size(grid);
  const glm::dvec2 spare(patch_spare(grid.side) * cell.x, 0.0);
  return glm::all(glm::greaterThan(box.lowest, cell + spare - grid.frame.half_size)) &&
         glm::all(glm::lessThan(box.highest, grid.frame.half_size - cell));
}

PlaneBox extent_of(const Grid& grid, const CellBox& box) {
  const glm::dvec2 half_side(0.5 * static_cast<double>(grid.side));
  return {cell_size(grid) * (glm::dvec2(box.first) - half_side),
          cell_size(grid) * (glm::dvec2(box.end) - half_side)};
}

PlaneBox extent_along(const Grid& grid, double least, double angle) {
  const auto tractions = grid.state.cells.rows<CellTraction>(grid.identity.cells);
  const glm::dmat2 turn = rotation_by(angle);
  const glm::dvec2 half = cell_half_size(grid);
  const glm::dvec2 beside = glm::max(glm::min(half.x * glm::abs(glm::dvec2(turn[0].x, turn[1].x)),
                                              half.y * glm::abs(glm::dvec2(turn[0].y, turn[1].y))),
                                     glm::dvec2(0.5 * std::min(half.x, half.y)));
  PlaneBox extent;
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      if (is_loaded(tractions[cell], grid.cells[cell], least)) {
        const glm::dvec2 at = cell_center(grid.frame, grid.side, i, j) * turn;
        extent.include(at - beside, at + beside);
      }
    }
  }
  return extent;
}

}  // namespace torsion::engine
