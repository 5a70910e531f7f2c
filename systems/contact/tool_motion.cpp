#include "systems/contact/tool_motion.hpp"

#include <algorithm>
#include <cmath>

#include "systems/contact/region_wrenches.hpp"
#include "systems/math/finite.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

// Faster than any held tool: a hammer blow is about 10 m/s, a flick of the wrist about 40 rad/s.
constexpr double kLargestSpeed = 20.0;          // m/s
constexpr double kLargestAngularSpeed = 500.0;  // rad/s
// The axis is averaged over about this angle, so that noise on a nearly still tool does not turn
// it.
constexpr double kAxisMemory = 0.02;  // rad

/// Adds the turn to the axis vector and fades the older turns by the angle, not by time: so the
/// axis depends on the path alone.
void remember_axis(ToolMotion& motion, const glm::dvec3& turn) {
  const double angle = glm::length(turn);
  if (angle == 0.0) {
    return;
  }
  const double kept = std::exp(-angle / kAxisMemory);
  // Opposite turns have the same axis: a line has no sign.
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
    motion.velocity = shift / context.model.dt;
    motion.angular_velocity = turn / context.model.dt;
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

namespace {

constexpr double kBlendBand = 0.1;  // of the disc's radius: where "through" becomes "past"
constexpr double kGrazing =
    1e-3;  // |cos| of axis and normal below which the axis lies in the tangent plane

/// Distance from `point` to the fixed point, projected on the axis; to the fixed face along the
/// axis where a face is fixed. At least `least`.
double lever_to_fixed(const FixedRegion& fixed, const glm::dvec3& point, const glm::dvec3& axis,
                      double least) {
  const glm::dvec3 away = point - fixed.point;
  if (fixed.kind == FixedKind::kFace) {
    const double slope = std::max(std::abs(glm::dot(axis, fixed.normal)), 0.1);
    return std::max(std::abs(glm::dot(away, fixed.normal)) / slope, least);
  }
  return std::max(std::abs(glm::dot(away, axis)), least);
}

/// The tool's rotation axis seen from the body's axes.
struct AxisInBody {
  glm::dvec3 center;  // m: mass centre, which it goes through
  glm::dvec3 along;   // unit or zero
};

AxisInBody axis_in_body(const Model& model, const State& state, const RegionIdentity& region) {
  const Pose& body = model.bodies.at<Pose>(region.body);
  const ToolMotion& motion = state.tools.at<ToolMotion>(region.tool);
  return {to_inner(body, motion.mass_center), glm::conjugate(body.rotation) * motion.axis};
}

/// Where the axis meets the plane through p_eq, and to which share it counts as passing through the
/// region.
void aim_axis(const AxisInBody& axis, const RegionFrame& frame, const Overlap& overlap,
              RegionMotion& motion) {
  const glm::dvec3 center = body_to_grid(frame, overlap.center);
  motion.pivot = glm::dvec2(center);
  motion.axis_share = 0.0;
  const double slope = glm::dot(axis.along, frame.normal);
  if (std::abs(slope) < kGrazing || overlap.radius <= 0.0) {
    return;
  }
  const double along = glm::dot(overlap.center - axis.center, frame.normal) / slope;
  const glm::dvec2 meets(body_to_grid(frame, axis.center + axis.along * along));
  const double miss = glm::length(meets - motion.pivot);
  motion.axis_share = smooth_step((overlap.radius - miss) / (kBlendBand * overlap.radius));
  motion.pivot += motion.axis_share * (meets - motion.pivot);
}

}  // namespace

MotionOverBody motion_over_body(const Model& model, const State& state, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const Pose& body = model.bodies.at<Pose>(identity.body);
  const ToolMotion& tool = state.tools.at<ToolMotion>(identity.tool);
  const RegionSupport& support = state.regions.at<RegionSupport>(region);
  const double dt = model.dt;
  const glm::dquat to_body = glm::conjugate(body.rotation);
  const glm::dvec3 shift = to_body * tool.velocity * dt;
  return {shift,
          to_body * tool.angular_velocity * dt,
          to_inner(body, tool.mass_center) - 0.5 * shift,
          support.translation_step,
          support.rotation_step,
          support.about};
}

void region_motion(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    const RegionFrame& frame = state.regions.at<RegionFrame>(region);
    const Overlap& overlap = state.regions.at<Overlap>(region);
    RegionMotion& motion = state.regions.at<RegionMotion>(region);
    const AxisInBody axis = axis_in_body(model, state, identity);
    motion.axis = axis.along;
    aim_axis(axis, frame, overlap, motion);
    const glm::dvec3 height(0.0, 0.0, body_to_grid(frame, overlap.center).z);
    const glm::dvec3 pivot = grid_to_body(frame, glm::dvec3(motion.pivot, 0.0) + height);
    const MotionOverBody over = motion_over_body(model, state, region);
    motion.slide = glm::dvec2(body_to_grid_direction(frame, shift_after(over, pivot)));
    motion.spin = glm::dot(turn_of(over), frame.normal);
    motion.turn += motion.spin;
    motion.largest_turn = std::max(motion.largest_turn, std::abs(motion.turn));
    motion.rotation += turn_of(over);
    motion.largest_rotation = std::max(motion.largest_rotation, glm::length(motion.rotation));
    const bool has_axis = glm::dot(axis.along, axis.along) > 0.0;
    motion.lever = lever_to_fixed(model.bodies.at<FixedRegion>(identity.body), overlap.center,
                                  has_axis ? axis.along : frame.normal, overlap.radius);
  }
}

}  // namespace torsion::engine
