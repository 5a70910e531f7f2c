#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "ecs/components.hpp"

namespace torsion {

/// Springs and dampers between a device's handle and the tool it holds, and the largest force and
/// torque that they come to.
struct VirtualCoupling {
  double stiffness = 0.0;       // N/m
  double damping = 0.0;         // N s/m
  double turn_stiffness = 0.0;  // N m/rad
  double turn_damping = 0.0;    // N m s/rad
  double largest_force = 0.0;   // N
  double largest_torque = 0.0;  // N m
};

/// A frame and how it moves; world axes.
struct MovingFrame {
  Pose pose;
  glm::dvec3 velocity{0.0};          // m/s, of its origin
  glm::dvec3 angular_velocity{0.0};  // rad/s
};

/// The wrench of the coupling on the tool about the tool's origin, world axes; the handle feels the
/// opposite. In turning the spring's potential is 4 k (1 - cos(theta / 2)): its torque
/// 2 k sin(theta / 2) is that of a spring for small angles and largest at pi, with no jump on the
/// way to a whole turn. Force and torque come smoothly to their largest.
Wrench coupling_wrench(const VirtualCoupling& coupling, const MovingFrame& handle,
                       const MovingFrame& tool);

/// `vector` with its length L brought smoothly below `most`: L / sqrt(1 + (L / most)^2). Zero where
/// `most` is.
glm::dvec3 soft_limit(const glm::dvec3& vector, double most);

}  // namespace torsion
