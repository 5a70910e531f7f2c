#pragma once

#include <glm/vec2.hpp>

#include "render/camera.hpp"

namespace torsion::engine {

/// A camera that circles a point: how it stands, as a person moves it. The world's y stays up.
struct OrbitCamera {
  glm::dvec3 target{0.0};               // m, world: what it looks at
  double distance = 1.0;                // m
  double azimuth = 0.0;                 // rad: about +y, 0: from +z
  double elevation = 0.0;               // rad: above the horizon
  double vertical_field_of_view = 0.8;  // rad
};

/// The orbit that stands and looks as `camera` does, about the point ahead of it nearest `center`.
OrbitCamera orbit_of(const Camera& camera, const glm::dvec3& center);

Camera camera_of(const OrbitCamera& orbit);

/// @param turn  rad: by azimuth and elevation; the elevation stops short of straight up and down
void orbit(OrbitCamera& camera, const glm::dvec2& turn);

/// What is under the mouse follows it.
/// @param pixels  x right, y down
void pan(OrbitCamera& camera, const glm::dvec2& pixels, double picture_height);

/// @param notches  of the wheel; positive: nearer
void zoom(OrbitCamera& camera, double notches);

/// A ray through a pixel, and how wide a pixel is along it.
struct PixelRay {
  glm::dvec3 origin{0.0};     // m, world
  glm::dvec3 direction{0.0};  // world, unit
  double width = 0.0;         // rad: of a pixel, seen from the origin
};
PixelRay ray_through(const Camera& camera, const glm::dvec2& pixel, const glm::dvec2& picture);

/// Where a point is seen, pixels; z: its depth before the camera, m, negative behind it.
glm::dvec3 seen_at(const Camera& camera, const glm::dvec3& point, const glm::dvec2& picture);

}  // namespace torsion::engine
