#include "tests/systems/body_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/body/skeleton/beam_sections.hpp"
#include "systems/model/prepare.hpp"
#include "systems/step.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

/// Appends a grid of (cells x cells) quads that f maps to the surface; outward if f's tangents are
/// counter-clockwise.
template <class F>
void append_patch(std::uint32_t cells_u, std::uint32_t cells_v, const F& f, SurfaceMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t j = 0; j <= cells_v; ++j) {
    for (std::uint32_t i = 0; i <= cells_u; ++i) {
      mesh.positions.push_back(
          f(static_cast<double>(i) / cells_u, static_cast<double>(j) / cells_v));
    }
  }
  for (std::uint32_t j = 0; j < cells_v; ++j) {
    for (std::uint32_t i = 0; i < cells_u; ++i) {
      const std::uint32_t a = first + j * (cells_u + 1) + i;
      const std::uint32_t b = a + cells_u + 1;
      mesh.triangles.emplace_back(a, a + 1, b + 1);
      mesh.triangles.emplace_back(a, b + 1, b);
    }
  }
}

glm::dvec3 box_point(int face, double u, double v) {
  const double x = 2.0 * u - 1.0;
  const double y = 2.0 * v - 1.0;
  switch (face) {
    case 0:
      return {x, y, 1.0};
    case 1:
      return {-x, y, -1.0};
    case 2:
      return {1.0, y, -x};
    case 3:
      return {-1.0, y, x};
    case 4:
      return {x, 1.0, -y};
    default:
      return {x, -1.0, y};
  }
}

}  // namespace

SurfaceMesh shape_surface(ShapeKind kind, const glm::dvec3& half_extent, std::uint32_t cells) {
  SurfaceMesh mesh;
  if (kind == ShapeKind::kBox) {
    for (int face = 0; face < 6; ++face) {
      append_patch(
          cells, cells, [&](double u, double v) { return half_extent * box_point(face, u, v); },
          mesh);
    }
  } else if (kind == ShapeKind::kCylinder) {
    const auto around = [&](double u, double radius, double y) {
      const double angle = -2.0 * pi * u;
      return glm::dvec3(half_extent.x * radius * std::cos(angle), half_extent.y * y,
                        half_extent.x * radius * std::sin(angle));
    };
    append_patch(
        4 * cells, cells, [&](double u, double v) { return around(u, 1.0, 2.0 * v - 1.0); }, mesh);
    append_patch(
        4 * cells, cells, [&](double u, double v) { return around(u, 1.0 - v, 1.0); }, mesh);
    append_patch(
        4 * cells, cells, [&](double u, double v) { return around(u, v, -1.0); }, mesh);
  } else {
    append_patch(
        4 * cells, 2 * cells,
        [&](double u, double v) {
          const double angle = -2.0 * pi * u;
          const double polar = pi * (1.0 - v);
          return half_extent * glm::dvec3(std::sin(polar) * std::cos(angle), std::cos(polar),
                                          std::sin(polar) * std::sin(angle));
        },
        mesh);
  }
  return mesh;
}

BodyDescription exact_body(ShapeKind kind, const glm::dvec3& half_extent, FixedKind fixed,
                           std::uint32_t cells) {
  BodyDescription body;
  body.node = "body";
  body.fixed.kind = fixed;
  body.fixed.point = glm::dvec3(0.0, -half_extent.y, 0.0);
  body.fixed.normal = fixed == FixedKind::kFace ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0);
  body.models.body = BodyModel::kSkeleton;
  body.models.contact = ContactModel::kPaper;
  PartDescription part;
  part.node = "body";
  part.shape.kind = kind;
  part.shape.half_extent = half_extent;
  part.surface = shape_surface(kind, half_extent, cells);
  for (const glm::dvec3& position : part.surface.positions) {
    body.draw.positions.emplace_back(position);
    body.draw.normals.emplace_back(glm::vec3(0.0F, 1.0F, 0.0F));
    const bool lowest = position.y < -half_extent.y * (1.0 - 1e-9);
    const bool middle = glm::length(glm::dvec2(position.x, position.z)) < 1e-9;
    body.draw.fixed.push_back(lowest && (fixed == FixedKind::kFace || middle));
  }
  body.draw.triangles = part.surface.triangles;
  body.parts.push_back(std::move(part));
  return body;
}

