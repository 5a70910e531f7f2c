#include "systems/model/finite_elements/grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "systems/geometry/bounds.hpp"

namespace torsion::engine {
namespace {

/// Cells and nodes of a lattice over the bounds, x fastest.
struct Lattice {
  glm::dvec3 lowest;   // m
  glm::dvec3 spacing;  // m
  glm::uvec3 cells;

  [[nodiscard]] std::size_t cell(const glm::uvec3& at) const {
    return (std::size_t{at.z} * cells.y + at.y) * cells.x + at.x;
  }
  [[nodiscard]] std::size_t node(const glm::uvec3& at) const {
    return (std::size_t{at.z} * (cells.y + 1) + at.y) * (cells.x + 1) + at.x;
  }
  [[nodiscard]] glm::uvec3 cell_at(std::size_t row) const {
    const auto flat = static_cast<std::uint32_t>(row);
    return {flat % cells.x, flat / cells.x % cells.y, flat / cells.x / cells.y};
  }
  [[nodiscard]] glm::dvec3 position(const glm::dvec3& at) const { return lowest + spacing * at; }
};

Lattice lattice_over(const Bounds& bounds, std::uint32_t elements) {
  const glm::dvec3 extent = bounds.highest - bounds.lowest;
  const double longest = std::max({extent.x, extent.y, extent.z});
  Lattice lattice{bounds.lowest, glm::dvec3(0.0), glm::uvec3(0)};
  for (int k = 0; k < 3; ++k) {
    lattice.cells[k] =
        std::max(kFewestLatticeCells,
                 static_cast<std::uint32_t>(std::lround(elements * extent[k] / longest)));
    lattice.spacing[k] = extent[k] / lattice.cells[k];
  }
  return lattice;
}

/// The cell beyond side `side` (0 to 5: -x, +x, -y, ...) of a cell, if the lattice has one.
bool step_over(const Lattice& lattice, std::uint32_t side, glm::uvec3& at) {
  const auto axis = static_cast<int>(side / 2);
  if (side % 2 == 0 ? at[axis] == 0 : at[axis] + 1 == lattice.cells[axis]) {
    return false;
  }
  at[axis] += side % 2 == 0 ? UINT32_MAX : 1U;
  return true;
}

/// Marks the largest piece of the solid's cells that hangs together by faces; empty if there is
/// none.
std::vector<std::uint8_t> largest_piece(const ElasticSolid& solid, const Lattice& lattice) {
  std::vector<std::uint32_t> piece(std::size_t{lattice.cells.x} * lattice.cells.y *
                                   lattice.cells.z);
  for (std::size_t row = 0; row < piece.size(); ++row) {
    const glm::dvec3 center = lattice.position(glm::dvec3(lattice.cell_at(row)) + glm::dvec3(0.5));
    piece[row] = solid.signed_distance(center).value < 0.0 ? 1 : 0;
  }
  std::uint32_t pieces = 1;  // 0: outside, 1: inside and not yet in a piece
  std::pair<std::size_t, std::uint32_t> largest{0, 0};
  std::vector<std::size_t> front;
  for (std::size_t first = 0; first < piece.size(); ++first) {
    if (piece[first] != 1) {
      continue;
    }
    piece[first] = ++pieces;
    std::size_t count = 0;
    front.assign(1, first);
    while (!front.empty()) {
      const glm::uvec3 here = lattice.cell_at(front.back());
      front.pop_back();
      ++count;
      for (std::uint32_t side = 0; side < 6; ++side) {
        glm::uvec3 next = here;
        if (step_over(lattice, side, next) && piece[lattice.cell(next)] == 1) {
          piece[lattice.cell(next)] = pieces;
          front.push_back(lattice.cell(next));
        }
      }
    }
    largest = std::max(largest, std::pair(count, pieces));
  }
  std::vector<std::uint8_t> inside;
  if (largest.first > 0) {
    inside.resize(piece.size());
    std::transform(piece.begin(), piece.end(), inside.begin(), [&](std::uint32_t p) {
      return static_cast<std::uint8_t>(p == largest.second ? 1 : 0);
    });
  }
  return inside;
}

/// The grid before its surface is moved; `sides` collects which way each node's faces look (bit k
/// for side k).
SolidGrid grid_of_cells(const Lattice& lattice, const std::vector<std::uint8_t>& inside,
                        std::vector<std::uint8_t>& sides) {
  SolidGrid grid;
  grid.spacing = lattice.spacing;
  const glm::uvec3 nodes = lattice.cells + 1U;
  std::vector<std::uint32_t> row_of_node(std::size_t{nodes.x} * nodes.y * nodes.z, kNoRow);
  for (std::size_t row = 0; row < inside.size(); ++row) {
    if (inside[row] == 0) {
      continue;
    }
    const glm::uvec3 at = lattice.cell_at(row);
    std::array<std::uint32_t, 8> corners{};
    for (std::uint32_t c = 0; c < 8; ++c) {
      const glm::uvec3 corner = at + glm::uvec3(c & 1U, c >> 1U & 1U, c >> 2U);
      std::uint32_t& node = row_of_node[lattice.node(corner)];
      if (node == kNoRow) {
        node = static_cast<std::uint32_t>(grid.nodes.size());
        grid.nodes.push_back(lattice.position(glm::dvec3(corner)));
        grid.lattice.push_back(corner);
        sides.push_back(0);
      }
      corners[c] = node;
    }
    grid.elements.push_back(corners);
    for (std::uint32_t side = 0; side < 6; ++side) {
      glm::uvec3 next = at;
      if (step_over(lattice, side, next) && inside[lattice.cell(next)] != 0) {
        continue;
      }
      std::array<std::uint32_t, 4> face{};
      for (std::size_t k = 0; k < 4; ++k) {
        face[k] = corners[kElementSides[side][k]];
        sides[face[k]] = static_cast<std::uint8_t>(sides[face[k]] | 1U << side);
      }
      grid.faces.push_back(face);
    }
  }
  return grid;
}

/// Where a surface node belongs. One that is on the surface already, in a flat end of the body,
/// may still have to move in that end's plane to its rim: seen from one cell further in, the rim's
/// side is the nearest surface.
glm::dvec3 on_surface(const ElasticSolid& solid, const Lattice& lattice, const glm::dvec3& start,
                      const glm::uvec3& at, std::uint32_t sides) {
  const double cell = std::min({lattice.spacing.x, lattice.spacing.y, lattice.spacing.z});
  const double longest = glm::length(lattice.spacing);
  glm::dvec3 point = start;
  for (int i = 0; i < 4; ++i) {
    const Distance distance = solid.signed_distance(point);
    if (!std::isfinite(distance.value) || std::abs(distance.value) > longest) {
      return start;
    }
    point -= distance.gradient * distance.value;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t own = 3U << static_cast<std::uint32_t>(2 * axis);
    const bool in_end = at[axis] == 0 || at[axis] == lattice.cells[axis];
    if (!in_end || (sides & ~own) == 0 || glm::distance(point, start) > 1e-9 * cell) {
      continue;
    }
    glm::dvec3 inner = point;
    inner[axis] += (at[axis] == 0 ? 1.0 : -1.0) * lattice.spacing[axis];
    for (int i = 0; i < 4; ++i) {
      const Distance distance = solid.signed_distance(inner);
      if (std::abs(distance.gradient[axis]) > 0.3 || std::abs(distance.value) > 0.9 * cell) {
        return point;
      }
      inner -= distance.gradient * distance.value;
    }
    inner[axis] = point[axis];
    if (std::abs(solid.signed_distance(inner).value) < 1e-3 * cell) {
      point = inner;
    }
  }
  return point;
}

/// The mean of each node's neighbours along edges of elements, or of faces.
template <std::size_t kCorners, class IsEdge>
std::vector<glm::dvec3> means_of_neighbours(
    const std::vector<glm::dvec3>& nodes,
    const std::vector<std::array<std::uint32_t, kCorners>>& pieces, const IsEdge& is_edge) {
  std::vector<glm::dvec3> mean(nodes.size(), glm::dvec3(0.0));
  std::vector<double> count(nodes.size(), 0.0);
  for (const std::array<std::uint32_t, kCorners>& piece : pieces) {
    for (std::size_t i = 0; i < kCorners; ++i) {
      for (std::size_t j = 0; j < kCorners; ++j) {
        if (is_edge(i ^ j)) {
          mean[piece[i]] += nodes[piece[j]];
          count[piece[i]] += 1.0;
        }
      }
    }
  }
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    mean[n] = count[n] > 0.0 ? mean[n] / count[n] : nodes[n];
  }
  return mean;
}

/// Which surface nodes have a smooth surface around them, so that they may slide on it.
std::vector<std::uint8_t> nodes_that_slide(const ElasticSolid& solid, const SolidGrid& grid) {
  std::vector<glm::dvec3> normals;  // of faces
  for (const std::array<std::uint32_t, 4>& face : grid.faces) {
    const glm::dvec3 center = 0.25 * (grid.nodes[face[0]] + grid.nodes[face[1]] +
                                      grid.nodes[face[2]] + grid.nodes[face[3]]);
    normals.push_back(solid.signed_distance(center).gradient);
  }
  std::vector<std::uint32_t> first(grid.nodes.size(), kNoRow);  // face at each node
  std::vector<std::uint8_t> slides(grid.nodes.size(), 0);
  for (std::uint32_t row = 0; row < grid.faces.size(); ++row) {
    for (const std::uint32_t node : grid.faces[row]) {
      if (first[node] == kNoRow) {
        first[node] = row;
        slides[node] = 1;
      } else if (glm::dot(normals[first[node]], normals[row]) < 0.7) {
        slides[node] = 0;
      }
    }
  }
  return slides;
}

/// Evens out the cells that the moved surface has squeezed: its nodes slide towards the middle of
/// their neighbours and back onto it, those inside go to the middle of theirs. An even lattice
/// stays as it is.
void even_out(const ElasticSolid& solid, const std::vector<std::uint8_t>& sides, SolidGrid& grid) {
  constexpr int kSweeps = 12;
  const std::vector<std::uint8_t> slides = nodes_that_slide(solid, grid);
  for (int iteration = 0; iteration < kSweeps; ++iteration) {
    const std::vector<glm::dvec3> on_faces = means_of_neighbours(
        grid.nodes, grid.faces, [](std::size_t apart) { return apart == 1 || apart == 3; });
    for (std::size_t n = 0; n < grid.nodes.size(); ++n) {
      if (slides[n] == 0) {
        continue;
      }
      glm::dvec3 point = 0.5 * (grid.nodes[n] + on_faces[n]);
      for (int i = 0; i < 2; ++i) {
        const Distance distance = solid.signed_distance(point);
        point -= distance.gradient * distance.value;
      }
      grid.nodes[n] = point;
    }
    const std::vector<glm::dvec3> inside = means_of_neighbours(
        grid.nodes, grid.elements,
        [](std::size_t apart) { return apart == 1 || apart == 2 || apart == 4; });
    for (std::size_t n = 0; n < grid.nodes.size(); ++n) {
      if (sides[n] == 0) {
        grid.nodes[n] = inside[n];
      }
    }
  }
}

/// Moves the surface's nodes onto the surface; back towards the lattice where an element would be
/// squashed.
void fit_surface(const ElasticSolid& solid, const Lattice& lattice,
                 const std::vector<std::uint8_t>& sides, SolidGrid& grid) {
  const std::vector<glm::dvec3> start = grid.nodes;
  for (std::size_t n = 0; n < start.size(); ++n) {
    if (sides[n] != 0) {
      grid.nodes[n] = on_surface(solid, lattice, start[n], grid.lattice[n], sides[n]);
    }
  }
  even_out(solid, sides, grid);
  constexpr int kTries = 30;
  for (int i = 0; i < kTries; ++i) {
    std::vector<std::uint8_t> too_far(start.size(), 0);
    bool all_sound = true;
    for (std::size_t element = 0; element < grid.elements.size(); ++element) {
      if (!is_sound(grid, element)) {
        all_sound = false;
        for (const std::uint32_t node : grid.elements[element]) {
          too_far[node] = 1;
        }
      }
    }
    if (all_sound) {
      return;
    }
    for (std::size_t n = 0; n < start.size(); ++n) {
      if (too_far[n] != 0) {
        grid.nodes[n] = start[n] + 0.8 * (grid.nodes[n] - start[n]);
      }
    }
  }
  grid.nodes = start;  // out of reach of smooth surfaces: the lattice itself is always sound
}

/// Whether the clamped nodes hold the body: three that are not in line.
bool is_held(const SolidGrid& grid) {
  const double size = glm::length(grid.spacing);
  const glm::dvec3* first = nullptr;
  glm::dvec3 along(0.0);
  for (std::size_t n = 0; n < grid.nodes.size(); ++n) {
    if (grid.clamped[n] == 0) {
      continue;
    }
    if (first == nullptr) {
      first = &grid.nodes[n];
    } else if (along == glm::dvec3(0.0)) {
      along = glm::normalize(grid.nodes[n] - *first);
    } else if (glm::length(glm::cross(grid.nodes[n] - *first, along)) > 1e-3 * size) {
      return true;
    }
  }
  return false;
}

}  // namespace

