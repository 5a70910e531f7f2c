#include "systems/contact/region_motion.hpp"

#include <algorithm>
#include <cmath>

#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion {
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

/// Where the axis meets the plane through p_eq, and how much of it counts as going through the
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
  const double dt = state.clock.dt;
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

}  // namespace torsion
