#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/components.hpp"

namespace torsion::engine {

/// The corners of one cell of a distance field.
struct CellNodes {
  const DistanceNode* lowest;  // its neighbours along x, y, z are 1, row, layer further
  std::size_t row;
  std::size_t layer;

  /// @param corner  0 to 7: one bit each for the upper end along x, y, z
  [[nodiscard]] const glm::vec4& at(unsigned corner) const {
    return lowest[(corner & 1U) + (corner >> 1U & 1U) * row + (corner >> 2U) * layer]
        .gradient_and_distance;
  }
};

/// Blends the 8 nodes of one cell, as FieldDistance says.
/// @param fraction  0 to 1 along each axis, within the cell
/// @param spacing   m
/// @return          gradient (unitless), and the distance (m) as w
[[gnu::always_inline]] inline glm::vec4 distance_in_cell(const CellNodes& nodes,
                                                         const std::array<double, 3>& fraction,
                                                         double spacing) {
  const std::size_t row = nodes.row;
  const std::size_t layer = nodes.layer;
  using Row = Eigen::Array4f;
  const auto node = [&](std::size_t offset) {
    return Eigen::Map<const Row>(&nodes.lowest[offset].gradient_and_distance.x);
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
  return {blended[0], blended[1], blended[2],
          blended[3] - 0.5F * static_cast<float>(spacing) * bend};
}

}  // namespace torsion::engine
