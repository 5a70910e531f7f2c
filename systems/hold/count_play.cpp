#include "systems/hold/count_play.hpp"

#include <algorithm>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

constexpr double kFarthest = 2.0;   // counts: what is farther is followed at once
constexpr double kPlay = 1.0;       // counts: what is nearer is not
constexpr double kSlowTime = 0.25;  // s: of the way between, twice that of a loose hand

/// The part of a change beyond `free`, for each axis.
glm::dvec3 beyond(const glm::dvec3& change, double free) {
  return change - glm::clamp(change, -free, free);
}

/// The part of a change that is followed within `period`.
glm::dvec3 followed(const glm::dvec3& change, double count, double period) {
  const glm::dvec3 at_once = beyond(change, kFarthest * count);
  const double share = std::min(1.0, period / kSlowTime);
  return at_once + share * beyond(change - at_once, kPlay * count);
}

bool is_coarse(double count, double stiffness, double largest) {
  constexpr double kSmall = 0.005;
  return stiffness * count > kSmall * largest;
}

/// N/m or N m/rad: of which play feeds no swing of a hand.
double softer_than(double damping, double mass) {
  return std::numbers::pi * std::numbers::pi * damping * damping / mass;
}

}  // namespace

Pose follow_counts(const Pose& last, const Pose& measured, double count, double turn_count,
                   double period) {
  Pose pose = measured;
  if (count > 0.0) {
    pose.position = last.position + followed(measured.position - last.position, count, period);
  }
  if (turn_count > 0.0) {
    const glm::dvec3 turn =
        followed(turn_between(last.rotation, measured.rotation), turn_count, period);
    const double angle = glm::length(turn);
    pose.rotation = angle > 0.0
                        ? glm::normalize(glm::angleAxis(angle, turn / angle) * last.rotation)
                        : last.rotation;
  }
  return pose;
}

bool needs_play(double count, double stiffness, double largest) {
  return is_coarse(count, stiffness, largest) && stiffness < softer_than(2.0, 0.1);
}

bool needs_turn_play(double count, double stiffness, double largest) {
  return is_coarse(count, stiffness, largest) && stiffness < softer_than(3e-3, 2.5e-4);
}

}  // namespace torsion::engine
