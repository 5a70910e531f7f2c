#include "render/frame_view.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/box.hpp"
#include "render/studio_light.hpp"

namespace torsion::engine {
namespace {

// The light's colours, linear. A white surface that faces the key light reaches 1 with the studio's
// part.
constexpr glm::vec3 kKeyLight(0.62F, 0.60F, 0.57F);
constexpr float kEyeLight = 0.10F;
constexpr double kShadowStep = 2.5;      // texels: half the width of a shadow's edge
constexpr double kClearToolShade = 0.4;  // share of the key light that a glass tool takes
constexpr glm::vec3 kBackground(0.78F, 0.80F, 0.83F);

// The arc of a tool's torque goes around the tool, within these parts of the bodies' largest side.
constexpr double kArcBeside = 1.25;  // of the tool's smallest half size
constexpr double kSmallestArc = 0.25;
constexpr double kLargestArc = 0.75;

glm::dvec3 to_world(const Pose& pose, const glm::vec4& point) {
  return pose.rotation * glm::dvec3(point) + pose.position;
}

/// Box in the thing's own frame; adds its points to `world` too.
Box measure(const Pose& pose, std::span<const VertexRest> vertices, Box& world) {
  Box own;
  for (const VertexRest& vertex : vertices) {
    own.add(glm::dvec3(vertex.position));
    world.add(to_world(pose, vertex.position));
  }
  return own;
}

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

double smallest(const glm::dvec3& v) {
  return std::min({v.x, v.y, v.z});
}

/// Looks along the key light at the ball around the scene.
glm::dmat4 shadow_from_world(const SceneExtent& extent) {
  const glm::dvec3 z = kToKeyLight;
  const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), z));
  const glm::dvec3 y = glm::cross(z, x);
  const double scale = 0.5 / extent.radius;
  const auto row = [&](const glm::dvec3& axis, double sign) {
    return glm::dvec4(sign * scale * axis, 0.5 - sign * scale * glm::dot(axis, extent.center));
  };
  return glm::transpose(
      glm::dmat4(row(x, 1.0), row(y, -1.0), row(z, -1.0), glm::dvec4(0.0, 0.0, 0.0, 1.0)));
}

}  // namespace

SceneExtent scene_extent(const FrameWorld& frame) {
  SceneExtent extent;
  Box bodies;
  for (std::uint32_t row = 0; row < frame.bodies.size(); ++row) {
    const Box own = measure(
        frame.bodies.at<Pose>(row),
        frame.body_vertices.rows<VertexRest>(frame.bodies.at<DrawRange>(row).vertices), bodies);
    extent.grids.emplace_back(glm::vec3(own.center()),
                              static_cast<float>(grid_spacing(largest(own.size()))));
  }
  Box all = bodies;
  for (std::uint32_t row = 0; row < frame.tools.size(); ++row) {
    const Box own =
        measure(frame.tools.at<Pose>(row),
                frame.tool_vertices.rows<VertexRest>(frame.tools.at<DrawRange>(row).vertices), all);
    extent.tool_centers.emplace_back(glm::vec3(own.center()), 0.0F);
    extent.arc_radii.push_back(kArcBeside * smallest(own.size()) / 2.0);
  }
  const Box& floor = bodies.empty() ? all : bodies;
  if (floor.empty()) {
    return extent;
  }
  extent.lowest = floor.lowest;
  extent.highest = floor.highest;
  const double side = largest(floor.size());
  for (double& radius : extent.arc_radii) {
    radius = std::clamp(radius, kSmallestArc * side, kLargestArc * side);
  }
  // A tool that starts far away must not spoil the shadow map: past three times the bodies' size it
  // is not counted.
  const double body_radius = 0.5 * glm::length(floor.size());
  extent.center = floor.center();
  extent.radius = std::clamp(1.05 * glm::length(glm::max(glm::abs(all.highest - extent.center),
                                                         glm::abs(all.lowest - extent.center))),
                             1.5 * body_radius, 3.0 * body_radius);
  return extent;
}

