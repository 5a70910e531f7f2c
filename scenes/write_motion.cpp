#include "scenes/write_motion.hpp"

#include <algorithm>
#include <span>
#include <sstream>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scenes/gltf_file.hpp"
#include "scenes/gltf_rows.hpp"

namespace torsion::engine {
namespace {

template <class Row>
int add_rows(tinygltf::Model& model, int buffer, std::span<const Row> rows, int type) {
  return append_rows(model, buffer, std::as_bytes(rows),
                     {TINYGLTF_COMPONENT_TYPE_FLOAT, type, rows.size()});
}

/// What moved the node before goes, and an animation of which nothing is left.
void remove_motion(tinygltf::Model& model, int node) {
  for (tinygltf::Animation& animation : model.animations) {
    std::erase_if(animation.channels, [node](const tinygltf::AnimationChannel& channel) {
      return channel.target_node == node &&
             (channel.target_path == "translation" || channel.target_path == "rotation");
    });
  }
  std::erase_if(model.animations,
                [](const tinygltf::Animation& animation) { return animation.channels.empty(); });
}

void add_motion(tinygltf::Model& model, tinygltf::Animation& animation, int buffer, int node,
                const NodeMotion& motion) {
  std::vector<glm::vec3> translations;
  std::vector<glm::vec4> rotations;
  for (const Pose& pose : motion.poses) {
    const glm::dquat& q = pose.rotation;
    translations.emplace_back(pose.position);
    rotations.emplace_back(glm::dvec4(q.x, q.y, q.z, q.w));
  }
  const int times = append_times(model, buffer, motion.times);
  add_channel(animation, node, "translation", times,
              add_rows<glm::vec3>(model, buffer, translations, TINYGLTF_TYPE_VEC3));
  add_channel(animation, node, "rotation", times,
              add_rows<glm::vec4>(model, buffer, rotations, TINYGLTF_TYPE_VEC4));
  // An animated node may have no matrix (glTF 2.0, 3.5.3).
  tinygltf::Node& rest = model.nodes[static_cast<std::size_t>(node)];
  const Pose& first = motion.poses.front();
  rest.matrix.clear();
  rest.translation = {first.position.x, first.position.y, first.position.z};
  rest.rotation = {first.rotation.x, first.rotation.y, first.rotation.z, first.rotation.w};
  rest.scale = {motion.scale.x, motion.scale.y, motion.scale.z};
}

std::size_t row_of(const tinygltf::Model& model, const std::string& node) {
  return static_cast<std::size_t>(std::ranges::find(model.nodes, node, &tinygltf::Node::name) -
                                  model.nodes.begin());
}

}  // namespace

void add_motions(tinygltf::Model& model, const std::string& animation,
                 const std::vector<NodeMotion>& motions) {
  const int buffer = static_cast<int>(model.buffers.size());
  model.buffers.emplace_back();
  tinygltf::Animation added;
  added.name = animation;
  for (const NodeMotion& motion : motions) {
    const int node = static_cast<int>(row_of(model, motion.node));
    remove_motion(model, node);
    add_motion(model, added, buffer, node, motion);
  }
  model.animations.push_back(added);
}

Result<std::string> written(tinygltf::Model& model, bool binary,
                            const std::filesystem::path& path) {
  for (tinygltf::Buffer& each : model.buffers) {
    each.uri.clear();  // inside, wherever the scene's files are
  }
  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, stream, true, binary) || !stream) {
    return Error{path.string() + ": cannot be written as glTF"};
  }
  return stream.str();
}

Result<std::string> with_motions(const std::filesystem::path& path,
                                 const std::vector<NodeMotion>& motions, bool binary) {
  std::vector<Problem> problems;
  std::optional<tinygltf::Model> read = read_gltf_file(path, problems);
  if (!read) {
    return Error{to_text(problems)};
  }
  for (const NodeMotion& motion : motions) {
    if (row_of(*read, motion.node) == read->nodes.size() || motion.poses.empty()) {
      return Error{path.string() + ": no node is named \"" + motion.node +
                   "\", or nothing moves it"};
    }
  }
  add_motions(*read, "recorded", motions);
  return written(*read, binary, path);
}

}  // namespace torsion::engine
