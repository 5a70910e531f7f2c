#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <span>
#include <thread>
#include <vector>

#include <glm/geometric.hpp>

#include "systems/geometry/distance_creases.hpp"
#include "systems/geometry/distance_field.hpp"
#include "systems/geometry/distance_mesh.hpp"

namespace torsion::engine {
namespace {

constexpr double kMargin = 1.5;  // coarse cells around the mesh's box
constexpr double kBrickBand =
    0.25;  // coarse cells: how far from the surface a cell may be and still get a brick

/// Calls f(row) for every row below `count`, from `threads` threads. Rows must not share what they
/// write.
template <class F>
void for_each_row(std::uint32_t count, std::uint32_t threads, const F& f) {
  std::atomic<std::uint32_t> next{0};
  const auto work = [&] {
    constexpr std::uint32_t kChunk = 8;
    for (std::uint32_t first = next.fetch_add(kChunk); first < count;
         first = next.fetch_add(kChunk)) {
      for (std::uint32_t row = first; row < std::min(first + kChunk, count); ++row) {
        f(row);
      }
    }
  };
  std::vector<std::jthread> helpers;
  for (std::uint32_t helper = 1; helper < threads; ++helper) {
    helpers.emplace_back(work);
  }
  work();
}

/// Walks along a row of points: the nearest triangle of a point is a good first guess for the next.
class RowWalk {
 public:
  explicit RowWalk(const MeshDistance& mesh) : mesh_(mesh) {}

  Distance distance_at(const glm::dvec3& point) {
    const MeshDistance::Closest closest = mesh_.closest(point, hint_);
    hint_ = closest.triangle;
    return closest.distance;
  }

  DistanceNode node_at(const glm::dvec3& point) {
    const Distance distance = distance_at(point);
    return {glm::vec4(glm::vec3(distance.gradient), static_cast<float>(distance.value))};
  }

 private:
  const MeshDistance& mesh_;
  std::uint32_t hint_ = kNoRow;
};

/// Box, spacing and counts of the coarse grid; no cells where the mesh has no extent.
DistanceField coarse_grid(const SurfaceMesh& mesh, const FieldOptions& options) {
  glm::dvec3 lowest = mesh.positions[mesh.triangles[0].x];
  glm::dvec3 highest = lowest;
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : {triangle.x, triangle.y, triangle.z}) {
      lowest = glm::min(lowest, mesh.positions[vertex]);
      highest = glm::max(highest, mesh.positions[vertex]);
    }
  }
  const glm::dvec3 extent = highest - lowest;
  DistanceField header;
  header.subdivision = options.subdivision;
  header.spacing =
      std::max({extent.x, extent.y, extent.z}) / (options.coarse_cells - 2.0 * kMargin);
  if (!(header.spacing > 0.0) || !std::isfinite(header.spacing)) {
    return header;
  }
  header.cells = glm::uvec3(glm::ceil(extent / header.spacing + 2.0 * kMargin - 1e-9));
  header.origin = 0.5 * (lowest + highest) - 0.5 * header.spacing * glm::dvec3(header.cells);
  return header;
}

void fill_coarse_nodes(const MeshDistance& mesh, std::uint32_t threads, BuiltField& field) {
  const DistanceField& grid = field.header;
  const glm::uvec3 nodes = grid.cells + 1U;
  field.nodes.resize(std::size_t{nodes.x} * nodes.y * nodes.z);
  for_each_row(nodes.y * nodes.z, threads, [&](std::uint32_t row) {
    RowWalk walk(mesh);
    for (std::uint32_t x = 0; x < nodes.x; ++x) {
      const glm::dvec3 step(x, row % nodes.y, row / nodes.y);
      field.nodes[std::size_t{row} * nodes.x + x] = walk.node_at(grid.origin + grid.spacing * step);
    }
  });
}

