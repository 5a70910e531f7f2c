#include "scenes/gltf_rows.hpp"

#include <cstring>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace torsion::engine {

int append_view(tinygltf::Model& model, int buffer, std::span<const std::byte> bytes, int target) {
  std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(buffer)].data;
  data.resize((data.size() + 3) / 4 * 4);
  tinygltf::BufferView view;
  view.buffer = buffer;
  view.byteOffset = data.size();
  view.byteLength = bytes.size();
  view.target = target;
  data.resize(data.size() + bytes.size());
  std::memcpy(data.data() + view.byteOffset, bytes.data(), bytes.size());
  model.bufferViews.push_back(view);
  return static_cast<int>(model.bufferViews.size()) - 1;
}

int append_rows(tinygltf::Model& model, int buffer, std::span<const std::byte> rows,
                const RowKind& kind) {
  tinygltf::Accessor accessor;
  accessor.bufferView = append_view(model, buffer, rows, kind.target);
  accessor.componentType = kind.component;
  accessor.type = kind.type;
  accessor.count = kind.count;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

int append_times(tinygltf::Model& model, int buffer, std::span<const float> times) {
  const int row = append_rows(model, buffer, std::as_bytes(times),
                              {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, times.size()});
  tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(row)];
  accessor.minValues = {static_cast<double>(times.front())};
  accessor.maxValues = {static_cast<double>(times.back())};
  return row;
}

void add_channel(tinygltf::Animation& animation, int node, const char* path, int times,
                 int values) {
  tinygltf::AnimationSampler sampler;
  sampler.input = times;
  sampler.output = values;
  sampler.interpolation = "LINEAR";
  animation.samplers.push_back(sampler);
  tinygltf::AnimationChannel channel;
  channel.sampler = static_cast<int>(animation.samplers.size()) - 1;
  channel.target_node = node;
  channel.target_path = path;
  animation.channels.push_back(channel);
}

void add_pose_channels(tinygltf::Model& model, tinygltf::Animation& animation, int buffer, int node,
                       int times, std::span<const Pose> poses) {
  std::vector<glm::vec3> translations;
  std::vector<glm::vec4> rotations;
  for (const Pose& pose : poses) {
    const glm::dquat& q = pose.rotation;
    translations.emplace_back(pose.position);
    rotations.emplace_back(glm::dvec4(q.x, q.y, q.z, q.w));
  }
  const auto append = [&](const auto& rows, int type) {
    return append_rows(model, buffer, std::as_bytes(std::span(rows)),
                       {TINYGLTF_COMPONENT_TYPE_FLOAT, type, rows.size()});
  };
  add_channel(animation, node, "translation", times, append(translations, TINYGLTF_TYPE_VEC3));
  add_channel(animation, node, "rotation", times, append(rotations, TINYGLTF_TYPE_VEC4));
}

}  // namespace torsion::engine
