#pragma once

// Blocks of vertices as columns: what is the same for every vertex goes through them in loops that
// the compiler turns into vector instructions.

#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

#include "ecs/components.hpp"

namespace torsion {

inline constexpr std::size_t kPointBlock = 256;

/// A number for each point of a block.
using BlockColumn = std::array<float, kPointBlock>;

/// A vector for each point of a block.
struct BlockVectors {
  BlockColumn x;
  BlockColumn y;
  BlockColumn z;

  [[nodiscard]] glm::dvec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const glm::dvec3& vector) {
    x[i] = static_cast<float>(vector.x);
    y[i] = static_cast<float>(vector.y);
    z[i] = static_cast<float>(vector.z);
  }
};

/// turn_vertex() for each point, to the same bits.
/// @param angles  rad
/// @param points  m, body; in and out
void turn_block(const TwistAxis& axis, const BlockColumn& angles, BlockVectors& points);

}  // namespace torsion
