#include "scenes/motion.hpp"

#include <algorithm>
#include <set>

#include "scenes/extras.hpp"
#include "scenes/gltf_accessors.hpp"

namespace torsion {
namespace {

Interpolation interpolation_of(const std::string& name) {
  if (name == "STEP") {
    return Interpolation::kStep;
  }
  return name == "CUBICSPLINE" ? Interpolation::kCubicSpline : Interpolation::kLinear;
}

KeyedChannel read_channel(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler) {
  KeyedChannel channel;
  channel.interpolation = interpolation_of(sampler.interpolation);
  channel.times = read_numbers(model, sampler.input);
  const std::vector<double> numbers = read_numbers(model, sampler.output);
  const bool rotation =
      model.accessors[static_cast<std::size_t>(sampler.output)].type == TINYGLTF_TYPE_VEC4;
  const std::size_t width = rotation ? 4 : 3;
  for (std::size_t i = 0; i + width <= numbers.size(); i += width) {
    channel.values.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2],
                                rotation ? numbers[i + 3] : 0.0);
  }
  return channel;
}

MotionLink rest_link(const tinygltf::Node& node) {
  MotionLink link;
  const auto rest = split_transform(local_matrix(node));
  if (rest) {
    link.translation = rest->translation;
    link.rotation = rest->rotation;
    link.scale = rest->scale;
  }
  return link;
}

/// Adds the channels that move the node `row`.
void add_channels(const tinygltf::Model& model, std::size_t row, MotionScript& script,
                  MotionLink& link, const ProblemList& problems) {
  for (const tinygltf::Animation& animation : model.animations) {
    for (const tinygltf::AnimationChannel& from : animation.channels) {
      if (from.target_node != static_cast<int>(row) || from.target_path == "weights") {
        continue;
      }
      if (from.target_path == "scale") {
        problems.add(called("node", "nodes", row, model.nodes[row].name), "scale", "",
                     "is animated, but a tool is rigid", "delete the scale channel");
        continue;
      }
      KeyedChannel channel =
          read_channel(model, animation.samplers[static_cast<std::size_t>(from.sampler)]);
      script.end_time = std::max(script.end_time, channel.times.back());
      (from.target_path == "rotation" ? link.animated_rotation : link.animated_translation) =
          std::move(channel);
    }
  }
}

}  // namespace

MotionScript read_motion(const tinygltf::Model& model, const std::vector<SceneNode>& nodes,
                         std::size_t tool, const ProblemList& problems) {
  MotionScript script;
  for (std::size_t node = tool; node != SIZE_MAX; node = nodes[node].parent) {
    MotionLink link = rest_link(model.nodes[nodes[node].row]);
    add_channels(model, nodes[node].row, script, link, problems);
    script.links.push_back(std::move(link));
  }
  std::ranges::reverse(script.links);
  return script;
}

bool is_animated(const tinygltf::Model& model, std::size_t row) {
  return std::ranges::any_of(model.animations, [row](const tinygltf::Animation& animation) {
    return std::ranges::any_of(animation.channels, [row](const auto& channel) {
      return channel.target_node == static_cast<int>(row) && channel.target_path != "weights";
    });
  });
}

void check_channels(const tinygltf::Model& model, const ProblemList& problems) {
  std::set<std::pair<int, std::string>> moved;
  for (const tinygltf::Animation& animation : model.animations) {
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (channel.target_node >= 0 &&
          !moved.insert({channel.target_node, channel.target_path}).second) {
        const auto row = static_cast<std::size_t>(channel.target_node);
        problems.add(called("node", "nodes", row, model.nodes[row].name), channel.target_path, "",
                     "is moved by two channels at once",
                     "keep one animation a node (Blender: one action, or stash the others)");
      }
    }
  }
}

}  // namespace torsion
