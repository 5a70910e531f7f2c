#include "systems/contact/moved_surface.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "systems/contact/support/body_law.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

/// The farthest that the other tools' regions may have moved any of a body's surface, m: each as a
/// rigid body moves, seen from the body's other end.
double farthest_moved(const Model& model, const State& state, std::uint32_t tool,
                      std::uint32_t body) {
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const double across = glm::distance(bounds.lowest, bounds.highest);
  double farthest = 0.0;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    if (identity.body == body && identity.tool != tool &&
        state.regions.at<RegionNormal>(region).force > 0.0) {
      const RegionSupport& support = state.regions.at<RegionSupport>(region);
      farthest += glm::length(support.translation) + across * glm::length(support.rotation) +
                  state.regions.at<Overlap>(region).largest_depth;
    }
  }
  return farthest;
}

struct NearestSample {
  std::uint32_t sample = kNoRow;  // row of the tool's
  double distance = 0.0;          // m, to the body's rest shape
};

/// The tool's sample that is nearest to the body, if one is nearer than `reach`.
NearestSample nearest_sample(const Model& model, std::uint32_t tool, std::uint32_t body,
                             const Pose& tool_in_body, double reach) {
  const OwnedRows& owned = model.tools.at<OwnedRows>(tool);
  const Range parts = model.bodies.at<OwnedRows>(body).parts;
  const auto balls = model.balls.rows<SurfaceBall>(owned.balls);
  NearestSample nearest{kNoRow, reach};
  for (std::size_t row = 0; row < balls.size();) {
    const SurfaceBall& ball = balls[row];
    const double distance =
        signed_distance(model, parts, to_outer(tool_in_body, ball.center)).value;
    if (ball.sample == kNoRow) {
      row = distance - ball.radius < nearest.distance ? row + 1 : ball.skip;
      continue;
    }
    if (distance < nearest.distance) {
      nearest = {owned.samples.first + ball.sample, distance};
    }
    row = ball.skip;
  }
  return nearest;
}

}  // namespace

std::optional<Pose> seen_from_moved_surface(const StepContext& context, std::uint32_t tool,
                                            std::uint32_t body, const Pose& tool_in_body) {
  const Model& model = context.model;
  const BodyLaw& law = body_law_of(model, body);
  if (law.motion_at == nullptr) {
    return std::nullopt;
  }
  const double reach = farthest_moved(model, context.state, tool, body);
  if (!(reach > 0.0)) {
    return std::nullopt;
  }
  const NearestSample nearest = nearest_sample(model, tool, body, tool_in_body, reach);
  if (nearest.sample == kNoRow) {
    return std::nullopt;
  }
  const SurfaceSample& sample = model.samples.at<SurfaceSample>(nearest.sample);
  const glm::dvec3 point = to_outer(tool_in_body, sample.position);
  const Distance to_body = signed_distance(model, model.bodies.at<OwnedRows>(body).parts, point);
  const Pose moved =
      law.motion_at(model, context.state, body, tool,
                    {point - to_body.value * to_body.gradient, to_body.gradient, sample.spacing});
  return relative(moved, tool_in_body);
}

}  // namespace torsion::engine
