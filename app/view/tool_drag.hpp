#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>

#include "app/view/orbit_camera.hpp"

namespace torsion::engine {

/// How a mouse that has taken a tool moves it.
enum class DragKind : std::uint8_t {
  kPress,   // along an axis, the surface's normal
  kSlide,   // across that axis
  kAcross,  // in the plane of the view
  kAlong,   // towards and away from the person
  kTurn,    // about an axis
};

/// A handle that a mouse has taken hold of.
struct ToolDrag {
  std::uint32_t tool = 0;
  double depth = 0.0;     // m: of the point taken, before the camera
  glm::dvec2 mouse{0.0};  // pixels, last seen
};

/// How far along the ray a box is met, m; nothing where it misses it.
/// @param pose, bounds  of the box: its frame in the world, and itself in that frame
std::optional<double> meets_box(const PixelRay& ray, const Pose& pose, const Bounds& bounds);

/// Moves the handle as the mouse moved: across, one pixel of the picture at the depth of the point
/// taken; along, as far towards or away; pressed, so far along `axis` as that is seen to move, and
/// by the mouse's way down where the axis is seen from its end; slid, as across, without what is
/// along `axis`; a turn, kRadiansAPixel about `axis` through `pivot`.
/// @param axis  world, unit
void drag(ToolDrag& taken, DragKind kind, const glm::dvec2& mouse, const Camera& camera,
          double picture_height, const glm::dvec3& pivot, const glm::dvec3& axis, Pose& handle);

/// Turns the handle about an axis through `pivot`.
void turn(Pose& handle, const glm::dvec3& pivot, const glm::dvec3& axis, double angle);

/// A handle that slides round on the spot and spins, as long as it is told to.
struct ToolDrive {
  std::uint32_t tool = 0;
  Pose start;
  glm::dvec3 pivot{0.0};    // m, world: of the contact
  glm::dvec3 axis{0.0};     // world, unit: its normal
  glm::dvec3 tangent{0.0};  // world, unit
  double radius = 0.0;      // m: of the way round
  double way = 0.0;         // m: so far
  double turned = 0.0;      // rad: so far
  double time = 0.0;        // s, of the scene: until when
};

/// Goes on until `time`, sliding at `slide` [m/s] and spinning at `spin` [rad/s].
/// @return where the handle is then
Pose drive_on(ToolDrive& drive, double slide, double spin, double time);

inline constexpr double kRadiansAPixel = 0.005;
inline constexpr double kRadiansANotch = 0.05;

}  // namespace torsion::engine
