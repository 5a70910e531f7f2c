#include "systems/model/expected_rolling.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "systems/contact/group_points.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/geometry/surface_piece.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

/// The point of a piece whose outward normal is `direction`; along axes in which the piece is
/// straight, the point of `mean`. In the part's frame.
glm::dvec3 outermost(const SurfacePiece& piece, const glm::dvec3& direction,
                     const glm::dvec3& mean) {
  double square = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (piece.quadric[axis] > 0.0) {
      square += direction[axis] * direction[axis] / piece.quadric[axis];
    }
  }
  glm::dvec3 point = mean;
  for (int axis = 0; axis < 3; ++axis) {
    if (piece.quadric[axis] > 0.0 && square > 0.0) {
      point[axis] =
          piece.center[axis] + direction[axis] / (piece.quadric[axis] * std::sqrt(square));
    }
  }
  return point;
}

/// Moves a place from the mean of its points to where the part is deepest.
void find_deepest(const Model& model, std::uint32_t body, const Pose& pose,
                  const TouchingPoint& deepest, TouchedPlace& place) {
  constexpr int kSteps = 4;  // the body's normal is that of the point before
  const ShapePart& part = *deepest.part;
  if (part.kind == ShapeKind::kMesh) {
    return;
  }
  const SurfacePiece piece = piece_at(part, to_inner(part.pose, deepest.on_tool));
  if (piece.quadric == glm::dvec3(0.0)) {
    return;
  }
  const Pose& body_pose = model.bodies.at<Pose>(body);
  const Range parts = model.bodies.at<OwnedRows>(body).parts;
  const glm::dquat to_part =
      glm::conjugate(pose.rotation * part.pose.rotation) * body_pose.rotation;
  const glm::dvec3 mean = to_inner(part.pose, place.on_tool);
  Distance distance = signed_distance(model, parts, deepest.on_body);
  for (int step = 0; step < kSteps; ++step) {
    const glm::dvec3 point = outermost(piece, to_part * -distance.gradient, mean);
    place.on_tool = to_outer(part.pose, point);
    place.on_body = to_inner(body_pose, to_outer(pose, place.on_tool));
    distance = signed_distance(model, parts, place.on_body);
  }
  place.on_body -= distance.value * distance.gradient;
}

/// The groups' places, as if each began now.
std::vector<TouchedPlace> new_places(const Model& model, std::uint32_t body, std::uint32_t tool,
                                     const Pose& pose, std::span<const TouchingPoint> points) {
  std::vector<glm::dvec3> on_body;
  for (const TouchingPoint& point : points) {
    on_body.push_back(point.on_body);
  }
  std::vector<std::uint32_t> order(points.size());
  std::vector<std::uint32_t> parent(points.size());
  std::vector<std::uint32_t> groups(points.size());
  const std::uint32_t count = group_points(
      on_body, model.bodies.at<BodyModels>(body).region_threshold, no_links(parent), order, groups);
  std::vector<TouchedPlace> places(count);
  std::vector<const TouchingPoint*> deepest(count, nullptr);
  std::vector<double> depths(count, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t group = groups[i];
    places[group].on_body += points[i].depth * points[i].on_body;
    places[group].on_tool += points[i].depth * points[i].on_tool;
    depths[group] += points[i].depth;
    if (deepest[group] == nullptr || points[i].depth > deepest[group]->depth) {
      deepest[group] = &points[i];
    }
  }
  for (std::uint32_t group = 0; group < count; ++group) {
    TouchedPlace& place = places[group];
    place.tool = tool;
    place.on_body /= depths[group];
    place.on_tool /= depths[group];
    find_deepest(model, body, pose, *deepest[group], place);
    place.began_on_body = place.on_body;
    place.began_on_tool = place.on_tool;
  }
  return places;
}

/// The place of the same tool, or null.
const TouchedPlace* nearest_of(std::span<const TouchedPlace> places, const TouchedPlace& place) {
  const TouchedPlace* nearest = nullptr;
  for (const TouchedPlace& other : places) {
    if (other.tool == place.tool &&
        (nearest == nullptr || glm::distance(other.on_body, place.on_body) <
                                   glm::distance(nearest->on_body, place.on_body))) {
      nearest = &other;
    }
  }
  return nearest;
}

}  // namespace

std::vector<TouchedPlace> touched_places(const Model& model, std::uint32_t body, std::uint32_t tool,
                                         const Pose& pose, std::span<const TouchingPoint> points,
                                         std::span<const TouchedPlace> before) {
  std::vector<TouchedPlace> places = new_places(model, body, tool, pose, points);
  for (TouchedPlace& place : places) {
    const TouchedPlace* const last = nearest_of(before, place);
    if (last != nullptr && nearest_of(places, *last) == &place) {
      place.began_on_body = last->began_on_body;
      place.began_on_tool = last->began_on_tool;
    }
  }
  return places;
}

double rolled_way(const TouchedPlace& place, const glm::dquat& tool_to_body) {
  const glm::dvec3 over_body = place.on_body - place.began_on_body;
  const glm::dvec3 over_tool = tool_to_body * (place.on_tool - place.began_on_tool);
  const double slipped = glm::distance(over_body, over_tool);
  return std::max(0.0, 0.5 * (glm::length(over_body) + glm::length(over_tool) - slipped));
}

}  // namespace torsion::engine
