#pragma once

#include <span>
#include <vector>

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

/// How long arrows are.
struct ArrowScale {
  double length = 0.1;                  // m: of the arrow of full force
  double full_force = 1.0;              // N
  double full_torque = 1.0;             // N m: its arc goes 300 degrees around
  glm::dvec3 eye{0.0};                  // m, world: arcs begin and end on this side
  std::span<const double> arc_radii{};  // m, one for each tool
};

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
/// about the torque's axis. The gap of a full arc faces the eye, so that it hides as little of the
/// contact as it can. Appends to `mesh`.
void append_wrenches(const Snapshot& snapshot, const ArrowScale& scale, ArrowMesh& mesh);

}  // namespace torsion::engine
