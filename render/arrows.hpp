#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/snapshot.hpp"

namespace torsion::engine {

/// Triangles in the world, three rows each, counter-clockwise seen from outside.
struct ArrowMesh {
  std::vector<glm::vec4> positions;  // m, world
  std::vector<glm::vec4> normals;    // world, unit
  std::vector<glm::vec4> colors;     // linear rgb

  void clear();
};

/// Of the longest arrow: so much of the bodies' largest side.
inline constexpr double kFullArrow = 0.6;

/// How long arrows are.
struct ArrowScale {
  double length = 0.1;                  // m: of the arrow of full force
  double full_force = 1.0;              // N
  double full_torque = 1.0;             // N m: its arc goes 300 degrees around
  glm::dvec3 eye{0.0};                  // m, world: arcs begin and end on this side
  std::span<const double> arc_radii{};  // m, one for each tool
  bool parts = false;                   // the torque of arms and the couples of the regions apart
  double full_couple = 1.0;             // N m: of a region's arc, for parts
  std::span<const Pose> bodies{};       // in the world, one for each body; for parts
};

/// What the longest arrows have to stand for.
struct ArrowLimits {
  double force = 0.0;   // N
  double torque = 0.0;  // N m: on a tool
  double couple = 0.0;  // N m: of a region

  bool operator==(const ArrowLimits&) const = default;
};

/// Of a force times the radius of its contact: no scale of torques ends below, for less is noise.
inline constexpr double kLeastTorqueShare = 0.01;

/// Widens the limits by what a step has. Torques get no smaller a scale than kLeastTorqueShare of
/// what the largest force does at the rim of the widest contact.
/// @param tools    of a Snapshot or State
/// @param regions  likewise
template <class Tools, class Regions>
void widen(ArrowLimits& limits, const Tools& tools, const Regions& regions) {
  double force = 0.0;
  double radius = 0.0;
  for (const ToolWrench& wrench : tools.template column<ToolWrench>()) {
    force = std::max(force, glm::length(wrench.total.force));
    limits.torque = std::max(limits.torque, glm::length(wrench.total.torque));
  }
  for (const Contact& contact : regions.template column<Contact>()) {
    radius = std::max(radius, contact.radius);
  }
  for (const RegionFriction& friction : regions.template column<RegionFriction>()) {
    limits.couple = std::max(limits.couple, std::abs(friction.couple));
  }
  limits.force = std::max(limits.force, force);
  limits.torque = std::max(limits.torque, kLeastTorqueShare * force * radius);
  limits.couple = std::max(limits.couple, kLeastTorqueShare * force * radius);
}

/// A straight arrow from `tail` along `vector` (length included, m). Nothing below a thousandth of
/// `size` [m], which sets the thickness.
void append_arrow(const glm::dvec3& tail, const glm::dvec3& vector, double size,
                  const glm::vec3& color, ArrowMesh& mesh);

/// A circle to draw an arc on. `axis` and `start` are unit vectors across each other.
struct Circle {
  glm::dvec3 center;  // m, world
  glm::dvec3 axis;
  glm::dvec3 start;  // from the centre to where the arc begins
  double radius;     // m
};

/// An arc with a tip, right-handed about the circle's axis, over `angle` [rad].
void append_arc(const Circle& circle, double angle, double size, const glm::vec3& color,
                ArrowMesh& mesh);

/// Force and torque that the bodies exert on each tool: an arrow from the mass centre, and an arc
/// about the torque's axis. In parts: an arc for what the forces make with their arms about the
/// mass centre, and around each contact one for its couple. The gap of a full arc faces the eye, so
/// that it hides as little of the contact as it can. Appends to `mesh`.
void append_wrenches(const Snapshot& snapshot, const ArrowScale& scale, ArrowMesh& mesh);

}  // namespace torsion::engine
