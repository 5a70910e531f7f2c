#include "scenes/load_gltf.hpp"

#include <algorithm>

#include <glm/gtc/quaternion.hpp>

#include "ecs/model_names.hpp"
#include "scenes/fixed_regions.hpp"
#include "scenes/gltf_file.hpp"
#include "scenes/mass_properties.hpp"
#include "scenes/motion.hpp"
#include "scenes/physics_extension.hpp"
#include "scenes/scene_reader.hpp"

namespace torsion::engine {
namespace {

constexpr const char* kStaticFriction = "torsion_static_friction";
constexpr const char* kDynamicFriction = "torsion_dynamic_friction";

Friction read_friction(const SceneReader& reader, std::size_t node) {
  const NodeKeys& keys = reader.keys[node];
  const PhysicsExtension physics = read_physics_extension(reader.model, reader.file_node(node));
  const auto first = [](const std::optional<double>& a, const std::optional<double>& b) {
    return a ? a : b;
  };
  const auto said_static = first(keys.number(kStaticFriction), physics.static_friction);
  const auto said_dynamic = first(keys.number(kDynamicFriction), physics.dynamic_friction);
  Friction friction;
  // One alone holds for both, but a static coefficient below the default leaves no other dynamic
  // one.
  friction.dynamic_friction = said_dynamic.value_or(
      std::min(friction.dynamic_friction, said_static.value_or(friction.dynamic_friction)));
  friction.static_friction = said_static.value_or(friction.dynamic_friction);
  if (friction.static_friction < friction.dynamic_friction) {
    reader.problems.add(reader.name(node), kStaticFriction,
                        std::to_string(friction.static_friction),
                        "expected at least torsion_dynamic_friction, which is " +
                            std::to_string(friction.dynamic_friction),
                        "raise the one or lower the other");
  }
  return friction;
}

std::vector<FixedNode> fixed_nodes(const SceneReader& reader, std::size_t owner,
                                   const glm::dmat4& from_world) {
  std::vector<FixedNode> nodes;
  for (std::size_t node = owner + 1; node < reader.nodes.size(); ++node) {
    const SceneNode& listed = reader.nodes[node];
    if (listed.owner == owner && listed.role != Role::kNone) {
      nodes.push_back({listed.role, from_world * listed.to_world, reader.name(node)});
    }
  }
  return nodes;
}

/// Whether an animation moves a node, or one above it.
bool is_moved(const SceneReader& reader, std::size_t node) {
  for (std::size_t above = 0; above < reader.nodes.size(); ++above) {
    if (is_below(reader.nodes, node, above) && is_animated(reader.model, reader.nodes[above].row)) {
      return true;
    }
  }
  return false;
}

bool any_body_moves(const SceneReader& reader) {
  for (std::size_t node = 0; node < reader.nodes.size(); ++node) {
    if (reader.nodes[node].role == Role::kElastic && is_moved(reader, node)) {
      return true;
    }
  }
  return false;
}

/// What moves a body: its own node or one above. Nothing below it moves on its own.
MotionScript read_body_motion(const SceneReader& reader, std::size_t body) {
  for (std::size_t node = 0; node < reader.nodes.size(); ++node) {
    if (node != body && is_below(reader.nodes, node, body) &&
        is_animated(reader.model, reader.nodes[node].row)) {
      reader.problems.add(reader.name(node), "animation", "",
                          "moves a part of the body " + reader.name(body),
                          "animate the body's own node");
    }
  }
  return is_moved(reader, body) ? read_motion(reader.model, reader.nodes, body, reader.problems)
                                : MotionScript{};
}

BodyDescription read_body(const SceneReader& reader, std::size_t node) {
  const NodeKeys& keys = reader.keys[node];
  OwnerShape shape = read_owner_shape(reader, node);
  BodyDescription body;
  body.node = reader.file_node(node).name;
  body.pose = shape.pose;
  body.parts = std::move(shape.parts);
  body.draw = std::move(shape.draw);
  Elasticity& elasticity = body.elasticity;
  elasticity.youngs_modulus =
      keys.number("torsion_youngs_modulus").value_or(elasticity.youngs_modulus);
  elasticity.poisson_ratio =
      keys.number("torsion_poisson_ratio").value_or(elasticity.poisson_ratio);
  elasticity.density = keys.number("torsion_density").value_or(elasticity.density);
  body.friction = read_friction(reader, node);
  body.models.contact = contact_model_named(keys.text("torsion_contact_model").value_or("auto"))
                            .value_or(ContactModel::kAuto);
  body.models.body =
      body_model_named(keys.text("torsion_body_model").value_or("auto")).value_or(BodyModel::kAuto);
  body.models.tolerance = keys.number("torsion_tolerance").value_or(body.models.tolerance);
  body.models.region_threshold = keys.number("torsion_region_threshold").value_or(0.0);
  body.script = read_body_motion(reader, node);
  if (!body.parts.empty()) {
    const glm::dvec3 up = glm::conjugate(body.pose.rotation) * glm::dvec3(0.0, 1.0, 0.0);
    set_fixed_region(keys.text("torsion_fixed").value_or(""),
                     fixed_nodes(reader, node, shape.from_world), up, reader.name(node), body,
                     reader.problems);
  }
  return body;
}

/// A tool is rigid: nothing below it moves on its own.
void check_tool_is_rigid(const SceneReader& reader, std::size_t tool) {
  for (std::size_t node = tool + 1; node < reader.nodes.size(); ++node) {
    if (is_below(reader.nodes, node, tool) && is_animated(reader.model, reader.nodes[node].row)) {
      reader.problems.add(reader.name(node), "animation", "",
                          "moves a part of the rigid tool " + reader.name(tool),
                          "animate the tool's own node");
    }
  }
}

ToolDescription read_tool(const SceneReader& reader, std::size_t node) {
  const NodeKeys& keys = reader.keys[node];
  OwnerShape shape = read_owner_shape(reader, node);
  ToolDescription tool;
  tool.node = reader.file_node(node).name;
  tool.parts = std::move(shape.parts);
  tool.draw = std::move(shape.draw);
  tool.script = read_motion(reader.model, reader.nodes, node, reader.problems);
  check_tool_is_rigid(reader, node);
  const bool moves = std::ranges::any_of(tool.script.links, [](const MotionLink& link) {
    return !link.animated_translation.empty() || !link.animated_rotation.empty();
  });
  tool.device = keys.text("torsion_device").value_or("animation");
  if (tool.device == "animation" && !moves && !any_body_moves(reader)) {
    reader.problems.add(
        reader.name(node), "animation", "", "is missing: neither the tool nor a body ever moves",
        R"(animate the node, or a body's, or set torsion_device to "mouse" or "usb")");
  }
  const PhysicsExtension physics = read_physics_extension(reader.model, reader.file_node(node));
  tool.mass =
      mass_properties(tool.parts, keys.number("torsion_mass").value_or(physics.mass.value_or(1.0)));
  const auto center = keys.vector("torsion_center_of_mass");
  if (center || physics.mass_center) {
    // In the node's frame, which is scaled; the tool's frame is not.
    const glm::dvec4 in_node(center ? *center : *physics.mass_center, 1.0);
    move_mass_center(tool.mass,
                     glm::dvec3(shape.from_world * reader.nodes[node].to_world * in_node));
  }
  return tool;
}

std::vector<CameraDescription> read_cameras(const SceneReader& reader) {
  std::vector<CameraDescription> cameras;
  for (const SceneNode& node : reader.nodes) {
    const tinygltf::Node& from = reader.model.nodes[node.row];
    const std::optional<NodeTransform> transform = split_transform(node.to_world);
    if (from.camera < 0 || !transform) {
      continue;
    }
    const tinygltf::Camera& camera = reader.model.cameras[static_cast<std::size_t>(from.camera)];
    if (camera.type != "perspective" || !(camera.perspective.yfov > 0.0) ||
        !(camera.perspective.znear > 0.0)) {
      continue;
    }
    cameras.push_back({from.name,
                       {transform->translation, transform->rotation},
                       camera.perspective.yfov,
                       camera.perspective.znear,
                       std::max(camera.perspective.zfar, 0.0)});
  }
  return cameras;
}

SceneView read_view(const NodeKeys& keys) {
  SceneView view;
  view.title = keys.text("torsion_title").value_or("");
  view.caption = keys.text("torsion_caption").value_or("");
  view.loop = keys.flag("torsion_loop").value_or(view.loop);
  view.speed = keys.number("torsion_speed").value_or(view.speed);
  view.colors = keys.text("torsion_colors").value_or("");
  view.stick_slip = keys.flag("torsion_stick_slip").value_or(view.stick_slip);
  view.lines = keys.flag("torsion_lines").value_or(view.lines);
  view.torque_parts = keys.text("torsion_torque") == "parts";
  return view;
}

SceneDescription read_scene(const SceneReader& reader, const std::string& path) {
  SceneDescription scene;
  scene.path = path;
  for (std::size_t node = 0; node < reader.nodes.size(); ++node) {
    if (reader.nodes[node].role == Role::kElastic) {
      scene.bodies.push_back(read_body(reader, node));
      scene.duration = std::max(scene.duration, scene.bodies.back().script.end_time);
    } else if (reader.nodes[node].role == Role::kTool) {
      scene.tools.push_back(read_tool(reader, node));
      scene.duration = std::max(scene.duration, scene.tools.back().script.end_time);
    }
  }
  scene.cameras = read_cameras(reader);
  scene.view = read_view(reader.scene_keys);
  return scene;
}

void check_names(const SceneDescription& scene, const ProblemList& problems) {
  for (std::size_t i = 0; i < scene.tools.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (scene.tools[i].node == scene.tools[j].node) {
        problems.add("node \"" + scene.tools[i].node + '"', "name", "",
                     "is that of another tool; the trace tells tools apart by their names",
                     "give each tool its own name");
      }
    }
  }
}

}  // namespace

LoadedScene load_gltf(const std::filesystem::path& path) {
  LoadedScene loaded;
  const ProblemList problems{path.string(), loaded.problems};
  const std::optional<tinygltf::Model> model = read_gltf_file(path, loaded.problems);
  if (!model) {
    return loaded;
  }
  const SceneReader reader = make_reader(*model, problems);
  check_channels(*model, problems);
  SceneDescription scene = read_scene(reader, path.string());
  if (scene.bodies.empty()) {
    problems.add("", "", "", "has no elastic body",
                 "set torsion_role to \"elastic\" on the node of the body");
  }
  if (scene.tools.empty()) {
    problems.add("", "", "", "has no tool", "set torsion_role to \"tool\" on the node of the tool");
  }
  check_names(scene, problems);
  if (loaded.problems.empty()) {
    loaded.scene = std::move(scene);
  }
  return loaded;
}

}  // namespace torsion::engine
