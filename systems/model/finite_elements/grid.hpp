#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "systems/model/finite_elements/compliance.hpp"

namespace torsion::engine {

/// Hexahedra of a lattice that fills a solid, with the surface's nodes moved onto its surface.
struct SolidGrid {
  std::vector<glm::dvec3> nodes;                       // m, body
  std::vector<glm::uvec3> lattice;                     // of each node: where it is in the lattice
  std::vector<std::uint8_t> clamped;                   // of each node
  std::vector<std::array<std::uint32_t, 8>> elements;  // corner c is at x + (c & 1), y + (c >> 1 &
                                                       // 1), z + (c >> 2)
  std::vector<std::array<std::uint32_t, 4>> faces;     // of the surface, counter-clockwise from
                                                       // outside
  glm::dvec3 spacing{0.0};                             // m, of the lattice
};

/// Marks the grid's clamped nodes and moves those around the clamp's end onto it, so that the clamp
/// does not end where the lattice happens to. (model/finite_elements/clamp.cpp)
void fit_clamp(const ElasticSolid& solid, SolidGrid& grid);

/// Whether no part of an element is squashed to less than a fiftieth of the lattice's cells.
bool is_sound(const SolidGrid& grid, std::size_t element);

/// Cells of a lattice fitted to the solid's bounds whose centres are inside, as far as they hang
/// together by faces (the largest such piece). At least eight cells along each side.
/// @param elements  along the longest side
/// @return an Error as build_smooth_compliance has it
Result<SolidGrid> build_solid_grid(const ElasticSolid& solid, std::uint32_t elements);

/// Derivatives of the position by the element's own coordinates, columns, at `local` in [-1, 1]^3.
glm::dmat3 element_jacobian(const std::array<glm::dvec3, 8>& corners, const glm::dvec3& local);

/// Derivatives of the corners' weights by the position, 1/m, where the jacobian is `jacobian`.
std::array<glm::dvec3, 8> corner_slopes(const glm::dmat3& jacobian, const glm::dvec3& local);

/// Corners of an element's sides (-x, +x, -y, ...), counter-clockwise from outside.
inline constexpr std::array<std::array<std::uint32_t, 4>, 6> kElementSides{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

/// The corners of element `element`.
std::array<glm::dvec3, 8> element_corners(const SolidGrid& grid, std::size_t element);

}  // namespace torsion::engine
