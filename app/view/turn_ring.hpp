#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/view/orbit_camera.hpp"
#include "ecs/components.hpp"

namespace torsion::engine {

/// A ring around a tool that the mouse takes hold of to turn it.
struct TurnRing {
  glm::dvec3 center{0.0};             // m, world: on the axis
  glm::dvec3 axis{0.0, 1.0, 0.0};     // world, unit: what the tool is turned about
  glm::dvec3 tangent{1.0, 0.0, 0.0};  // world, unit, across the axis: where angles begin
  double radius = 0.0;                // m

  /// @param angle  rad, counter-clockwise seen against the axis
  [[nodiscard]] glm::dvec3 at(double angle) const;
};

/// A ring outside of most of a tool: as wide as its middle side and 0.6 of it more, past the arc of
/// its torque, at its middle's height on the axis.
/// @param pose, bounds  of the tool: its frame in the world, and itself in that frame
/// @param pivot, axis, tangent  m and unit, world
TurnRing ring_around(const Pose& pose, const Bounds& bounds, const glm::dvec3& pivot,
                     const glm::dvec3& axis, const glm::dvec3& tangent);

/// Where the mouse is on a ring, rad; nothing where it is further away than `reach` pixels. Of two
/// places that it may mean, the one nearer to the eye.
std::optional<double> angle_on(const TurnRing& ring, const Camera& camera, const glm::dvec2& mouse,
                               const glm::dvec2& picture, double reach);

/// How far the ring is turned by a motion of the mouse, rad: so that the place taken stays under
/// the mouse; by what the motion is along it where the ring is seen from its edge.
/// @param angle  rad: of the place taken
double turned_by(const TurnRing& ring, double angle, const Camera& camera, const glm::dvec2& from,
                 const glm::dvec2& to, const glm::dvec2& picture);

}  // namespace torsion::engine
