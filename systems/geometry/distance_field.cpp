#include "systems/geometry/distance_field.hpp"

#include <array>
#include <cmath>

#include <Eigen/Core>

#include "systems/math/lanes.hpp"

namespace torsion {
namespace {

/// Where along one axis: the cell and the fraction of it, 0 to 1.
struct AxisPlace {
  std::uint32_t cell;
  double fraction;
};

[[gnu::always_inline]] inline AxisPlace place_on_axis(double coordinate, std::uint32_t cells) {
  const double last = static_cast<double>(cells);
  const double inside =
      coordinate > 0.0 ? (coordinate < last ? coordinate : last) : 0.0;  // NaN goes to 0
  // By way of the signed number, which takes one instruction.
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

}  // namespace torsion
