#include "app/view/tool_drag.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace torsion::engine {

std::optional<double> meets_box(const PixelRay& ray, const Pose& pose, const Bounds& bounds) {
  const glm::dquat to_box = glm::conjugate(pose.rotation);
  const glm::dvec3 origin = to_box * (ray.origin - pose.position);
  const glm::dvec3 direction = to_box * ray.direction;
  double enters = 0.0;
  double leaves = 1e300;
  for (int axis = 0; axis < 3; ++axis) {
    // A direction along the face divides by zero: both ends are infinite, of opposite signs inside.
    const double a = (bounds.lowest[axis] - origin[axis]) / direction[axis];
    const double b = (bounds.highest[axis] - origin[axis]) / direction[axis];
    enters = std::fmax(enters, std::fmin(a, b));
    leaves = std::fmin(leaves, std::fmax(a, b));
  }
  return enters <= leaves && leaves > 0.0 ? std::optional(enters) : std::nullopt;
}

void turn(Pose& handle, const glm::dvec3& pivot, const glm::dvec3& axis, double angle) {
  const glm::dquat rotation = glm::angleAxis(angle, axis);
  handle.position = pivot + rotation * (handle.position - pivot);
  handle.rotation = glm::normalize(rotation * handle.rotation);
}

Pose drive_on(ToolDrive& drive, double slide, double spin, double time) {
  const double elapsed = std::fmax(time - drive.time, 0.0);  // a restart sets the time back
  drive.time = time;
  drive.way += slide * elapsed;
  drive.turned += spin * elapsed;
  Pose handle = drive.start;
  turn(handle, drive.pivot, drive.axis, drive.turned);
  const double angle = drive.way / drive.radius;
  handle.position += drive.radius * ((1.0 - std::cos(angle)) * drive.tangent +
                                     std::sin(angle) * glm::cross(drive.axis, drive.tangent));
  return handle;
}

namespace {

/// How far along `axis` the mouse went, m.
/// @param across  pixels a metre, in the plane of the view
double pressed(const glm::dvec2& moved, const Camera& camera, double picture_height, double across,
               const glm::dvec3& pivot, const glm::dvec3& axis) {
  constexpr double kSeenWell = 0.3;          // of its length
  const glm::dvec2 picture(picture_height);  // its width does not matter to differences
  const double step = 1.0 / across;
  const glm::dvec3 seen =
      seen_at(camera, pivot + step * axis, picture) - seen_at(camera, pivot, picture);
  glm::dvec2 way = glm::dvec2(seen) / step;  // pixels a metre
  if (!(glm::length(way) > kSeenWell * across)) {
    way = glm::dvec2(0.0, -across);
  }
  return glm::dot(moved, way) / glm::dot(way, way);
}

}  // namespace

void drag(ToolDrag& taken, DragKind kind, const glm::dvec2& mouse, const Camera& camera,
          double picture_height, const glm::dvec3& pivot, const glm::dvec3& axis, Pose& handle) {
  const glm::dvec2 moved = mouse - taken.mouse;
  taken.mouse = mouse;
  const double meters = 2.0 * taken.depth * std::tan(camera.vertical_field_of_view / 2.0) /
                        std::max(picture_height, 1.0);
  const glm::dquat& view = camera.pose.rotation;
  const glm::dvec3 across = view * glm::dvec3(moved.x * meters, -moved.y * meters, 0.0);
  switch (kind) {
    case DragKind::kPress:
      handle.position += axis * pressed(moved, camera, picture_height, 1.0 / meters, pivot, axis);
      break;
    case DragKind::kSlide:
      handle.position += across - axis * glm::dot(across, axis);
      break;
    case DragKind::kAcross:
      handle.position += across;
      break;
    case DragKind::kAlong:
      handle.position += view * glm::dvec3(0.0, 0.0, moved.y * meters);
      break;
    case DragKind::kTurn:
      turn(handle, pivot, axis, kRadiansAPixel * moved.x);
      break;
  }
}

}  // namespace torsion::engine
