#include "app/view/orbit_camera.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

constexpr double kSteepest = 1.55;        // rad
constexpr double kNearer = 0.9;           // of the distance, a notch
constexpr double kNearPlaneShare = 0.02;  // of the distance
constexpr double kFarPlaneShare = 50.0;

glm::dvec3 backward_of(const OrbitCamera& camera) {
  return {std::sin(camera.azimuth) * std::cos(camera.elevation), std::sin(camera.elevation),
          std::cos(camera.azimuth) * std::cos(camera.elevation)};
}

}  // namespace

OrbitCamera orbit_of(const Camera& camera, const glm::dvec3& center) {
  const glm::dvec3 backward = camera.pose.rotation * glm::dvec3(0.0, 0.0, 1.0);
  OrbitCamera result;
  result.distance =
      std::max(glm::dot(camera.pose.position - center, backward), 2.0 * camera.near_plane);
  result.target = camera.pose.position - backward * result.distance;
  result.azimuth = std::atan2(backward.x, backward.z);
  result.elevation =
      std::clamp(std::asin(std::clamp(backward.y, -1.0, 1.0)), -kSteepest, kSteepest);
  result.vertical_field_of_view = camera.vertical_field_of_view;
  return result;
}

Camera camera_of(const OrbitCamera& orbit) {
  Camera camera;
  camera.pose.rotation = glm::angleAxis(orbit.azimuth, glm::dvec3(0.0, 1.0, 0.0)) *
                         glm::angleAxis(-orbit.elevation, glm::dvec3(1.0, 0.0, 0.0));
  camera.pose.position = orbit.target + backward_of(orbit) * orbit.distance;
  camera.vertical_field_of_view = orbit.vertical_field_of_view;
  camera.near_plane = kNearPlaneShare * orbit.distance;
  camera.far_plane = kFarPlaneShare * orbit.distance;
  return camera;
}

void orbit(OrbitCamera& camera, const glm::dvec2& turn) {
  camera.azimuth += turn.x;
  camera.elevation = std::clamp(camera.elevation + turn.y, -kSteepest, kSteepest);
}

void pan(OrbitCamera& camera, const glm::dvec2& pixels, double picture_height) {
  const double meters = 2.0 * camera.distance * std::tan(camera.vertical_field_of_view / 2.0) /
                        std::max(picture_height, 1.0);
  const glm::dquat rotation = camera_of(camera).pose.rotation;
  camera.target += rotation * glm::dvec3(-pixels.x * meters, pixels.y * meters, 0.0);
}

void zoom(OrbitCamera& camera, double notches) {
  camera.distance *= std::pow(kNearer, notches);
}

PixelRay ray_through(const Camera& camera, const glm::dvec2& pixel, const glm::dvec2& picture) {
  const double half = std::tan(camera.vertical_field_of_view / 2.0);
  const double scale = 2.0 * half / picture.y;
  const glm::dvec3 ahead((pixel.x - (0.5 + camera.shift) * picture.x) * scale,
                         (picture.y / 2.0 - pixel.y) * scale, -1.0);
  return {camera.pose.position, glm::normalize(camera.pose.rotation * ahead),
          scale / glm::length(ahead)};
}

glm::dvec3 seen_at(const Camera& camera, const glm::dvec3& point, const glm::dvec2& picture) {
  const glm::dvec3 at = glm::conjugate(camera.pose.rotation) * (point - camera.pose.position);
  const double depth = -at.z;
  const double scale =
      picture.y / (2.0 * std::tan(camera.vertical_field_of_view / 2.0) * std::max(depth, 1e-9));
  return {(0.5 + camera.shift) * picture.x + at.x * scale, picture.y / 2.0 - at.y * scale, depth};
}

}  // namespace torsion::engine
