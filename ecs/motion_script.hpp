#pragma once

#include <cstdint>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace torsion::engine {

// A keyed motion as glTF gives it, kept as plain data so that scenes/ writes it and device/ plays
// it.

enum class Interpolation : std::uint32_t { kStep, kLinear, kCubicSpline };

/// Keys of one animated property. CUBICSPLINE has three values a key: in-tangent, value,
/// out-tangent.
struct KeyedChannel {
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<double> times;       // s, strictly increasing
  std::vector<glm::dvec4> values;  // translation: xyz; rotation: quaternion xyzw
  [[nodiscard]] bool empty() const { return times.empty(); }
};

/// One node on the way from the scene's root to the tool, root first: its fixed placement, and what
/// animates it.
struct MotionLink {
  glm::dvec3 translation{0.0};  // m
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};
  KeyedChannel animated_translation;  // empty: fixed
  KeyedChannel animated_rotation;     // empty: fixed
};

/// How a tool moves: the product of its links. The tool frame is that product without its scale.
struct MotionScript {
  std::vector<MotionLink> links;
  double end_time = 0.0;  // s, the last key of all channels
};

}  // namespace torsion::engine
