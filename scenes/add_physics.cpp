#include "scenes/add_physics.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <optional>

#include <glm/gtc/quaternion.hpp>

#include "scenes/gltf_file.hpp"
#include "scenes/mesh_parts.hpp"
#include "scenes/motion.hpp"
#include "scenes/node_tree.hpp"
#include "scenes/write_motion.hpp"

namespace torsion::engine {
namespace {

// Soft rubber: a hand's force twists it visibly.
constexpr double kYoungsModulus = 1e5;  // Pa
constexpr double kPoissonRatio = 0.45;
constexpr double kFriction = 0.75;

constexpr double kRadiusShare = 0.15;     // of the body's least side: of the ball
constexpr double kDepthShare = 0.25;      // of the radius
constexpr double kClearanceShare = 0.05;  // of the radius
constexpr double kTopShare = 1e-3;        // of the body's height, that counts as highest

std::string digits(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", number);
  return text.data();
}

void set_keys(tinygltf::Node& node, const tinygltf::Value::Object& keys) {
  tinygltf::Value::Object all = node.extras.IsObject() ? node.extras.Get<tinygltf::Value::Object>()
                                                       : tinygltf::Value::Object{};
  for (const auto& [key, value] : keys) {
    all[key] = value;
  }
  node.extras = tinygltf::Value(all);
}

/// Names of the scene's nodes with meshes, as a person reads them.
std::string names_of(const tinygltf::Model& model, const std::vector<SceneNode>& nodes) {
  std::string names;
  for (const SceneNode& node : nodes) {
    if (model.nodes[node.row].mesh >= 0) {
      names += (names.empty() ? "\"" : ", \"") + model.nodes[node.row].name + '"';
    }
  }
  return names;
}

/// The only node that `name` can mean: index among `nodes`.
Result<std::size_t> find_node(const tinygltf::Model& model, const std::vector<SceneNode>& nodes,
                              const std::string& name, const std::string& option) {
  std::vector<std::size_t> found;
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    const tinygltf::Node& in_file = model.nodes[nodes[node].row];
    if (name.empty() ? in_file.mesh >= 0 : in_file.name == name) {
      found.push_back(node);
    }
  }
  if (found.size() == 1) {
    return found[0];
  }
  const std::string have = "; nodes with meshes: " + names_of(model, nodes);
  if (name.empty()) {
    return Error{found.empty() ? "no node has a mesh"
                               : "several nodes have meshes; say which by " + option + have};
  }
  return Error{(found.empty() ? "no node is named \"" : "several nodes are named \"") + name + '"' +
               have};
}

/// What of the body is where, in the world.
struct BodyExtent {
  glm::dvec3 low{1e300};    // m
  glm::dvec3 high{-1e300};  // m
  glm::dvec3 top{0.0};      // m: the middle of its highest vertices
};

BodyExtent extent_of(const tinygltf::Model& model, const std::vector<SceneNode>& nodes,
                     std::size_t body, const ProblemList& problems) {
  std::vector<glm::dvec3> positions;
  for (std::size_t node = body; node < nodes.size(); ++node) {
    const tinygltf::Node& in_file = model.nodes[nodes[node].row];
    if (in_file.mesh >= 0 && is_below(nodes, node, body)) {
      const MeshTriangles mesh =
          read_mesh(model, model.meshes[static_cast<std::size_t>(in_file.mesh)],
                    nodes[node].to_world, {}, "node \"" + in_file.name + '"', problems);
      positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    }
  }
  BodyExtent extent;
  for (const glm::dvec3& position : positions) {
    extent.low = glm::min(extent.low, position);
    extent.high = glm::max(extent.high, position);
  }
  double count = 0.0;
  const double lowest = extent.high.y - kTopShare * (extent.high.y - extent.low.y);
  for (const glm::dvec3& position : positions) {
    if (position.y >= lowest) {
      extent.top += position;
      count += 1.0;
    }
  }
  extent.top /= std::max(count, 1.0);
  return extent;
}

/// A ball of its own above the body, and what it does.
/// @return what was assumed, in words
std::string add_ball(tinygltf::Model& model, const BodyExtent& extent) {
  const glm::dvec3 size = extent.high - extent.low;
  const double radius = kRadiusShare * std::min({size.x, size.y, size.z});
  tinygltf::Node ball;
  ball.name = "ball";
  while (std::ranges::count(model.nodes, ball.name, &tinygltf::Node::name) > 0) {
    ball.name += '_';
  }
  const tinygltf::Value side(2.0 * radius);
  set_keys(ball, {{"torsion_role", tinygltf::Value(std::string("tool"))},
                  {"torsion_shape", tinygltf::Value(std::string("sphere"))},
                  {"torsion_size", tinygltf::Value(tinygltf::Value::Array{side, side, side})}});
  model.nodes.push_back(ball);
  model.scenes[shown_scene(model)].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
  NodeMotion motion;
  motion.node = ball.name;
  const double above = extent.top.y + radius;
  const auto add = [&](float time, double height, double degrees) {
    motion.times.push_back(time);
    motion.poses.push_back(
        {{extent.top.x, height, extent.top.z},
         glm::angleAxis(degrees * std::numbers::pi / 180.0, glm::dvec3(0.0, 1.0, 0.0))});
  };
  add(0.0F, above + kClearanceShare * radius, 0.0);
  add(1.0F, above - kDepthShare * radius, 0.0);
  add(2.5F, above - kDepthShare * radius, 40.0);
  add(4.0F, above - kDepthShare * radius, 0.0);
  add(5.0F, above + kClearanceShare * radius, 0.0);
  add_motions(model, "press and twist", {motion});
  return "tool \"" + ball.name + "\": a ball of radius " + digits(radius) +
         " m, which presses by " + digits(kDepthShare * radius) +
         " m on the body's highest place and turns by 40 degrees and back";
}

/// Keys of the node that is to be the body, and of the meshes below that it is made of.
std::string make_elastic(tinygltf::Model& model, const std::vector<SceneNode>& nodes,
                         std::size_t body, const BodyExtent& extent, const std::string& shape) {
  tinygltf::Node& node = model.nodes[nodes[body].row];
  set_keys(node, {{"torsion_role", tinygltf::Value(std::string("elastic"))},
                  {"torsion_youngs_modulus", tinygltf::Value(kYoungsModulus)},
                  {"torsion_poisson_ratio", tinygltf::Value(kPoissonRatio)},
                  {"torsion_dynamic_friction", tinygltf::Value(kFriction)},
                  {"torsion_fixed", tinygltf::Value(std::string("bottom_face"))}});
  for (std::size_t below = body; below < nodes.size() && !shape.empty(); ++below) {
    tinygltf::Node& part = model.nodes[nodes[below].row];
    if (part.mesh >= 0 && is_below(nodes, below, body)) {
      set_keys(part, {{"torsion_shape", tinygltf::Value(shape)}});
    }
  }
  const glm::dvec3 size = extent.high - extent.low;
  return "body \"" + node.name + "\": " + digits(size.x) + " x " + digits(size.y) + " x " +
         digits(size.z) + " m, as the file says; E " + digits(kYoungsModulus) + " Pa, nu " +
         digits(kPoissonRatio) + ", friction " + digits(kFriction) + "; held by its bottom face";
}

std::string make_tool(tinygltf::Model& model, const SceneNode& tool) {
  tinygltf::Node& node = model.nodes[tool.row];
  const bool moves = is_animated(model, tool.row);
  set_keys(node, {{"torsion_role", tinygltf::Value(std::string("tool"))}});
  if (!moves) {
    set_keys(node, {{"torsion_device", tinygltf::Value(std::string("mouse"))}});
  }
  return "tool \"" + node.name + "\": 1 kg; " +
         (moves ? "moved by the file's animation" : "moved by a mouse, for nothing animates it");
}

}  // namespace