bool is_sound(const SolidGrid& grid, std::size_t element) {
  constexpr double kGauss = 0.5773502691896258;
  constexpr double kLeast = 0.02;  // of the undistorted cell
  const std::array<glm::dvec3, 8> corners = element_corners(grid, element);
  const double whole = 0.125 * grid.spacing.x * grid.spacing.y * grid.spacing.z;
  for (std::uint32_t c = 0; c < 8; ++c) {
    const glm::dvec3 sign(c & 1U ? kGauss : -kGauss, c & 2U ? kGauss : -kGauss,
                          c & 4U ? kGauss : -kGauss);
    if (glm::determinant(element_jacobian(corners, sign)) < kLeast * whole) {
      return false;
    }
  }
  return true;
}

glm::dmat3 element_jacobian(const std::array<glm::dvec3, 8>& corners, const glm::dvec3& local) {
  glm::dmat3 jacobian(0.0);
  for (std::uint32_t c = 0; c < 8; ++c) {
    const glm::dvec3 sign(c & 1U ? 1.0 : -1.0, c & 2U ? 1.0 : -1.0, c & 4U ? 1.0 : -1.0);
    const glm::dvec3 part = glm::dvec3(1.0) + sign * local;
    jacobian[0] += corners[c] * (0.125 * sign.x * part.y * part.z);
    jacobian[1] += corners[c] * (0.125 * sign.y * part.z * part.x);
    jacobian[2] += corners[c] * (0.125 * sign.z * part.x * part.y);
  }
  return jacobian;
}

