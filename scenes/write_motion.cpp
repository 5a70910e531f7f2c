#include "scenes/write_motion.hpp"

#include <algorithm>
#include <sstream>

#include "scenes/gltf_file.hpp"
#include "scenes/gltf_rows.hpp"
#include "scenes/write_materials.hpp"

namespace torsion::engine {
namespace {

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
  const int times = append_times(model, buffer, motion.times);
  add_pose_channels(model, animation, buffer, node, times, motion.poses);
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
  embed_images(model);
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
