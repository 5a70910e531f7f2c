#pragma once

// All that the drawn vertices of one body need to know of one snapshot.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "ecs/frame_world.hpp"
#include "ecs/snapshot.hpp"
#include "systems/surface/anchor_interpolation.hpp"
#include "systems/surface/twist_and_dent.hpp"

namespace torsion::engine {

/// How the whole body turns about a region's axis, beyond the half-space under it, and what becomes
/// of the axis meanwhile (docs/models.md, "Large turns").
struct BodyTurn {
  static constexpr std::size_t kMiddles = 33;

  double share = 0.0;          // of the angles that the body model says; 0: nothing is turned
  glm::dvec3 point{0.0};       // m, body: on the axis
  glm::dvec3 direction{0.0};   // body, unit
  ScalarWeights angle;         // rad
  double under_contact = 0.0;  // rad: at `point`, where the step says it
  double growth = 0.0;         // rad/m^2: times the distance from there squared, what it is more
  double left = 0.0;           // likewise what the interpolated displacements go round besides
  double left_growth = 0.0;
  double radius = 0.0;   // m: of the contact
  double lowest = 0.0;   // m: along the axis from `point` to the first of `middle`
  double spacing = 1.0;  // m
  double weight = 0.0;   // of this axis among the body's; they add to 1
  std::array<glm::dvec3, kMiddles> middle{};  // m, body: displacement of points on the axis
};

/// A region of the body at work, in its slot.
struct Slot {
  RegionTwist twist;
  RegionDent dent;
  BodyTurn turn;
  std::uint32_t region = 0;  // row in the snapshot
  std::uint32_t tool = 0;
  double depth = 0.0;  // m
};

/// A tool that touches the body.
struct Toucher {
  std::uint32_t tool = 0;
  Range parts;
  Bounds bounds;
  Pose in_body;  // tool frame in the body's
};

struct BodyField {
  const Model& model;
  std::uint32_t body = 0;
  FixedRegion fixed;
  std::span<const FixedVolume> volumes;
  double held_band = 0.0;  // m
  InterpolationWeights weights;
  bool has_weights = false;
  bool turns = false;  // some slot's `turn` has a share
  std::vector<Slot> slots;
  std::vector<Toucher> touchers;
};

BodyField body_field(const Model& model, const Snapshot& snapshot, const FrameWorld& frame,
                     std::uint32_t body);

/// How freely a point moves: 0 on the fixed region, 1 a little away from it.
double freedom(const BodyField& field, const glm::dvec3& point);

/// How a turn's contact has a point.
struct ContactShare {
  double share = 0.0;  // 1 within the contact, 0 from two radii on
  double angle = 0.0;  // rad: by which the body turns it
  double left = 0.0;   // rad: that the interpolated displacements go round, which is in it
};
ContactShare share_of_contact(const BodyTurn& turn, const glm::dvec3& point);

/// Whether it has any of it. From two radii on anchors alone have a point, which is most of them.
inline bool is_under_contact(const BodyTurn& turn, const glm::dvec3& point) {
  const glm::dvec3 away = point - turn.point;
  return glm::dot(away, away) < 4.0 * turn.radius * turn.radius;
}

/// Displacement of the axes about which the body turns, at the height of a point [m, body].
glm::dvec3 middle_at(const BodyField& field, const glm::dvec3& point);

}  // namespace torsion::engine
