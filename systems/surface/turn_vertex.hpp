#pragma once

// The turn of a vertex about one axis, in float and in the same order of operations as
// shaders/deform.comp.

#include <cmath>

#include <glm/vec3.hpp>

#include "ecs/components.hpp"

namespace torsion {

struct SineVersine {
  float sine = 0.0F;
  float versine = 0.0F;  // 1 - cos
};

/// Taylor series in [-pi/4, pi/4].
inline float sine_near_zero(float x) {
  const float z = x * x;
  return x +
         x * z *
             (-1.66666667e-1F + z * (8.33333333e-3F + z * (-1.98412698e-4F + z * 2.75573192e-6F)));
}
inline float cosine_near_zero(float x) {
  const float z = x * x;
  return 1.0F + z * (-0.5F + z * (4.16666667e-2F + z * (-1.38888889e-3F + z * 2.48015873e-5F)));
}

/// sine_and_versine() of twice an angle in (-pi/4, pi/4): of that without quarter turns, to the
/// same bits.
inline SineVersine sine_and_versine_of_half(float h) {
  const float s = sine_near_zero(h);
  return {2.0F * s * cosine_near_zero(h), 2.0F * s * s};
}

/// With h = angle / 2: sin = 2 sin h cos h, 1 - cos = 2 sin^2 h, so that small angles keep their
/// relative precision. h is brought to [-pi/4, pi/4] by quarter turns with pi/2 in three parts
/// (Cody and Waite 1980); sine and cosine are Taylor series there.
/// @param angle  rad; exact to float precision up to about a thousand turns
inline SineVersine sine_and_versine(float angle) {
  const float h = 0.5F * angle;
  const float quarters = std::nearbyint(h * 0.636619772F);
  const float x =
      ((h - quarters * 1.5703125F) - quarters * 4.83989716e-4F) + quarters * 1.62920680e-7F;
  const float s = sine_near_zero(x);
  const float c = cosine_near_zero(x);
  const bool swap = (static_cast<int>(quarters) & 1) != 0;
  const float product = 2.0F * s * c;
  return {swap ? -product : product, swap ? 2.0F * c * c : 2.0F * s * s};
}

/// Rodrigues' rotation as x + sin(t) k x r + (1 - cos(t)) k x (k x r), r from the axis point to x.
/// @param position  m, body
inline glm::vec3 turn_vertex(const glm::vec3& position, const TwistAxis& axis, float angle) {
  const SineVersine turn = sine_and_versine(angle);
  const glm::vec3 k(axis.direction);
  const glm::vec3 r = position - glm::vec3(axis.point);
  const glm::vec3 across(k.y * r.z - k.z * r.y, k.z * r.x - k.x * r.z, k.x * r.y - k.y * r.x);
  const glm::vec3 inward(k.y * across.z - k.z * across.y, k.z * across.x - k.x * across.z,
                         k.x * across.y - k.y * across.x);
  return position + (turn.sine * across + turn.versine * inward);
}

}  // namespace torsion
