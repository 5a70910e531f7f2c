#pragma once

// A body with regions put on it by hand, drawn: what tests of the frame's columns need.

#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "systems/surface/surface_field.hpp"
#include "systems/surface/take_snapshot.hpp"
#include "tests/support/directions.hpp"
#include "tests/systems/body_scene.hpp"

namespace torsion::engine {

/// One body with its frame world; regions are put on it by hand.
struct Drawn {
  explicit Drawn(BodyDescription body) {
    scene.bodies.push_back(std::move(body));
    world = body_world(scene.bodies.front());
    ToolDescription tool;
    scene.tools.push_back(tool);
    frame = prepare_frame(scene, world.model, world.state);
    snapshot.reserve(world.model, world.state);
  }

  /// Draws what the world holds now.
  void draw() {
    capture(world.model, world.state, snapshot);
    skeleton_motions(world.model, world.state, snapshot);
    surface_field(world.model, snapshot, frame);
    positions.resize(frame.body_vertices.size());
    deform_vertices(frame, 0, positions);
  }

  [[nodiscard]] glm::dvec3 rest(std::uint32_t vertex) const {
    return glm::dvec3(frame.body_vertices.at<VertexRest>(vertex).position);
  }
  [[nodiscard]] double twist(std::uint32_t slot, std::uint32_t vertex) const {
    return static_cast<double>(
        frame.twist.at<TwistAngle>(slot * frame.body_vertices.size() + vertex).angle);
  }
  [[nodiscard]] glm::dvec3 moved(std::uint32_t vertex) const {
    return glm::dvec3(positions[vertex]);
  }
  [[nodiscard]] std::uint32_t vertices() const { return frame.body_vertices.size(); }

  SceneDescription scene;
  World world;
  FrameWorld frame;
  Snapshot snapshot;
  std::vector<glm::vec4> positions;
};

using test::kUp;

inline Drawn cube() {
  return Drawn(exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kFace, 20));
}

/// A region in the middle of the top face through which the tool's axis goes, as the contact model
/// leaves it.
inline std::uint32_t twisting_region(World& world, double stick_turn, double stick_radius,
                                     double radius) {
  const std::uint32_t region = add_region(world, {.point = {0.0, 0.05, 0.0}, .radius = radius});
  world.state.regions.at<RegionMotion>(region) = RegionMotion{};
  world.state.regions.at<RegionMotion>(region).axis = kUp;
  world.state.regions.at<RegionMotion>(region).axis_share = 1.0;
  world.state.regions.at<RegionMotion>(region).largest_turn = std::abs(stick_turn);
  world.state.regions.at<RegionMotion>(region).largest_rotation = 1.0;
  world.state.regions.at<RegionFriction>(region).stick_turn = stick_turn;
  world.state.regions.at<RegionFriction>(region).stick_radius = stick_radius;
  return region;
}

/// Puts the tool, a sphere of radius 0.05 m, so that it overlaps the top of a body of that height
/// by `depth`, and a region that the overlap would give.
inline void press_sphere(World& world, double top, double depth, const glm::dvec2& place) {
  const double radius = std::sqrt(2.0 * 0.05 * depth - depth * depth);
  add_region(world, {.point = {place.x, top, place.y},
                     .force_on_body = {0.0, -1.0, 0.0},
                     .radius = radius,
                     .depth = depth});
  world.state.tools.at<ToolPose>(0).now.position = glm::dvec3(place.x, top + 0.05 - depth, place.y);
}

}  // namespace torsion::engine
