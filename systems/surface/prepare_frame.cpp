#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

#include "systems/surface/anchor_interpolation.hpp"
#include "systems/surface/surface_field.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kHeldPoints =
    12;  // how many points of the fixed region the interpolation keeps in place

/// Points spread over the body's fixed vertices, away from its anchors: each next one is the
/// farthest from all before.
std::vector<glm::dvec3> held_points(const BodyDescription& body, const FixedRegion& fixed,
                                    const Bounds& bounds, std::span<const AnchorRest> anchors) {
  std::vector<glm::dvec3> candidates;
  for (std::size_t i = 0; i < body.draw.fixed.size(); ++i) {
    if (body.draw.fixed[i]) {
      candidates.emplace_back(body.draw.positions[i]);
    }
  }
  if (fixed.kind == FixedKind::kPoint || candidates.empty()) {
    candidates.push_back(fixed.point);
  }
  const double clearance = 0.01 * glm::length(bounds.highest - bounds.lowest);
  std::vector<double> nearest(candidates.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (const AnchorRest& anchor : anchors) {
      nearest[i] = std::min(nearest[i], glm::distance(candidates[i], anchor.position));
    }
  }
  std::vector<glm::dvec3> points;
  while (points.size() < kHeldPoints) {
    const auto farthest = std::max_element(nearest.begin(), nearest.end());
    if (*farthest < clearance) {
      break;
    }
    points.push_back(candidates[static_cast<std::size_t>(farthest - nearest.begin())]);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      nearest[i] = std::min(nearest[i], glm::distance(candidates[i], points.back()));
    }
  }
  return points;
}

/// Centers of the interpolation of one body: its anchors, then points that are held in place.
struct BodyCenters {
  std::vector<glm::dvec3> held;
  std::vector<InterpolationRow> inverse;
};

BodyCenters centers_of(const BodyDescription& body, const Model& model, std::uint32_t row) {
  BodyCenters centers;
  const auto anchors = model.anchors.rows<AnchorRest>(model.bodies.at<OwnedRows>(row).anchors);
  if (anchors.empty()) {
    return centers;
  }
  centers.held =
      held_points(body, model.bodies.at<FixedRegion>(row), model.bodies.at<Bounds>(row), anchors);
  std::vector<glm::dvec3> all;
  for (const AnchorRest& anchor : anchors) {
    all.push_back(anchor.position);
  }
  all.insert(all.end(), centers.held.begin(), centers.held.end());
  centers.inverse = invert_interpolation(all);
  return centers;
}

template <class AnyTable>
Range append_rows(AnyTable& table, std::size_t count) {
  const std::optional<Range> range = table.append(static_cast<std::uint32_t>(count));
  TORSION_ASSERT(range.has_value());
  return *range;
}

/// Where a material lies among those of the frame; it is added where it is not there yet.
std::uint32_t material_row(const DrawMaterial& material, std::vector<DrawMaterial>& materials) {
  const auto found = std::ranges::find(materials, material);
  const auto row = static_cast<std::uint32_t>(found - materials.begin());
  if (found == materials.end()) {
    materials.push_back(material);
  }
  return row;
}

/// A group for each run of triangles of one material.
/// @param triangles  the mesh's, in the table of its kind
Range append_groups(const DrawMesh& mesh, Range triangles, Table<DrawGroup>& groups,
                    std::vector<DrawMaterial>& materials) {
  const std::vector<MaterialRun> runs = material_runs(mesh.triangle_materials, triangles.count);
  const Range range = append_rows(groups, runs.size());
  for (std::uint32_t i = 0; i < range.count; ++i) {
    const Range run = runs[i].triangles;
    groups.at<DrawGroup>(range.first + i) = {
        {triangles.first + run.first, run.count},
        material_row(mesh.materials[runs[i].material], materials)};
  }
  return range;
}

/// Copies a drawn mesh into the vertex and triangle tables of its kind.
template <class VertexTable>
DrawRange append_mesh(const DrawMesh& mesh, VertexTable& vertices, Table<Triangle>& triangles,
                      Table<DrawGroup>& groups, std::vector<DrawMaterial>& materials) {
  DrawRange range;
  range.vertices = append_rows(vertices, mesh.positions.size());
  range.triangles = append_rows(triangles, mesh.triangles.size());
  range.groups = append_groups(mesh, range.triangles, groups, materials);
  const auto rest = vertices.template rows<VertexRest>(range.vertices);
  const auto normals = vertices.template rows<VertexNormal>(range.vertices);
  const auto paint = vertices.template rows<VertexPaint>(range.vertices);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const bool fixed = i < mesh.fixed.size() && mesh.fixed[i];
    rest[i].position = glm::vec4(mesh.positions[i], fixed ? 1.0F : 0.0F);
    paint[i].uv = i < mesh.texcoords.size() ? mesh.texcoords[i] : glm::vec2(0.0F);
    paint[i].color = i < mesh.colors.size() ? mesh.colors[i] : glm::vec3(1.0F);
    normals[i].normal =
        i < mesh.normals.size() ? glm::vec4(mesh.normals[i], 0.0F) : glm::vec4(0.0F);
  }
  const auto corners = triangles.rows<Triangle>(range.triangles);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    corners[i].vertices = mesh.triangles[i];
  }
  return range;
}