World body_world(const BodyDescription& body) {
  World world;
  Capacities capacities;
  capacities.bodies = 1;
  capacities.tools = 1;
  capacities.parts = 2;
  capacities.fixed_volumes = static_cast<std::uint32_t>(body.fixed_volumes.size());
  capacities.anchors = kAnchorsPerBody;
  capacities.regions = kMaxRegionsPerBody;
  world.model.reserve(capacities, Settings{});
  world.state.reserve(capacities, Settings{});

  OwnedRows owned;
  owned.parts = *world.model.parts.append();
  world.model.parts.at<ShapePart>(0) = body.parts.front().shape;
  FixedRegion fixed = body.fixed;
  fixed.volumes =
      *world.model.fixed_volumes.append(static_cast<std::uint32_t>(body.fixed_volumes.size()));
  std::ranges::copy(body.fixed_volumes,
                    world.model.fixed_volumes.rows<FixedVolume>(fixed.volumes).begin());
  const PreparedAnchors prepared = prepare_anchors(body, world.model, owned.parts, fixed.volumes);
  owned.anchors = *world.model.anchors.append(static_cast<std::uint32_t>(prepared.anchors.size()));
  std::ranges::copy(prepared.anchors, world.model.anchors.column<AnchorRest>().begin());
  world.model.sections.append(static_cast<std::uint32_t>(prepared.sections.size()));
  std::ranges::copy(prepared.sections, world.model.sections.column<BeamSection>().begin());

  world.model.bodies.append();
  world.model.bodies.at<Pose>(0) = body.pose;
  world.state.bodies.at<BodyPose>(0) = {body.pose, body.pose};
  world.model.bodies.at<Elasticity>(0) = body.elasticity;
  world.model.bodies.at<Friction>(0) = body.friction;
  world.model.bodies.at<FixedRegion>(0) = fixed;
  world.model.bodies.at<BodyModels>(0) = body.models;
  world.model.bodies.at<OwnedRows>(0) = owned;
  const glm::dvec3 half = body.parts.front().shape.half_extent;
  world.model.bodies.at<Bounds>(0) = {-half, half};

  const Range tool_part = *world.model.parts.append();
  world.model.parts.at<ShapePart>(tool_part.first).kind = ShapeKind::kSphere;
  world.model.parts.at<ShapePart>(tool_part.first).half_extent = glm::dvec3(0.05);
  world.model.parts.at<ShapePart>(tool_part.first).pose = Pose{};
  world.model.tools.append();
  world.state.tools.at<ToolPose>(0) = ToolPose{};
  world.state.tools.at<ToolPose>(0).now.position = glm::dvec3(0.0, 10.0, 0.0);
  world.state.tools.at<ToolWrench>(0) = ToolWrench{};
  world.model.tools.at<OwnedRows>(0).parts = tool_part;
  world.model.tools.at<Bounds>(0) = {glm::dvec3(-0.05), glm::dvec3(0.05)};
  return world;
}

std::uint32_t add_region(World& world, const RegionOnBody& region) {
  const std::uint32_t row = world.state.regions.append()->first;
  world.state.regions.at<RegionIdentity>(row) = RegionIdentity{0, 0, row, Range{row, 1}};
  const TransverseAxes axes = transverse_axes(region.normal, glm::dvec3(0.0, 1.0, 0.0));
  RegionFrame& frame = world.state.regions.at<RegionFrame>(row);
  frame =
      RegionFrame{region.point, axes.first, axes.second, region.normal, glm::dvec2(region.radius)};
  Overlap& overlap = world.state.regions.at<Overlap>(row);
  overlap = Overlap{};
  overlap.center = region.point - 0.5 * region.depth * region.normal;
  overlap.rest_center = region.point;
  overlap.radius = region.radius;
  overlap.area = pi * region.radius * region.radius;
  overlap.mean_depth = 0.5 * region.depth;
  overlap.largest_depth = region.depth;
  world.state.regions.at<Contact>(row) = contact_of(overlap);
  world.state.regions.at<RegionNormal>(row).force = -glm::dot(region.force_on_body, region.normal);
  world.state.regions.at<RegionFriction>(row).force = -glm::dvec2(
      glm::dot(region.force_on_body, axes.first), glm::dot(region.force_on_body, axes.second));
  world.state.regions.at<RegionFriction>(row).couple = -region.couple_on_body;
  // The tool has turned far enough for anything that is drawn.
  world.state.regions.at<RegionMotion>(row).largest_turn = 1.0;
  world.state.regions.at<RegionMotion>(row).largest_rotation = 1.0;
  return row;
}

}  // namespace torsion::engine
