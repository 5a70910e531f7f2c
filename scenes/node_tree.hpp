#pragma once

#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include "ecs/components.hpp"
#include "scenes/conventions.hpp"
#include "scenes/problem.hpp"

namespace torsion::engine {

/// A node of the scene that is shown, with what it inherits.
struct SceneNode {
  std::size_t row = 0;            // in the file's nodes
  std::size_t parent = SIZE_MAX;  // index in the list of scene nodes; SIZE_MAX for a root
  glm::dmat4 to_world{1.0};       // all the way, scale included
  Role role = Role::kNone;
  std::size_t owner = SIZE_MAX;  // nearest elastic or tool node at or above it
};

/// Translation, rotation and scale of one node, from its matrix where it has one.
struct NodeTransform {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};
};

/// A matrix without shear as a turn and a scale; the scale may be negative along x (a mirror).
/// Nothing where the axes are not at right angles within 1e-4, or one has no length.
std::optional<NodeTransform> split_transform(const glm::dmat4& matrix);

/// `node`'s own transform. @pre its members have the right number of finite numbers
glm::dmat4 local_matrix(const tinygltf::Node& node);

/// Which scene is shown. @pre the file has one
std::size_t shown_scene(const tinygltf::Model& model);

/// Whether a node of the list is `top` or below it.
bool is_below(const std::vector<SceneNode>& nodes, std::size_t node, std::size_t top);

/// The nodes of the scene that is shown, parents before children, in the order of the file's trees.
std::vector<SceneNode> list_scene_nodes(const tinygltf::Model& model);

}  // namespace torsion::engine
