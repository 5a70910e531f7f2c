#include "scenes/motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>

#include "scenes/extras.hpp"
#include "scenes/gltf_accessors.hpp"

namespace torsion::engine {
namespace {

constexpr double kSameNumber = 1e-6;  // relative: what floats in a file leave of equal numbers

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

/// A node's own placement, the signs of its scale as the file has them: an animated rotation
/// replaces the node's, and the scale stays.
MotionLink rest_link(const tinygltf::Node& node) {
  MotionLink link;
  if (node.matrix.size() == 16) {
    const NodeTransform rest = split_transform(local_matrix(node)).value_or(NodeTransform{});
    return {rest.translation, rest.rotation, rest.scale, {}, {}};
  }
  if (node.translation.size() == 3) {
    link.translation = {node.translation[0], node.translation[1], node.translation[2]};
  }
  if (node.rotation.size() == 4) {
    link.rotation = glm::normalize(
        glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]));
  }
  if (node.scale.size() == 3) {
    link.scale = {node.scale[0], node.scale[1], node.scale[2]};
  }
  return link;
}

/// A scale that does not commute with turns.
bool is_uneven(const glm::dvec3& scale) {
  const double most = std::max({scale.x, scale.y, scale.z});
  const double least = std::min({scale.x, scale.y, scale.z});
  return most - least > kSameNumber * std::max(std::abs(most), std::abs(least));
}

bool is_turned(const MotionLink& link) {
  return !link.animated_rotation.empty() ||
         std::hypot(link.rotation.x, link.rotation.y, link.rotation.z) > kSameNumber;
}

/// Turns below an uneven scale would change the tool's shape as it moves.
void check_scales(const MotionScript& script, const std::vector<std::string>& names,
                  const ProblemList& problems) {
  for (std::size_t i = 0; i < script.links.size(); ++i) {
    const auto below = script.links.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const glm::dvec3& scale = script.links[i].scale;
    if (is_uneven(scale) && std::any_of(below, script.links.end(), is_turned)) {
      std::ostringstream value;
      value << scale.x << ", " << scale.y << ", " << scale.z;
      problems.add(names[i], "scale", value.str(),
                   "expected the same along x, y, z, because the tool below it turns and a rigid "
                   "tool keeps its shape",
                   "apply the scale (Blender: Object > Apply > Scale)");
    }
  }
}

/// The last turn of a tool whose scale mirrors: its shape is read in a frame without the mirror
/// (split_transform), which is turned by half a circle against the one that the links lead to.
std::optional<MotionLink> turn_of_mirror(const MotionScript& script, const SceneNode& tool) {
  const std::optional<NodeTransform> frame = split_transform(tool.to_world);
  glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
  glm::dvec3 scale(1.0);
  for (const MotionLink& link : script.links) {
    rotation = rotation * link.rotation;
    scale *= link.scale;
  }
  if (!frame || std::min({scale.x, scale.y, scale.z}) > 0.0) {
    return std::nullopt;
  }
  MotionLink link;
  link.rotation = glm::normalize(glm::conjugate(rotation) * frame->rotation);
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
  std::vector<std::string> names;
  for (std::size_t node = tool; node != SIZE_MAX; node = nodes[node].parent) {
    MotionLink link = rest_link(model.nodes[nodes[node].row]);
    add_channels(model, nodes[node].row, script, link, problems);
    script.links.push_back(std::move(link));
    names.push_back(called("node", "nodes", nodes[node].row, model.nodes[nodes[node].row].name));
  }
  std::ranges::reverse(script.links);
  std::ranges::reverse(names);
  check_scales(script, names, problems);
  if (const std::optional<MotionLink> turn = turn_of_mirror(script, nodes[tool])) {
    script.links.push_back(*turn);
  }
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

}  // namespace torsion::engine
