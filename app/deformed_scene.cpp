#include "app/deformed_scene.hpp"

#include <array>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "systems/surface/surface_field.hpp"

namespace torsion::engine {
namespace {

/// Vertices at one place with one normal at rest are one surface, however the file splits them.
std::vector<std::uint32_t> joined_vertices(const DrawMesh& rest) {
  std::map<std::array<float, 6>, std::uint32_t> first;
  std::vector<std::uint32_t> joined;
  for (std::uint32_t i = 0; i < rest.positions.size(); ++i) {
    const glm::vec3& p = rest.positions[i];
    const glm::vec3& n = rest.normals[i];
    joined.push_back(first.try_emplace({p.x, p.y, p.z, n.x, n.y, n.z}, i).first->second);
  }
  return joined;
}

/// Normals of the deformed surface: triangles' normals weighted by area, over joined vertices.
std::vector<glm::vec3> deformed_normals(const WrittenMesh& mesh, const DrawMesh& rest) {
  const std::vector<std::uint32_t> joined = joined_vertices(rest);
  std::vector<glm::vec3> sums(mesh.positions.size(), glm::vec3(0.0F));
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 area = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                      mesh.positions[t.z] - mesh.positions[t.x]);
    for (int i = 0; i < 3; ++i) {
      sums[joined[t[i]]] += area;
    }
  }
  std::vector<glm::vec3> normals;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const glm::vec3 sum = sums[joined[i]];
    const float length = glm::length(sum);
    normals.push_back(length > 0.0F ? sum / length : rest.normals[i]);
  }
  return normals;
}

/// Triangles, and what is on them.
void set_look(const DrawMesh& draw, WrittenMesh& mesh) {
  mesh.triangles = draw.triangles;
  mesh.texcoords = draw.texcoords;
  mesh.colors = draw.colors;
  mesh.materials = draw.materials;
  mesh.triangle_materials = draw.triangle_materials;
}

WrittenMesh deformed_body(const Session& session, const FrameWorld& frame, std::uint32_t row) {
  const BodyDescription& body = session.scene.bodies[row];
  WrittenMesh mesh;
  mesh.name = body.node;
  mesh.pose = session.simulation.world.state.bodies.at<BodyPose>(row).now;
  set_look(body.draw, mesh);
  mesh.rest_positions = body.draw.positions;
  std::vector<glm::vec4> deformed(body.draw.positions.size());
  deform_vertices(frame, row, deformed);
  for (const glm::vec4& vertex : deformed) {
    mesh.positions.emplace_back(vertex);
    mesh.twist_angles.push_back(vertex.w);
  }
  mesh.normals = deformed_normals(mesh, body.draw);
  return mesh;
}

WrittenMesh rest_mesh(const std::string& name, const Pose& pose, const DrawMesh& draw) {
  WrittenMesh mesh;
  mesh.name = name;
  mesh.pose = pose;
  set_look(draw, mesh);
  mesh.positions = draw.positions;
  mesh.normals = draw.normals;
  return mesh;
}

std::vector<BodyModel> body_models(const Model& model) {
  std::vector<BodyModel> models;
  for (const BodyModels& chosen : model.bodies.column<BodyModels>()) {
    models.push_back(chosen.body);
  }
  return models;
}

WrittenMesh placed_tool(const Session& session, std::uint32_t row) {
  const ToolDescription& tool = session.scene.tools[row];
  return rest_mesh(tool.node, session.simulation.world.state.tools.at<ToolPose>(row).now,
                   tool.draw);
}

}  // namespace

std::vector<WrittenMesh> deformed_scene(const Session& session) {
  const World& world = session.simulation.world;
  FrameWorld frame = prepare_frame(session.scene, world.model, world.state);
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  take_snapshot(session.simulation, snapshot);
  surface_field(world.model, snapshot, frame);
  std::vector<WrittenMesh> meshes;
  for (std::uint32_t body = 0; body < session.scene.bodies.size(); ++body) {
    meshes.push_back(deformed_body(session, frame, body));
  }
  for (std::uint32_t tool = 0; tool < session.scene.tools.size(); ++tool) {
    meshes.push_back(placed_tool(session, tool));
  }
  return meshes;
}

DeformedRun::DeformedRun(const Session& session)
    : frame_(prepare_frame(session.scene, session.simulation.world.model,
                           session.simulation.world.state)),
      frame_models_(body_models(session.simulation.world.model)) {
  const World& world = session.simulation.world;
  snapshot_.reserve(world.model, world.state);
  for (std::uint32_t row = 0; row < session.scene.bodies.size(); ++row) {
    const BodyDescription& body = session.scene.bodies[row];
    meshes_.push_back(
        {rest_mesh(body.node, world.state.bodies.at<BodyPose>(row).now, body.draw), {}, {}});
  }
  for (std::uint32_t tool = 0; tool < session.scene.tools.size(); ++tool) {
    meshes_.push_back({placed_tool(session, tool), {}, {}});
  }
}

void DeformedRun::add(const Session& session, double time) {
  const World& world = session.simulation.world;
  // A frame hangs on the body's anchors, which another model has elsewhere.
  if (std::vector<BodyModel> now = body_models(world.model); now != frame_models_) {
    frame_ = prepare_frame(session.scene, world.model, world.state);
    frame_models_ = std::move(now);
  }
  take_snapshot(session.simulation, snapshot_);
  surface_field(world.model, snapshot_, frame_);
  const auto bodies = static_cast<std::uint32_t>(session.scene.bodies.size());
  for (std::uint32_t body = 0; body < bodies; ++body) {
    const WrittenMesh now = deformed_body(session, frame_, body);
    const WrittenMesh& rest = meshes_[body].rest;
    MorphTarget target;
    for (std::size_t i = 0; i < now.positions.size(); ++i) {
      target.positions.push_back(now.positions[i] - rest.positions[i]);
      target.normals.push_back(now.normals[i] - rest.normals[i]);
    }
    target.twist_angles = now.twist_angles;
    meshes_[body].targets.push_back(std::move(target));
    if (world.model.moves(body)) {
      meshes_[body].poses.push_back(now.pose);
    }
  }
  std::vector<Felt> felt;
  for (std::uint32_t tool = 0; tool < session.scene.tools.size(); ++tool) {
    meshes_[bodies + tool].poses.push_back(world.state.tools.at<ToolPose>(tool).now);
    felt.push_back({world.state.tools.at<ToolWrench>(tool).total,
                    world.state.tools.at<ToolMotion>(tool).mass_center});
  }
  felt_.push_back(std::move(felt));
  widen(limits_, world.state.tools, world.state.regions);
  times_.push_back(static_cast<float>(time));
}

}  // namespace torsion::engine
