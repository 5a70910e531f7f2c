#pragma once

#include <cstdint>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/components/basics.hpp"

namespace torsion::engine {

// A keyed motion as glTF gives it: scenes/ writes it, and whoever moves tools or bodies plays it.

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

/// The frame at the end of a script's links at `time` [s], without their scale: what an animation
/// holds the tool at. Before the first key of a channel its first value holds, after the last its
/// last (glTF 2.0, 3.11). Allocates nothing; the same time gives the same bits.
Pose scripted_pose(const MotionScript& script, double time);

/// The value of a channel of translations at `time` [s], m. @pre the channel is not empty
glm::dvec3 translation_at(const KeyedChannel& channel, double time);

/// The value of a channel of rotations at `time` [s]. @pre the channel is not empty
glm::dquat rotation_at(const KeyedChannel& channel, double time);

}  // namespace torsion::engine
