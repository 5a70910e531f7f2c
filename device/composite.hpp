#pragma once

// Several devices on one tool: translation from one, turning from another, or two and three that
// carry the tool at points of it.

#include <array>
#include <cstdint>
#include <span>

#include "ecs/device_sample.hpp"

namespace torsion::engine {

inline constexpr std::size_t kMostPoints = 3;

/// The tool carried at points: where they are on it, m, from its origin, in its axes; the devices
/// stand apart as the points do.
struct CarriedTool {
  std::array<glm::dvec3, kMostPoints> points;
  std::size_t count = 0;  // 2 or 3
};

/// Two or three points `spacing` [m] apart round the tool's origin, in its x-z plane.
CarriedTool carried_at(std::size_t count, double spacing);

/// Pose of the tool from where its points are. Two do not tell its turn about the line between
/// them, which stays as it is at rest.
/// @param places  m, (count): of the devices' handles, each from its own rest
Pose carried_pose(const CarriedTool& tool, std::span<const glm::dvec3> places);

/// Forces at the points that come to `wrench` about the tool's origin, the smallest that do: least
/// sum of squares. Two points cannot carry a torque about the line between them; it is left out.
/// @param places  m, (count): as in carried_pose
/// @param forces  N, (count): out
void carried_forces(const CarriedTool& tool, std::span<const glm::dvec3> places,
                    const Wrench& wrench, std::span<glm::dvec3> forces);

}  // namespace torsion::engine
