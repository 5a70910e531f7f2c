#include "scenes/node_tree.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scenes/extras.hpp"

namespace torsion::engine {
namespace {

glm::dquat quaternion_of(const std::vector<double>& xyzw) {
  return glm::normalize(glm::dquat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}

std::vector<std::size_t> roots_of(const tinygltf::Model& model) {
  std::vector<std::size_t> roots;
  if (!model.scenes.empty()) {
    for (const int node : model.scenes[shown_scene(model)].nodes) {
      roots.push_back(static_cast<std::size_t>(node));
    }
    return roots;
  }
  std::vector<char> is_child(model.nodes.size(), 0);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      is_child[static_cast<std::size_t>(child)] = 1;
    }
  }
  for (std::size_t row = 0; row < model.nodes.size(); ++row) {
    if (is_child[row] == 0) {
      roots.push_back(row);
    }
  }
  return roots;
}

}  // namespace

std::size_t shown_scene(const tinygltf::Model& model) {
  return static_cast<std::size_t>(std::max(model.defaultScene, 0));
}

bool is_below(const std::vector<SceneNode>& nodes, std::size_t node, std::size_t top) {
  while (node != SIZE_MAX && node != top) {
    node = nodes[node].parent;
  }
  return node == top;
}

std::optional<NodeTransform> split_transform(const glm::dmat4& matrix) {
  glm::dmat3 axes(matrix);
  glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
  const double smallest = std::min({scale.x, scale.y, scale.z});
  if (!(smallest > 1e-9)) {
    return std::nullopt;
  }
  if (glm::determinant(axes) < 0.0) {
    scale.x = -scale.x;
  }
  for (int i = 0; i < 3; ++i) {
    axes[i] /= scale[i];
  }
  const double skew =
      std::max({std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[1], axes[2])),
                std::abs(glm::dot(axes[2], axes[0]))});
  if (skew > 1e-4) {
    return std::nullopt;
  }
  return NodeTransform{glm::dvec3(matrix[3]), glm::normalize(glm::quat_cast(axes)), scale};
}

glm::dmat4 local_matrix(const tinygltf::Node& node) {
  glm::dmat4 matrix(1.0);
  if (node.matrix.size() == 16) {
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row) {
        matrix[column][row] =
            node.matrix[4 * static_cast<std::size_t>(column) + static_cast<std::size_t>(row)];
      }
    }
    return matrix;
  }
  if (node.translation.size() == 3) {
    matrix = glm::translate(
        matrix, glm::dvec3(node.translation[0], node.translation[1], node.translation[2]));
  }
  if (node.rotation.size() == 4) {
    matrix *= glm::mat4_cast(quaternion_of(node.rotation));
  }
  if (node.scale.size() == 3) {
    matrix = glm::scale(matrix, glm::dvec3(node.scale[0], node.scale[1], node.scale[2]));
  }
  return matrix;
}

std::vector<SceneNode> list_scene_nodes(const tinygltf::Model& model) {
  std::vector<SceneNode> nodes;
  std::vector<std::pair<std::size_t, std::size_t>> waiting;  // row, parent
  for (const std::size_t root : roots_of(model)) {
    waiting.emplace_back(root, SIZE_MAX);
  }
  std::ranges::reverse(waiting);
  while (!waiting.empty()) {
    const auto [row, parent] = waiting.back();
    waiting.pop_back();
    const tinygltf::Node& node = model.nodes[row];
    SceneNode listed;
    listed.row = row;
    listed.parent = parent;
    listed.to_world =
        (parent == SIZE_MAX ? glm::dmat4(1.0) : nodes[parent].to_world) * local_matrix(node);
    listed.role = role_of(node.extras);
    const bool owns = listed.role == Role::kElastic || listed.role == Role::kTool;
    listed.owner = owns ? nodes.size() : (parent == SIZE_MAX ? SIZE_MAX : nodes[parent].owner);
    const std::size_t self = nodes.size();
    nodes.push_back(listed);
    const auto siblings = static_cast<std::ptrdiff_t>(waiting.size());
    for (const int child : node.children) {
      waiting.emplace_back(static_cast<std::size_t>(child), self);
    }
    std::reverse(waiting.begin() + siblings, waiting.end());
  }
  return nodes;
}

}  // namespace torsion::engine