double grid_spacing(double size) {
  if (!(size > 0.0)) {
    return 0.0;
  }
  const double decade = std::pow(10.0, std::floor(std::log10(size / 10.0)));
  for (const double step : {5.0, 2.0}) {
    if (step * decade <= size / 10.0) {
      return step * decade;
    }
  }
  return decade;
}

shared::FrameUniforms frame_uniforms(const SceneExtent& extent, const Camera& camera, double aspect,
                                     std::uint32_t shadow_size, const DrawOptions& options) {
  const glm::dvec3 size = extent.highest - extent.lowest;
  const glm::dvec3 middle = 0.5 * (extent.highest + extent.lowest);
  const bool is_signed = options.heat_map == HeatMap::kTwist;
  const double heat_range = options.heat_limit > 0.0 ? options.heat_limit : 1.0;
  shared::FrameUniforms uniforms{};
  uniforms.clip_from_world = glm::mat4(projection_matrix(camera, aspect) * view_matrix(camera));
  uniforms.shadow_from_world = glm::mat4(shadow_from_world(extent));
  uniforms.eye = glm::vec4(glm::vec3(camera.pose.position), 1.0F);
  uniforms.to_key_light = glm::vec4(glm::vec3(kToKeyLight), 0.0F);
  uniforms.key_light =
      glm::vec4(kKeyLight, static_cast<float>(kShadowStep * 2.0 * extent.radius / shadow_size));
  static const std::array<glm::dvec3, 9> kIrradiance = studio_irradiance();
  for (std::size_t i = 0; i < kIrradiance.size(); ++i) {
    uniforms.irradiance[i] = glm::vec4(glm::vec3(kIrradiance[i]), i == 0 ? kEyeLight : 0.0F);
  }
  uniforms.background = glm::vec4(kBackground, 1.0F);
  uniforms.floor_box = glm::vec4(glm::dvec4(middle.x, middle.z, 0.5 * size.x, 0.5 * size.z));
  uniforms.floor_level = glm::vec4(
      glm::dvec4(extent.lowest.y, std::max(size.y, 1e-6), 2.5 * extent.radius, kClearToolShade));
  uniforms.heat_scale = glm::vec4(glm::dvec4(is_signed ? -heat_range : 0.0,
                                             is_signed ? 0.5 / heat_range : 1.0 / heat_range,
                                             is_signed ? 0.25 : 0.75, is_signed ? 1.0 : 0.0));
  return uniforms;
}

void set_pose(const Pose& pose, shared::DrawConstants& constants) {
  const glm::dmat3 rotation = glm::mat3_cast(pose.rotation);
  for (int row = 0; row < 3; ++row) {
    constants.to_world[row] = glm::vec4(
        glm::dvec4(rotation[0][row], rotation[1][row], rotation[2][row], pose.position[row]));
  }
}

void contact_spots(const Snapshot& snapshot, std::uint32_t bodies,
                   std::vector<shared::ContactSpot>& spots, std::vector<Range>& ranges) {
  const std::span<const RegionIdentity> identities = snapshot.regions.column<RegionIdentity>();
  spots.clear();
  ranges.clear();
  for (std::uint32_t body = 0; body < bodies; ++body) {
    const auto first = static_cast<std::uint32_t>(spots.size());
    for (std::uint32_t region = 0; region < identities.size(); ++region) {
      const double radius = snapshot.regions.at<Contact>(region).radius;
      const bool drawn = identities[region].body == body && radius > 0.0;
      if (drawn && spots.size() - first < kMaxRegionsPerBody) {
        const glm::dvec3& origin = snapshot.regions.at<RegionFrame>(region).origin;
        spots.push_back({glm::vec4(glm::vec3(origin), static_cast<float>(radius))});
      }
    }
    ranges.push_back({first, static_cast<std::uint32_t>(spots.size()) - first});
  }
}

}  // namespace torsion::engine
