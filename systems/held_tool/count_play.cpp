#include "systems/held_tool/count_play.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/rotation_vector.hpp"

namespace torsion {
namespace {

/// What of a change goes beyond a count, for each axis.
glm::dvec3 beyond(const glm::dvec3& change, double count) {
  return change - glm::clamp(change, -count, count);
}

}  // namespace

Pose within_a_count(const Pose& last, const Pose& measured, double count, double turn_count) {
  Pose pose = measured;
  if (count > 0.0) {
    pose.position = last.position + beyond(measured.position - last.position, count);
  }
  if (turn_count > 0.0) {
    const glm::dvec3 turn = beyond(turn_between(last.rotation, measured.rotation), turn_count);
    const double angle = glm::length(turn);
    pose.rotation = angle > 0.0
                        ? glm::normalize(glm::angleAxis(angle, turn / angle) * last.rotation)
                        : last.rotation;
  }
  return pose;
}

}  // namespace torsion
