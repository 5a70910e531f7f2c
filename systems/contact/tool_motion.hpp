#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "systems/contact/step_context.hpp"

namespace torsion::engine {

/// Takes the input poses as the tools' new poses (a scripted pose is imposed as it is) and derives
/// their motion over the step: velocity of the mass centre, angular velocity, and the rotation
/// axis. A pose that is not finite is refused and one that moved further than a hand can is taken
/// without motion; both set a fault.
void couple_tools(StepContext& context);

/// Moves the bodies to where their scripts have them at the step's time (they stay at rest without
/// one), and finds how each tool moves over each body, seen from the body. Together faster than a
/// hand moves a tool: taken without motion, with a fault.
void move_bodies(StepContext& context);

/// Puts the bodies where they are at time 0.
void place_bodies(const Model& model, State& state);

/// How the tool moves over the material under a region in a step, as a rigid body, body axes.
struct MotionOverBody {
  glm::dvec3 shift{0.0};         // m, of the tool's mass centre
  glm::dvec3 turn{0.0};          // rad, rotation vector
  glm::dvec3 halfway{0.0};       // m: where the mass centre is in the middle of the step
  glm::dvec3 carried_by{0.0};    // m, of the material at `carried_about`
  glm::dvec3 carried_turn{0.0};  // rad
  glm::dvec3 carried_about{0.0};
};

MotionOverBody motion_over_body(const State& state, std::uint32_t region);

/// Displacement of the tool over the material that is at `point`, m, body axes. Its turn is about
/// where the mass centre is halfway through the step: then it does not matter whether it turns or
/// slides first, and the mean of two wrenches does the work of the tractions' means.
inline glm::dvec3 shift_at(const MotionOverBody& motion, const glm::dvec3& point) {
  return motion.shift + glm::cross(motion.turn, point - motion.halfway) - motion.carried_by -
         glm::cross(motion.carried_turn, point - motion.carried_about);
}

/// How far the tool moves into the body at a region's middle in this step, m; negative: out of it.
double way_into_body(const State& state, std::uint32_t region);

/// How the tool turns over the material under the region, rad.
inline glm::dvec3 turn_of(const MotionOverBody& motion) {
  return motion.turn - motion.carried_turn;
}

/// Displacement of the tool's point that is at `point` before the step, and of the one that is
/// there after it.
inline glm::dvec3 shift_before(const MotionOverBody& motion, const glm::dvec3& point) {
  return shift_at(motion, point) + 0.5 * glm::cross(motion.turn, motion.shift);
}
inline glm::dvec3 shift_after(const MotionOverBody& motion, const glm::dvec3& point) {
  return shift_at(motion, point) - 0.5 * glm::cross(motion.turn, motion.shift);
}

/// How the tool moves over the body at each region in this step, and where its rotation axis goes
/// (section III of the paper): slide and spin in the tangent plane, the turn phi summed from the
/// spin since the region formed (integral of omega . n dt, not read off a quaternion), whether the
/// axis goes through the region's disc of radius a, and the lever l to what is fixed. The change
/// between "through" and "past" is spread over the outermost tenth of the disc, so that the torque
/// is continuous.
void region_motion(StepContext& context);

}  // namespace torsion::engine