std::array<glm::dvec3, 8> corner_slopes(const glm::dmat3& jacobian, const glm::dvec3& local) {
  const glm::dmat3 to_local = glm::inverse(jacobian);
  std::array<glm::dvec3, 8> slopes{};
  for (std::uint32_t c = 0; c < 8; ++c) {
    const glm::dvec3 sign(c & 1U ? 1.0 : -1.0, c & 2U ? 1.0 : -1.0, c & 4U ? 1.0 : -1.0);
    const glm::dvec3 part = glm::dvec3(1.0) + sign * local;
    slopes[c] =
        0.125 *
        glm::dvec3(sign.x * part.y * part.z, sign.y * part.z * part.x, sign.z * part.x * part.y) *
        to_local;
  }
  return slopes;
}

std::array<glm::dvec3, 8> element_corners(const SolidGrid& grid, std::size_t element) {
  std::array<glm::dvec3, 8> corners{};
  for (std::size_t c = 0; c < 8; ++c) {
    corners[c] = grid.nodes[grid.elements[element][c]];
  }
  return corners;
}

Result<SolidGrid> build_solid_grid(const ElasticSolid& solid, std::uint32_t elements) {
  const Lattice lattice = lattice_over(solid.bounds, elements);
  const std::vector<std::uint8_t> inside = largest_piece(solid, lattice);
  if (inside.empty()) {
    return Error{"no cell of the body's grid is inside the body: is its surface closed?"};
  }
  std::vector<std::uint8_t> sides;
  SolidGrid grid = grid_of_cells(lattice, inside, sides);
  fit_surface(solid, lattice, sides, grid);
  fit_clamp(solid, grid);
  if (!is_held(grid)) {
    return Error{
        "what is fixed of the body holds fewer than three nodes of its grid that are not "
        "in line: fix a larger part of it, or take more elements"};
  }
  return grid;
}

}  // namespace torsion::engine
