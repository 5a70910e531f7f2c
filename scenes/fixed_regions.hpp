#pragma once

#include <span>
#include <string>
#include <vector>

#include "ecs/scene_description.hpp"
#include "scenes/node_tree.hpp"
#include "scenes/problem.hpp"

namespace torsion::engine {

/// A node with a fixed_ role below an elastic node.
struct FixedNode {
  Role role = Role::kFixedPoint;
  glm::dmat4 to_body{1.0};
  std::string where;
};

/// Sets what holds the body, and which of its drawn vertices are held, from torsion_fixed and the
/// fixed_ nodes below.
/// @param how    value of torsion_fixed; empty: fixed_ nodes where there are any, else
/// bottom_center
/// @param up     unit, body frame: the world's +y
void set_fixed_region(const std::string& how, std::span<const FixedNode> nodes,
                      const glm::dvec3& up, const std::string& where, BodyDescription& body,
                      const ProblemList& problems);

}  // namespace torsion::engine