/// Gives a brick to each coarse cell whose centre is so near the surface that the surface may enter
/// the cell or come within kBrickBand of it.
void choose_bricks(const MeshDistance& mesh, std::uint32_t threads, BuiltField& field) {
  const DistanceField& grid = field.header;
  const double half_diagonal = 0.5 * std::sqrt(3.0) * grid.spacing;
  const double reach = half_diagonal + kBrickBand * grid.spacing;
  const glm::uvec3 nodes = grid.cells + 1U;
  field.bricks.assign(std::size_t{grid.cells.x} * grid.cells.y * grid.cells.z, DistanceBrick{});
  for_each_row(grid.cells.y * grid.cells.z, threads, [&](std::uint32_t row) {
    RowWalk walk(mesh);
    const std::uint32_t y = row % grid.cells.y;
    const std::uint32_t z = row / grid.cells.y;
    for (std::uint32_t x = 0; x < grid.cells.x; ++x) {
      const std::size_t corner = (std::size_t{z} * nodes.y + y) * nodes.x + x;
      const float at_corner = field.nodes[corner].gradient_and_distance.w;
      if (std::abs(static_cast<double>(at_corner)) > reach + half_diagonal * (1.0 + 1e-6)) {
        continue;
      }
      const glm::dvec3 step(x + 0.5, y + 0.5, z + 0.5);
      const DistanceNode center = walk.node_at(grid.origin + grid.spacing * step);
      if (std::abs(static_cast<double>(center.gradient_and_distance.w)) <= reach) {
        field.bricks[std::size_t{row} * grid.cells.x + x].first_node = 0;
      }
    }
  });
  const std::uint32_t side = grid.subdivision + 1;
  auto end = static_cast<std::uint32_t>(field.nodes.size());
  for (DistanceBrick& brick : field.bricks) {
    if (brick.first_node != kNoRow) {
      brick.first_node = end;
      end += side * side * side;
    }
  }
  field.nodes.resize(end);
}

/// Where the fine rows of one coordinate lie: in a coarse cell, or on the face between two.
struct CellsOfFineRow {
  std::array<std::uint32_t, 2> cell;
  std::array<std::uint32_t, 2> local;  // fine index in the cell, 0 to subdivision
  std::uint32_t count;
};

CellsOfFineRow cells_of_fine_row(std::uint32_t fine, std::uint32_t subdivision,
                                 std::uint32_t cells) {
  CellsOfFineRow found{{0, 0}, {0, 0}, 0};
  const std::uint32_t cell = fine / subdivision;
  const std::uint32_t local = fine % subdivision;
  if (cell < cells) {
    found.cell[found.count] = cell;
    found.local[found.count++] = local;
  }
  if (local == 0 && cell > 0) {
    found.cell[found.count] = cell - 1;
    found.local[found.count++] = subdivision;
  }
  return found;
}

/// Fills the nodes of all bricks. Bricks share their faces, so each place of the fine lattice is
/// computed once. No two rows of the lattice write to the same node.
void fill_bricks(const MeshDistance& mesh, std::uint32_t threads, BuiltField& field) {
  const DistanceField& grid = field.header;
  const std::uint32_t n = grid.subdivision;
  const std::uint32_t side = n + 1;
  const double spacing = grid.spacing / n;
  const std::uint32_t rows_y = grid.cells.y * n + 1;
  const std::uint32_t rows_z = grid.cells.z * n + 1;
  for_each_row(rows_y * rows_z, threads, [&](std::uint32_t row) {
    const CellsOfFineRow in_y = cells_of_fine_row(row % rows_y, n, grid.cells.y);
    const CellsOfFineRow in_z = cells_of_fine_row(row / rows_y, n, grid.cells.z);
    RowWalk walk(mesh);
    DistanceNode node;
    bool previous_cell_done = false;
    for (std::uint32_t x = 0; x < grid.cells.x; ++x) {
      std::array<DistanceNode*, 4> rows{};
      std::uint32_t count = 0;
      for (std::uint32_t k = 0; k < in_z.count; ++k) {
        for (std::uint32_t j = 0; j < in_y.count; ++j) {
          const std::size_t cell =
              (std::size_t{in_z.cell[k]} * grid.cells.y + in_y.cell[j]) * grid.cells.x + x;
          if (field.bricks[cell].first_node != kNoRow) {
            rows[count++] = &field.nodes[field.bricks[cell].first_node +
                                         (in_z.local[k] * side + in_y.local[j]) * side];
          }
        }
      }
      for (std::uint32_t i = 0; i < side && count > 0; ++i) {
        if (i > 0 || !previous_cell_done) {
          const glm::dvec3 step(x * n + i, row % rows_y, row / rows_y);
          node = walk.node_at(grid.origin + spacing * step);
        }
        for (std::uint32_t brick = 0; brick < count; ++brick) {
          rows[brick][i] = node;
        }
      }
      previous_cell_done = count > 0;
    }
  });
}

