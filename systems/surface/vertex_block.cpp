#include "systems/surface/vertex_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/math/lanes.hpp"
#include "systems/surface/turn_vertex.hpp"

namespace torsion {

TORSION_WIDEST
void turn_block(const TwistAxis& axis, const BlockColumn& angles, BlockVectors& points) {
  float largest = 0.0F;
  for (const float angle : angles) {
    largest = std::max(largest, std::abs(angle));
  }
  if (largest == 0.0F) {
    return;
  }
  if (!(largest < 0.5F * std::numbers::pi_v<float>)) {
    for (std::size_t i = 0; i < kPointBlock; ++i) {
      const glm::vec3 turned =
          turn_vertex({points.x[i], points.y[i], points.z[i]}, axis, angles[i]);
      points.x[i] = turned.x;
      points.y[i] = turned.y;
      points.z[i] = turned.z;
    }
    return;
  }
  const glm::vec3 k(axis.direction);
  const glm::vec3 p(axis.point);
  for (std::size_t i = 0; i < kPointBlock; ++i) {
    const SineVersine turn = sine_and_versine_of_half(0.5F * angles[i]);
    const float rx = points.x[i] - p.x;
    const float ry = points.y[i] - p.y;
    const float rz = points.z[i] - p.z;
    const float ax = k.y * rz - k.z * ry;
    const float ay = k.z * rx - k.x * rz;
    const float az = k.x * ry - k.y * rx;
    points.x[i] += turn.sine * ax + turn.versine * (k.y * az - k.z * ay);
    points.y[i] += turn.sine * ay + turn.versine * (k.z * ax - k.x * az);
    points.z[i] += turn.sine * az + turn.versine * (k.x * ay - k.y * ax);
  }
}

}  // namespace torsion
