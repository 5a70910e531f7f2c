#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "ecs/model.hpp"

namespace torsion::engine {

/// Where a scene's contacts with a body are expected: a ball.
struct ExpectedPlace {
  bool known = false;      // false: anywhere
  glm::dvec3 center{0.0};  // m, body
  double radius = 0.0;     // m
};

// How far the contacts of an expected motion roll.

/// A sample of a tool inside a body.
struct TouchingPoint {
  glm::dvec3 on_body{0.0};          // m, body
  glm::dvec3 on_tool{0.0};          // m, tool
  double depth = 0.0;               // m
  const ShapePart* part = nullptr;  // of the tool
};

/// Where a tool touches a body, and where it began to.
struct TouchedPlace {
  std::uint32_t tool = 0;
  glm::dvec3 on_body{0.0};  // m, body: of its surface
  glm::dvec3 on_tool{0.0};  // m, tool: likewise
  glm::dvec3 began_on_body{0.0};
  glm::dvec3 began_on_tool{0.0};
};

/// The places of one tool, one for each group of its points. A place is where the tool's part lies
/// deepest, found from its shape, for samples are too coarse to tell a small way; along a straight
/// generator, and of a mesh, it is the mean of the points. A place goes on where it
/// and one of the pose before are nearest to each other; else it begins.
/// @param pose    of the tool
/// @param before  places of the pose before, of all tools
std::vector<TouchedPlace> touched_places(const Model& model, std::uint32_t body, std::uint32_t tool,
                                         const Pose& pose, std::span<const TouchingPoint> points,
                                         std::span<const TouchedPlace> before);

/// How far a place has rolled since it began, m: what it has gone over both surfaces alike. A
/// contact that slides stays where it is on one of them, and what slips is the difference of both
/// ways. Johnson, Contact Mechanics, 1985, 1.4.
/// @param tool_to_body  the tool's rotation in the body's frame
double rolled_way(const TouchedPlace& place, const glm::dquat& tool_to_body);

}  // namespace torsion::engine
