#pragma once

#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/snapshot.hpp"

namespace torsion {

/// Triangles in the world, three rows each, counter-clockwise seen from outside.
struct ArrowMesh {
  std::vector<glm::vec4> positions;  // m, world
  std::vector<glm::vec4> normals;    // world, unit
  std::vector<glm::vec4> colors;     // linear rgb

  void clear();
};

/// How long arrows are.
struct ArrowScale {
  double length = 0.1;       // m: of the arrow of full force
  double full_force = 1.0;   // N
  double full_torque = 1.0;  // N m: its arc goes 300 degrees around
};

/// A straight arrow from `tail` along `vector` (length included, m). Nothing below a thousandth of
/// `size` [m], which sets the thickness.
void append_arrow(const glm::dvec3& tail, const glm::dvec3& vector, double size,
                  const glm::vec3& color, ArrowMesh& mesh);

/// An arc with a tip about `axis` (unit), right-handed, over `angle` [rad], of `radius` [m] about
/// `center`.
void append_arc(const glm::dvec3& center, const glm::dvec3& axis, double radius, double angle,
                double size, const glm::vec3& color, ArrowMesh& mesh);

/// Force and torque that the bodies exert on each tool: an arrow from the mass centre, and an arc
/// about the torque's axis. Appends to `mesh`.
void append_wrenches(const Snapshot& snapshot, const ArrowScale& scale, ArrowMesh& mesh);

}  // namespace torsion