/// One brick's creases, with rows that count from 0 in its own planes.
struct BrickCreases {
  std::vector<DistanceCrease> cells;  // empty where the surface is smooth in all of them
  std::vector<DistanceNode> planes;
};

/// @param nodes    the brick's
/// @param lowest   m, the brick's lowest corner
/// @param spacing  m, of fine cells
BrickCreases find_creases(const MeshDistance& mesh, const DistanceNode* nodes,
                          std::uint32_t subdivision, const glm::dvec3& lowest, double spacing) {
  const std::size_t row = subdivision + 1;
  const std::size_t layer = row * row;
  BrickCreases found;
  found.cells.resize(std::size_t{subdivision} * subdivision * subdivision);
  RowWalk walk(mesh);
  for (std::uint32_t cell = 0; cell < found.cells.size(); ++cell) {
    const glm::uvec3 at(cell % subdivision, cell / subdivision % subdivision,
                        cell / (subdivision * subdivision));
    const CellNodes corners{nodes + at.z * layer + at.y * row + at.x, row, layer};
    if (!may_have_crease(corners, spacing)) {
      continue;
    }
    std::array<Distance, kCreaseSamples> exact{};
    for (std::size_t i = 0; i < kCreaseSamples; ++i) {
      const auto [x, y, z] = crease_sample(i);
      exact[i] = walk.distance_at(lowest + spacing * (glm::dvec3(at) + glm::dvec3(x, y, z)));
    }
    const CreaseFit fit = fit_crease(corners, spacing, exact);
    found.cells[cell] = {static_cast<std::uint32_t>(found.planes.size()),
                         static_cast<std::uint16_t>(fit.planes.size()),
                         static_cast<std::uint16_t>(fit.concave ? 1 : 0)};
    found.planes.insert(found.planes.end(), fit.planes.begin(), fit.planes.end());
  }
  if (found.planes.empty()) {
    found.cells.clear();
  }
  return found;
}

/// Finds the creases of all bricks, and keeps those of bricks that have any.
void fill_creases(const MeshDistance& mesh, std::uint32_t threads, BuiltField& field) {
  const DistanceField& grid = field.header;
  const auto count = static_cast<std::uint32_t>(field.bricks.size());
  std::vector<BrickCreases> found(count);
  for_each_row(count, threads, [&](std::uint32_t brick) {
    const std::uint32_t first = field.bricks[brick].first_node;
    if (first == kNoRow) {
      return;
    }
    const glm::uvec3 at(brick % grid.cells.x, brick / grid.cells.x % grid.cells.y,
                        brick / (grid.cells.x * grid.cells.y));
    found[brick] =
        find_creases(mesh, &field.nodes[first], grid.subdivision,
                     grid.origin + grid.spacing * glm::dvec3(at), grid.spacing / grid.subdivision);
  });
  for (std::uint32_t brick = 0; brick < count; ++brick) {
    if (found[brick].cells.empty()) {
      continue;
    }
    field.bricks[brick].first_crease = static_cast<std::uint32_t>(field.creases.size());
    for (DistanceCrease crease : found[brick].cells) {
      crease.first_plane += static_cast<std::uint32_t>(field.nodes.size());
      field.creases.push_back(crease.planes == 0 ? DistanceCrease{} : crease);
    }
    field.nodes.insert(field.nodes.end(), found[brick].planes.begin(), found[brick].planes.end());
  }
  field.header.creases = {0, static_cast<std::uint32_t>(field.creases.size())};
}

}  // namespace

