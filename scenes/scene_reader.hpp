#pragma once

#include <string>
#include <vector>

#include "ecs/scene_description.hpp"
#include "scenes/extras.hpp"
#include "scenes/materials.hpp"
#include "scenes/node_tree.hpp"

namespace torsion::engine {

/// What reading one file needs all along.
struct SceneReader {
  const tinygltf::Model& model;
  const ProblemList& problems;
  std::vector<SceneNode> nodes;
  std::vector<NodeKeys> keys;  // one for each of `nodes`
  NodeKeys scene_keys;         // of the scene that is shown
  SceneImages images;

  [[nodiscard]] const tinygltf::Node& file_node(std::size_t node) const {
    return model.nodes[nodes[node].row];
  }
  [[nodiscard]] std::string name(std::size_t node) const {
    return called("node", "nodes", nodes[node].row, file_node(node).name);
  }
  /// The node's mesh; null where it has none.
  [[nodiscard]] const tinygltf::Mesh* mesh(std::size_t node) const {
    const int row = file_node(node).mesh;
    return row < 0 ? nullptr : &model.meshes[static_cast<std::size_t>(row)];
  }
};

/// Lists the nodes of the scene that is shown and reads their keys, each on a node that may have
/// it.
SceneReader make_reader(const tinygltf::Model& model, const ProblemList& problems);

/// A tool's or body's shape: what is felt and what is drawn.
struct OwnerShape {
  Pose pose;  // owner's frame in the world
  glm::dmat4 from_world{1.0};
  MeshLook look;
  bool rigid = false;  // a tool, whose drawn surface does not bend
  std::vector<PartDescription> parts;
  DrawMesh draw;
};

/// The meshes at and below an elastic or tool node, in its frame without its scale: each is a part.
OwnerShape read_owner_shape(const SceneReader& reader, std::size_t owner);

}  // namespace torsion::engine
