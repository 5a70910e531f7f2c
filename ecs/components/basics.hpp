#pragma once

// What several tables share.
// Units, frames and "written by": ecs/components.hpp.

#include <cstdint>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace torsion::engine {

inline constexpr std::uint32_t kNoRow = UINT32_MAX;
/// Also the number of twist columns that a vertex can have.
inline constexpr std::uint32_t kMaxRegionsPerBody = 16;

/// A rigid placement: x_outer = rotation * x_inner + position.
struct Pose {
  glm::dvec3 position{0.0};                 // m, outer frame
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  // unit quaternion, inner to outer
};

/// A force and the torque that goes with it; the reference point and the frame are said where it is
/// used.
struct Wrench {
  glm::dvec3 force{0.0};   // N
  glm::dvec3 torque{0.0};  // N m
};

}  // namespace torsion::engine