void reserve(const SceneDescription& scene, const Model& model,
             const std::vector<BodyCenters>& centers, FrameWorld& frame) {
  std::size_t body_vertices = 0;
  std::size_t body_triangles = 0;
  std::size_t tool_vertices = 0;
  std::size_t tool_triangles = 0;
  std::size_t body_groups = 0;
  std::size_t tool_groups = 0;
  std::size_t held = 0;
  std::size_t interpolation = 0;
  for (const BodyDescription& body : scene.bodies) {
    body_vertices += body.draw.positions.size();
    body_triangles += body.draw.triangles.size();
    body_groups += body.draw.materials.size();
  }
  for (const ToolDescription& tool : scene.tools) {
    tool_vertices += tool.draw.positions.size();
    tool_triangles += tool.draw.triangles.size();
    tool_groups += tool.draw.materials.size();
  }
  for (const BodyCenters& center : centers) {
    held += center.held.size();
    interpolation += center.inverse.size();
  }
  const auto rows = [](std::size_t count) {
    return static_cast<std::uint32_t>(count);
  };
  frame.bodies.reserve(rows(scene.bodies.size()));
  frame.tools.reserve(rows(scene.tools.size()));
  frame.body_vertices.reserve(rows(body_vertices));
  frame.twist.reserve(rows(body_vertices * kMaxRegionsPerBody));
  frame.axes.reserve(rows(scene.bodies.size() * kMaxRegionsPerBody));
  frame.body_triangles.reserve(rows(body_triangles));
  frame.body_groups.reserve(rows(body_groups));
  frame.tool_vertices.reserve(rows(tool_vertices));
  frame.tool_triangles.reserve(rows(tool_triangles));
  frame.tool_groups.reserve(rows(tool_groups));
  frame.anchor_rest.reserve(model.anchors.size() + rows(held));
  frame.interpolation.reserve(rows(interpolation));
}

void append_body(const BodyDescription& body, const Model& model, const State& state,
                 const BodyCenters& centers, FrameWorld& frame) {
  const std::uint32_t row = append_rows(frame.bodies, 1).first;
  const DrawRange drawn = append_mesh(body.draw, frame.body_vertices, frame.body_triangles,
                                      frame.body_groups, frame.materials);
  FrameBody data;
  data.anchors = centers.inverse.empty() ? Range{} : model.bodies.at<OwnedRows>(row).anchors;
  data.held_points = append_rows(frame.anchor_rest, centers.held.size());
  for (std::size_t i = 0; i < centers.held.size(); ++i) {
    frame.anchor_rest.rows<AnchorRest>(data.held_points)[i].position = centers.held[i];
  }
  data.interpolation = append_rows(frame.interpolation, centers.inverse.size());
  std::ranges::copy(centers.inverse,
                    frame.interpolation.rows<InterpolationRow>(data.interpolation).begin());
  data.twist = append_rows(frame.twist, std::size_t{drawn.vertices.count} * kMaxRegionsPerBody);
  data.axes = append_rows(frame.axes, kMaxRegionsPerBody);
  frame.bodies.at<Pose>(row) = state.bodies.at<BodyPose>(row).now;
  frame.bodies.at<DrawRange>(row) = drawn;
  frame.bodies.at<FrameBody>(row) = data;
}

}  // namespace

FrameWorld prepare_frame(const SceneDescription& scene, const Model& model, const State& state) {
  std::vector<BodyCenters> centers;
  for (std::uint32_t row = 0; row < model.bodies.size(); ++row) {
    centers.push_back(centers_of(scene.bodies[row], model, row));
  }
  FrameWorld frame;
  reserve(scene, model, centers, frame);
  const Range anchors = append_rows(frame.anchor_rest, model.anchors.size());
  std::ranges::copy(model.anchors.column<AnchorRest>(),
                    frame.anchor_rest.rows<AnchorRest>(anchors).begin());
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    append_body(scene.bodies[body], model, state, centers[body], frame);
  }
  for (const ToolDescription& tool : scene.tools) {
    const std::uint32_t row = append_rows(frame.tools, 1).first;
    frame.tools.at<Pose>(row) = state.tools.at<ToolPose>(row).now;
    frame.tools.at<DrawRange>(row) = append_mesh(
        tool.draw, frame.tool_vertices, frame.tool_triangles, frame.tool_groups, frame.materials);
  }
  return frame;
}

}  // namespace torsion::engine
