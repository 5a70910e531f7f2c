#include "systems/geometry/distance_field.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <string>
#include <thread>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/geometry/distance_mesh.hpp"
#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

/// A place along one axis: the cell, and the fraction within it, 0 to 1.
struct AxisPlace {
  std::uint32_t cell;
  double fraction;
};

[[gnu::always_inline]] inline AxisPlace place_on_axis(double coordinate, std::uint32_t cells) {
  const double last = static_cast<double>(cells);
  const double inside =
      coordinate > 0.0 ? (coordinate < last ? coordinate : last) : 0.0;  // NaN goes to 0
  // Through a signed integer, which takes one instruction.
  const auto floor = static_cast<std::uint32_t>(static_cast<std::int32_t>(inside));
  const std::uint32_t cell = floor < cells ? floor : cells - 1;
  return {cell, inside - static_cast<double>(cell)};
}

struct BlendedNode {
  float value;  // m
  glm::vec3 gradient;
};

/// Blends the 8 nodes of one cell.
/// @param first   the lowest node; its neighbours along x, y, z are 1, row, layer further
/// @param spacing m
[[gnu::always_inline]] inline BlendedNode blend(const DistanceNode* first, std::size_t row,
                                                std::size_t layer,
                                                const std::array<double, 3>& fraction,
                                                double spacing) {
  using Row = Eigen::Array4f;
  const auto node = [&](std::size_t offset) {
    return Eigen::Map<const Row>(&first[offset].gradient_and_distance.x);
  };
  const auto fx = static_cast<float>(fraction[0]);
  const auto fy = static_cast<float>(fraction[1]);
  const auto fz = static_cast<float>(fraction[2]);

  const Row n000 = node(0);
  const Row n010 = node(row);
  const Row n001 = node(layer);
  const Row n011 = node(row + layer);
  const Row x00 = node(1) - n000;
  const Row x10 = node(row + 1) - n010;
  const Row x01 = node(layer + 1) - n001;
  const Row x11 = node(row + layer + 1) - n011;
  const Row b00 = n000 + fx * x00;
  const Row b10 = n010 + fx * x10;
  const Row b01 = n001 + fx * x01;
  const Row b11 = n011 + fx * x11;

  const Row y0 = b10 - b00;
  const Row y1 = b11 - b01;
  const Row c0 = b00 + fy * y0;
  const Row c1 = b01 + fy * y1;
  const Row x0 = x00 + fy * (x10 - x00);
  const Row x1 = x01 + fy * (x11 - x01);

  const Row along_z = c1 - c0;
  const Row along_y = y0 + fz * (y1 - y0);
  const Row along_x = x0 + fz * (x1 - x0);
  const Row blended = c0 + fz * along_z;

  // sum of w_i g_i.(x - x_i) = -spacing * sum over the axes of f (1 - f) * (difference of that
  // slope along the axis)
  const float bend =
      fx * (1.0F - fx) * along_x[0] + fy * (1.0F - fy) * along_y[1] + fz * (1.0F - fz) * along_z[2];
  return {blended[3] - 0.5F * static_cast<float>(spacing) * bend,
          glm::vec3(blended[0], blended[1], blended[2])};
}

}  // namespace

Distance FieldDistance::operator()(double x, double y, double z) const {
  const glm::dvec3 scaled = (glm::dvec3(x, y, z) - field_.origin) * inverse_spacing_;
  const AxisPlace px = place_on_axis(scaled.x, field_.cells.x);
  const AxisPlace py = place_on_axis(scaled.y, field_.cells.y);
  const AxisPlace pz = place_on_axis(scaled.z, field_.cells.z);
  const std::size_t cell_row =
      (pz.cell * std::size_t{field_.cells.y} + py.cell) * field_.cells.x + px.cell;
  const std::uint32_t fine = bricks_[cell_row].first_node;

  BlendedNode blended;
  if (fine != kNoRow) {
    const std::uint32_t n = field_.subdivision;
    const AxisPlace bx = place_on_axis(px.fraction * n, n);
    const AxisPlace by = place_on_axis(py.fraction * n, n);
    const AxisPlace bz = place_on_axis(pz.fraction * n, n);
    const std::size_t row = n + 1;
    const std::size_t layer = row * row;
    blended = blend(nodes_ + fine + bz.cell * layer + by.cell * row + bx.cell, row, layer,
                    {bx.fraction, by.fraction, bz.fraction}, field_.spacing / n);
  } else {
    const std::size_t row = field_.cells.x + 1;
    const std::size_t layer = row * (field_.cells.y + 1);
    blended = blend(nodes_ + field_.coarse_nodes.first + pz.cell * layer + py.cell * row + px.cell,
                    row, layer, {px.fraction, py.fraction, pz.fraction}, field_.spacing);
  }

  const glm::dvec3 gradient(blended.gradient);
  const glm::dvec3 clamped(px.cell + px.fraction, py.cell + py.fraction, pz.cell + pz.fraction);
  if (scaled == clamped) {
    return {static_cast<double>(blended.value), gradient};
  }
  // Outside the grid. The surface lies in the box, so at the clamped point the directions to the
  // surface and to the query are at least a right angle apart: sqrt(a^2 + d^2) never exceeds the
  // distance.
  const glm::dvec3 outward = (scaled - clamped) * field_.spacing;
  const double at_box = larger(static_cast<double>(blended.value), 0.0);
  const glm::dvec3 from_surface = outward + at_box * gradient;
  const double value = std::sqrt(glm::dot(outward, outward) + at_box * at_box);
  return {value, from_surface / std::sqrt(glm::dot(from_surface, from_surface))};
}

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

  DistanceNode node_at(const glm::dvec3& point) {
    const MeshDistance::Closest closest = mesh_.closest(point, hint_);
    hint_ = closest.triangle;
    return {glm::vec4(glm::vec3(closest.distance.gradient),
                      static_cast<float>(closest.distance.value))};
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
  return field;
}

std::vector<std::byte> to_bytes(const BuiltField& field) {
  const std::array<std::span<const std::byte>, 3> pieces{std::as_bytes(std::span(&field.header, 1)),
                                                         std::as_bytes(std::span(field.bricks)),
                                                         std::as_bytes(std::span(field.nodes))};
  std::vector<std::byte> bytes;
  bytes.reserve(pieces[0].size() + pieces[1].size() + pieces[2].size());
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
  if (cells == 0 || cells != header.bricks.count || header.subdivision == 0 ||
      bytes.size() < brick_bytes || (bytes.size() - brick_bytes) % sizeof(DistanceNode) != 0) {
    return std::nullopt;
  }
  field.bricks.resize(header.bricks.count);
  std::memcpy(field.bricks.data(), bytes.data(), brick_bytes);
  bytes = bytes.subspan(brick_bytes);
  field.nodes.resize(bytes.size() / sizeof(DistanceNode));
  std::memcpy(field.nodes.data(), bytes.data(), bytes.size());

  const std::uint64_t side = std::uint64_t{header.subdivision} + 1;
  const bool in_range =
      std::all_of(field.bricks.begin(), field.bricks.end(), [&](const DistanceBrick& brick) {
        return brick.first_node == kNoRow ||
               brick.first_node + side * side * side <= field.nodes.size();
      });
  const std::uint64_t coarse = (header.cells.x + std::uint64_t{1}) *
                               (header.cells.y + std::uint64_t{1}) *
                               (header.cells.z + std::uint64_t{1});
  if (!in_range || header.coarse_nodes != Range{0, static_cast<std::uint32_t>(coarse)} ||
      coarse > field.nodes.size()) {
    return std::nullopt;
  }
  return field;
}

}  // namespace torsion::engine
