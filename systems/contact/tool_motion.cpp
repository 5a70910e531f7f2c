#include "systems/contact/tool_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
void remember_axis(glm::dvec3& axis, double& axis_turn, const glm::dvec3& turn) {
  const double angle = glm::length(turn);
  if (angle == 0.0) {
    return;
  }
  const double kept = std::exp(-angle / kAxisMemory);
  // Opposite turns have the same axis: a line has no sign.
  const double sign = glm::dot(axis, turn) < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 sum =
      axis * (axis_turn * kept) + turn * (sign * kAxisMemory * (1.0 - kept) / angle);
  axis_turn = glm::length(sum);
  axis = axis_turn > 0.0 ? sum / axis_turn : axis;
}

bool too_fast(const glm::dvec3& shift, const glm::dvec3& turn, double dt) {
  return glm::length(shift / dt) > kLargestSpeed || glm::length(turn / dt) > kLargestAngularSpeed;
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
    } else if (too_fast(shift, turn, context.model.dt)) {
      raise(clock, Fault::kPoseJumped);
      motion.velocity = glm::dvec3(0.0);
      motion.angular_velocity = glm::dvec3(0.0);
    } else {
      remember_axis(motion.axis, motion.axis_turn, turn);
    }
  }
}

namespace {

/// Over a body that rests.
void over_resting(const Pose& body, const ToolMotion& tool, double dt, ToolOverBody& over) {
  const glm::dquat to_body = glm::conjugate(body.rotation);
  over.shift = to_body * tool.velocity * dt;
  over.turn = to_body * tool.angular_velocity * dt;
  over.center = to_inner(body, tool.mass_center);
  over.axis = to_body * tool.axis;
  over.axis_turn = tool.axis_turn;
}

/// What is left of a motion that tool and body make together is rounding, and no slip: some models
/// ask for its direction.
void drop_rounding(const BodyPose& body, ToolOverBody& over) {
  constexpr double kMotionRounding = 64.0 * std::numeric_limits<double>::epsilon();
  const double size = glm::length(body.now.position) + glm::length(over.center);
  if (glm::length(over.shift) <= kMotionRounding * size) {
    over.shift = glm::dvec3(0.0);
  }
  if (glm::length(over.turn) <= kMotionRounding) {
    over.turn = glm::dvec3(0.0);
  }
}

/// Over a body that moves: both motions as one, of the tool in the body's axes.
void over_moving(const BodyPose& body, const ToolPose& tool, const glm::dvec3& tool_center,
                 Clock& clock, double dt, ToolOverBody& over) {
  const Pose before = relative(body.before, tool.before);
  const Pose now = relative(body.now, tool.now);
  over.center = to_outer(now, tool_center);
  over.shift = over.center - to_outer(before, tool_center);
  over.turn = turn_between(before.rotation, now.rotation);
  drop_rounding(body, over);
  const bool jumped = too_fast(over.shift, over.turn, dt);
  if (jumped && clock.step > 0) {
    raise(clock, Fault::kPoseJumped);
  }
  if (jumped || clock.step == 0) {
    over.shift = glm::dvec3(0.0);
    over.turn = glm::dvec3(0.0);
  } else {
    remember_axis(over.axis, over.axis_turn, over.turn);
  }
}

Pose body_pose_at(const Model& model, std::uint32_t body, double time) {
  return model.moves(body) ? scripted_pose(model.body_scripts[body], time)
                           : model.bodies.at<Pose>(body);
}

}  // namespace

void place_bodies(const Model& model, State& state) {
  for (std::uint32_t body = 0; body < model.bodies.size(); ++body) {
    const Pose pose = body_pose_at(model, body, 0.0);
    state.bodies.at<BodyPose>(body) = {pose, pose};
  }
}

void move_bodies(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  const double time = static_cast<double>(state.clock.step) * model.dt;
  for (std::uint32_t body = 0; body < model.bodies.size(); ++body) {
    BodyPose& pose = state.bodies.at<BodyPose>(body);
    const bool moves = model.moves(body);
    const Pose now = body_pose_at(model, body, time);
    pose.before = state.clock.step == 0 ? now : pose.now;
    pose.now = now;
    for (std::uint32_t tool = 0; tool < model.tools.size(); ++tool) {
      ToolOverBody& over = state.over(tool, body);
      if (moves) {
        over_moving(pose, state.tools.at<ToolPose>(tool),
                    model.tools.at<MassProperties>(tool).center, state.clock, model.dt, over);
      } else {
        over_resting(now, state.tools.at<ToolMotion>(tool), model.dt, over);
      }
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

/// Where the axis meets the plane through p_eq, and to which share it counts as passing through the
/// region.
void aim_axis(const ToolOverBody& tool, const RegionFrame& frame, const Overlap& overlap,
              RegionMotion& motion) {
  const glm::dvec3 center = body_to_grid(frame, overlap.center);
  motion.pivot = glm::dvec2(center);
  motion.axis_share = 0.0;
  const double slope = glm::dot(tool.axis, frame.normal);
  if (std::abs(slope) < kGrazing || overlap.radius <= 0.0) {
    return;
  }
  const double along = glm::dot(overlap.center - tool.center, frame.normal) / slope;
  const glm::dvec2 meets(body_to_grid(frame, tool.center + tool.axis * along));
  const double miss = glm::length(meets - motion.pivot);
  motion.axis_share = smooth_step((overlap.radius - miss) / (kBlendBand * overlap.radius));
  motion.pivot += motion.axis_share * (meets - motion.pivot);
}

}  // namespace

MotionOverBody motion_over_body(const State& state, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const ToolOverBody& tool = state.over(identity.tool, identity.body);
  const RegionSupport& support = state.regions.at<RegionSupport>(region);
  return {tool.shift,
          tool.turn,
          tool.center - 0.5 * tool.shift,
          support.translation_step,
          support.rotation_step,
          support.about};
}

double way_into_body(const State& state, std::uint32_t region) {
  const glm::dvec3 shift =
      shift_at(motion_over_body(state, region), state.regions.at<Contact>(region).equivalent_point);
  return -glm::dot(shift, state.regions.at<RegionFrame>(region).normal);
}

void region_motion(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    const RegionFrame& frame = state.regions.at<RegionFrame>(region);
    const Overlap& overlap = state.regions.at<Overlap>(region);
    RegionMotion& motion = state.regions.at<RegionMotion>(region);
    const ToolOverBody& tool = state.over(identity.tool, identity.body);
    motion.axis = tool.axis;
    aim_axis(tool, frame, overlap, motion);
    const glm::dvec3 height(0.0, 0.0, body_to_grid(frame, overlap.center).z);
    const glm::dvec3 pivot = grid_to_body(frame, glm::dvec3(motion.pivot, 0.0) + height);
    const MotionOverBody over = motion_over_body(state, region);
    motion.slide = glm::dvec2(body_to_grid_direction(frame, shift_after(over, pivot)));
    motion.spin = glm::dot(turn_of(over), frame.normal);
    motion.turn += motion.spin;
    motion.largest_turn = std::max(motion.largest_turn, std::abs(motion.turn));
    motion.rotation += turn_of(over);
    motion.largest_rotation = std::max(motion.largest_rotation, glm::length(motion.rotation));
    const bool has_axis = glm::dot(tool.axis, tool.axis) > 0.0;
    motion.lever = lever_to_fixed(model.bodies.at<FixedRegion>(identity.body), overlap.center,
                                  has_axis ? tool.axis : frame.normal, overlap.radius);
  }
}

}  // namespace torsion::engine