Result<BuiltField> build_distance_field(const FieldOfMesh& mesh, const FieldOptions& options) {
  Result<MeshDistance> distance = MeshDistance::build(mesh.solid, options.threads);
  if (!distance) {
    return distance.error();
  }
  BuiltField field;
  field.header = coarse_grid(mesh.part, options);
  if (field.header.cells == glm::uvec3(0)) {
    return Error{"the mesh has no extent, so it encloses no volume to measure distances to"};
  }
  fill_coarse_nodes(distance.value(), options.threads, field);
  field.header.coarse_nodes = {0, static_cast<std::uint32_t>(field.nodes.size())};
  choose_bricks(distance.value(), options.threads, field);
  field.header.bricks = {0, static_cast<std::uint32_t>(field.bricks.size())};
  fill_bricks(distance.value(), options.threads, field);
  fill_creases(distance.value(), options.threads, field);
  return field;
}

std::vector<std::byte> to_bytes(const BuiltField& field) {
  const std::array<std::span<const std::byte>, 4> pieces{
      std::as_bytes(std::span(&field.header, 1)), std::as_bytes(std::span(field.bricks)),
      std::as_bytes(std::span(field.creases)), std::as_bytes(std::span(field.nodes))};
  std::vector<std::byte> bytes;
  bytes.reserve(pieces[0].size() + pieces[1].size() + pieces[2].size() + pieces[3].size());
  for (const std::span<const std::byte> piece : pieces) {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
  }
  return bytes;
}

std::optional<BuiltField> field_from_bytes(std::span<const std::byte> bytes) {
  BuiltField field;
  if (bytes.size() < sizeof(field.header)) {
    return std::nullopt;
  }
  std::memcpy(&field.header, bytes.data(), sizeof(field.header));
  bytes = bytes.subspan(sizeof(field.header));
  const DistanceField& header = field.header;
  const std::uint64_t cells = std::uint64_t{header.cells.x} * header.cells.y * header.cells.z;
  const std::size_t brick_bytes = std::size_t{header.bricks.count} * sizeof(DistanceBrick);
  const std::size_t crease_bytes = std::size_t{header.creases.count} * sizeof(DistanceCrease);
  if (cells == 0 || cells != header.bricks.count || header.subdivision == 0 ||
      header.creases.first != 0 || bytes.size() < brick_bytes + crease_bytes ||
      (bytes.size() - brick_bytes - crease_bytes) % sizeof(DistanceNode) != 0) {
    return std::nullopt;
  }
  field.bricks.resize(header.bricks.count);
  std::memcpy(field.bricks.data(), bytes.data(), brick_bytes);
  bytes = bytes.subspan(brick_bytes);
  field.creases.resize(header.creases.count);
  std::memcpy(field.creases.data(), bytes.data(), crease_bytes);
  bytes = bytes.subspan(crease_bytes);
  field.nodes.resize(bytes.size() / sizeof(DistanceNode));
  std::memcpy(field.nodes.data(), bytes.data(), bytes.size());

  const std::uint64_t side = std::uint64_t{header.subdivision} + 1;
  const std::uint64_t inner = header.subdivision;
  const bool planes_in_range =
      std::all_of(field.creases.begin(), field.creases.end(), [&](const DistanceCrease& crease) {
        return crease.planes == 0 ||
               std::uint64_t{crease.first_plane} + crease.planes <= field.nodes.size();
      });
  const bool in_range =
      std::all_of(field.bricks.begin(), field.bricks.end(), [&](const DistanceBrick& brick) {
        return (brick.first_node == kNoRow ||
                brick.first_node + side * side * side <= field.nodes.size()) &&
               (brick.first_crease == kNoRow ||
                brick.first_crease + inner * inner * inner <= field.creases.size());
      });
  const std::uint64_t coarse = (header.cells.x + std::uint64_t{1}) *
                               (header.cells.y + std::uint64_t{1}) *
                               (header.cells.z + std::uint64_t{1});
  if (!in_range || !planes_in_range ||
      header.coarse_nodes != Range{0, static_cast<std::uint32_t>(coarse)} ||
      coarse > field.nodes.size()) {
    return std::nullopt;
  }
  return field;
}

}  // namespace torsion::engine
