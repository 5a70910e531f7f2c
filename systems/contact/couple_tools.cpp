#include "systems/contact/couple_tools.hpp"

#include <cmath>

#include "systems/contact/fault.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/rotation_vector.hpp"

namespace torsion {
namespace {

// Faster than any held tool: a hammer blow is about 10 m/s, a flick of the wrist about 40 rad/s.
constexpr double kLargestSpeed = 20.0;          // m/s
constexpr double kLargestAngularSpeed = 500.0;  // rad/s
// The axis remembers about this much turning, so that noise on a nearly still tool does not throw
// it about.
constexpr double kAxisMemory = 0.02;  // rad

bool finite(const Pose& pose) {
  const glm::dquat& q = pose.rotation;
  const double norm = glm::dot(q, q);
  return std::isfinite(pose.position.x + pose.position.y + pose.position.z) &&
         std::isfinite(norm) && norm > 0.25 && norm < 4.0;
}

/// Turning adds to the axis vector and fades what was there, by the angle turned, not by time: the
/// axis is a function of the path alone.
void remember_axis(ToolMotion& motion, const glm::dvec3& turn) {
  const double angle = glm::length(turn);
  if (angle == 0.0) {
    return;
  }
  const double kept = std::exp(-angle / kAxisMemory);
  // Opposite turns share one axis: the line has no sign.
  const double sign = glm::dot(motion.axis, turn) < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 sum =
      motion.axis * (motion.axis_turn * kept) + turn * (sign * kAxisMemory * (1.0 - kept) / angle);
  motion.axis_turn = glm::length(sum);
  motion.axis = motion.axis_turn > 0.0 ? sum / motion.axis_turn : motion.axis;
}

}  // namespace

void couple_tools(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  Clock& clock = state.clock;
  clock.faults = 0;
  const auto poses = state.tools.column<ToolPose>();
  const auto motions = state.tools.column<ToolMotion>();
  const auto masses = model.tools.column<MassProperties>();
  for (std::size_t tool = 0; tool < poses.size(); ++tool) {
    ToolPose& pose = poses[tool];
    ToolMotion& motion = motions[tool];
    const glm::dvec3 center_before = to_outer(pose.now, masses[tool].center);
    pose.before = pose.now;
    if (finite(context.tool_poses[tool])) {
      pose.now = context.tool_poses[tool];
      pose.now.rotation = glm::normalize(pose.now.rotation);
    } else {
      raise(clock, Fault::kPoseNotFinite);
    }
    motion.mass_center = to_outer(pose.now, masses[tool].center);
    const glm::dvec3 shift = motion.mass_center - center_before;
    const glm::dvec3 turn = turn_between(pose.before.rotation, pose.now.rotation);
    motion.velocity = shift / clock.dt;
    motion.angular_velocity = turn / clock.dt;
    if (clock.step == 0) {
      // The scene's first pose is where the tool starts, not a motion from where it was loaded.
      motion.velocity = glm::dvec3(0.0);
      motion.angular_velocity = glm::dvec3(0.0);
    } else if (glm::length(motion.velocity) > kLargestSpeed ||
               glm::length(motion.angular_velocity) > kLargestAngularSpeed) {
      raise(clock, Fault::kPoseJumped);
      motion.velocity = glm::dvec3(0.0);
      motion.angular_velocity = glm::dvec3(0.0);
    } else {
      remember_axis(motion, turn);
    }
  }
}

}  // namespace torsion
