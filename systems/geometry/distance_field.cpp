#include "systems/geometry/distance_field.hpp"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/geometry/distance_creases.hpp"
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

}  // namespace

[[gnu::always_inline]] inline glm::vec4 FieldDistance::in_brick(
    const DistanceBrick& brick, const std::array<double, 3>& place) const {
  const std::uint32_t n = field_.subdivision;
  const AxisPlace x = place_on_axis(place[0] * n, n);
  const AxisPlace y = place_on_axis(place[1] * n, n);
  const AxisPlace z = place_on_axis(place[2] * n, n);
  const std::array<double, 3> fraction{x.fraction, y.fraction, z.fraction};
  const double spacing = field_.spacing / n;
  if (brick.first_crease != kNoRow) {
    const DistanceCrease& crease =
        creases_[brick.first_crease + (z.cell * n + y.cell) * n + x.cell];
    if (crease.planes > 0) {
      return distance_at_crease(
          {nodes_ + crease.first_plane, crease.planes},
          glm::vec3(spacing * x.fraction, spacing * y.fraction, spacing * z.fraction),
          crease.concave != 0);
    }
  }
  const std::size_t row = n + 1;
  const std::size_t layer = row * row;
  const DistanceNode* lowest = nodes_ + brick.first_node + z.cell * layer + y.cell * row + x.cell;
  return distance_in_cell({lowest, row, layer}, fraction, spacing);
}

Distance FieldDistance::operator()(double x, double y, double z) const {
  const glm::dvec3 scaled = (glm::dvec3(x, y, z) - field_.origin) * inverse_spacing_;
  const AxisPlace px = place_on_axis(scaled.x, field_.cells.x);
  const AxisPlace py = place_on_axis(scaled.y, field_.cells.y);
  const AxisPlace pz = place_on_axis(scaled.z, field_.cells.z);
  const std::size_t cell_row =
      (pz.cell * std::size_t{field_.cells.y} + py.cell) * field_.cells.x + px.cell;
  const DistanceBrick brick = bricks_[cell_row];

  glm::vec4 blended;
  if (brick.first_node != kNoRow) {
    blended = in_brick(brick, {px.fraction, py.fraction, pz.fraction});
  } else {
    const std::size_t row = field_.cells.x + 1;
    const std::size_t layer = row * (field_.cells.y + 1);
    const CellNodes nodes{nodes_ + pz.cell * layer + py.cell * row + px.cell, row, layer};
    blended = distance_in_cell(nodes, {px.fraction, py.fraction, pz.fraction}, field_.spacing);
  }

  const glm::dvec3 gradient(blended);
  const glm::dvec3 clamped(px.cell + px.fraction, py.cell + py.fraction, pz.cell + pz.fraction);
  if (scaled == clamped) {
    return {static_cast<double>(blended.w), gradient};
  }
  // Outside the grid. The surface lies in the box, so at the clamped point the directions to the
  // surface and to the query are at least a right angle apart: sqrt(a^2 + d^2) never exceeds the
  // distance.
  const glm::dvec3 outward = (scaled - clamped) * field_.spacing;
  const double at_box = larger(static_cast<double>(blended.w), 0.0);
  const glm::dvec3 from_surface = outward + at_box * gradient;
  const double value = std::sqrt(glm::dot(outward, outward) + at_box * at_box);
  return {value, from_surface / std::sqrt(glm::dot(from_surface, from_surface))};
}

}  // namespace torsion::engine
