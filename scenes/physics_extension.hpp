#pragma once

#include <optional>

#include <glm/vec3.hpp>
#include <tiny_gltf.h>

namespace torsion::engine {

/// What KHR_physics_rigid_bodies says of one node and Torsion reads; torsion_ keys win over it.
struct PhysicsExtension {
  std::optional<double> mass;              // kg, > 0
  std::optional<glm::dvec3> mass_center;   // m, node
  std::optional<double> static_friction;   // >= dynamic_friction
  std::optional<double> dynamic_friction;  // >= 0
};

PhysicsExtension read_physics_extension(const tinygltf::Model& model, const tinygltf::Node& node);

}  // namespace torsion::engine