Result<PhysicsAdded> with_physics(const std::filesystem::path& path, const PhysicsToAdd& add,
                                  bool binary) {
  std::vector<Problem> problems;
  std::optional<tinygltf::Model> model = read_gltf_file(path, problems);
  if (!model) {
    return Error{to_text(problems)};
  }
  const auto failed = [&path](const std::string& why) {
    return Error{path.string() + ": " + why};
  };
  if (model->scenes.empty()) {
    return failed("it has no scene: export it as one");
  }
  const std::vector<SceneNode> nodes = list_scene_nodes(*model);
  const Result<std::size_t> body = find_node(*model, nodes, add.body, "--body");
  if (!body) {
    return failed(body.error().text);
  }
  const BodyExtent extent = extent_of(*model, nodes, body.value(), {path.string(), problems});
  if (!problems.empty()) {
    return Error{to_text(problems)};
  }
  if (!(extent.high.x > extent.low.x && extent.high.y > extent.low.y &&
        extent.high.z > extent.low.z)) {
    return failed("node \"" + model->nodes[nodes[body.value()].row].name +
                  "\" has no solid mesh, here or below");
  }
  PhysicsAdded added;
  added.assumed.push_back(make_elastic(*model, nodes, body.value(), extent, add.shape));
  if (add.tool.empty()) {
    added.assumed.push_back(add_ball(*model, extent));
  } else {
    const Result<std::size_t> tool = find_node(*model, nodes, add.tool, "--tool");
    if (!tool) {
      return failed(tool.error().text);
    }
    added.assumed.push_back(make_tool(*model, nodes[tool.value()]));
  }
  Result<std::string> bytes = written(*model, binary, path);
  if (!bytes) {
    return bytes.error();
  }
  added.bytes = std::move(bytes).value();
  return added;
}

}  // namespace torsion::engine
