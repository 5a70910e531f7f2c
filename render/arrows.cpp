#include "render/arrows.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace torsion::engine {
namespace {

constexpr int kSides = 16;           // of a shaft
constexpr int kArcSteps = 48;        // of a full turn
constexpr double kShaft = 0.033;     // radius, of `size`
constexpr double kTip = 0.1;         // radius at its foot, of `size`
constexpr double kTipLength = 0.26;  // of `size`
constexpr double kFullArc = 300.0 / 360.0 * glm::two_pi<double>();
constexpr glm::vec3 kForceColor(0.02F, 0.16F, 0.55F);
constexpr glm::vec3 kTorqueColor(0.75F, 0.22F, 0.0F);
constexpr glm::vec3 kCoupleColor(0.30F, 0.03F, 0.42F);
// Radius of a couple's arc: around the contact, and no smaller than a tool's own arc can be told
// from.
constexpr double kAroundContact = 1.35;     // of the contact's radius
constexpr double kSmallestCoupleArc = 0.3;  // of the full arrow

/// A cross-section of a tube: a circle, and how its wall leans.
struct Ring {
  glm::dvec3 center;
  glm::dvec3 along;  // unit
  glm::dvec3 side;   // unit, across `along`
  double radius;
  double lean;  // part of `along` in the normal, for cones
};

glm::dvec3 any_across(const glm::dvec3& axis) {
  const glm::dvec3 other =
      std::abs(axis.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
  return glm::normalize(glm::cross(axis, other));
}

void append_corner(const Ring& ring, int step, const glm::vec3& color, ArrowMesh& mesh) {
  const double angle = glm::two_pi<double>() * step / kSides;
  const glm::dvec3 out =
      std::cos(angle) * ring.side + std::sin(angle) * glm::cross(ring.along, ring.side);
  mesh.positions.emplace_back(glm::vec3(ring.center + ring.radius * out), 1.0F);
  mesh.normals.emplace_back(glm::vec3(glm::normalize(out + ring.lean * ring.along)), 0.0F);
  mesh.colors.emplace_back(color, 1.0F);
}

/// The wall between two rings; a ring of radius 0 makes it a cone or a disc.
void append_wall(const Ring& low, const Ring& high, const glm::vec3& color, ArrowMesh& mesh) {
  for (int step = 0; step < kSides; ++step) {
    if (low.radius > 0.0) {
      append_corner(low, step, color, mesh);
      append_corner(low, step + 1, color, mesh);
      append_corner(high, step + 1, color, mesh);
    }
    if (high.radius > 0.0) {
      append_corner(low, step, color, mesh);
      append_corner(high, step + 1, color, mesh);
      append_corner(high, step, color, mesh);
    }
  }
}

constexpr double kFlat = 1e6;  // a lean that leaves nothing but `along`: the normal of a disc

void append_disc(Ring ring, const glm::vec3& color, ArrowMesh& mesh) {
  ring.lean = -kFlat;
  Ring middle = ring;
  middle.radius = 0.0;
  append_wall(middle, ring, color, mesh);
}

void append_tip(const glm::dvec3& foot, const glm::dvec3& along, const glm::dvec3& side,
                double size, const glm::vec3& color, ArrowMesh& mesh) {
  const Ring base{foot, along, side, kTip * size, kTip / kTipLength};
  Ring point = base;
  point.center += kTipLength * size * along;
  point.radius = 0.0;
  append_wall(base, point, color, mesh);
  append_disc(base, color, mesh);
}

}  // namespace

void ArrowMesh::clear() {
  positions.clear();
  normals.clear();
  colors.clear();
}

void append_arrow(const glm::dvec3& tail, const glm::dvec3& vector, double size,
                  const glm::vec3& color, ArrowMesh& mesh) {
  const double length = glm::length(vector);
  if (!(length > 1e-3 * size)) {
    return;
  }
  const glm::dvec3 along = vector / length;
  // A short arrow is a small one: its tip takes at most 60 % of it.
  const double shown = std::min(size, length / kTipLength * 0.6);
  const Ring low{tail, along, any_across(along), kShaft * shown, 0.0};
  Ring high = low;
  high.center += (length - kTipLength * shown) * along;
  append_disc(low, color, mesh);
  append_wall(low, high, color, mesh);
  append_tip(high.center, along, low.side, shown, color, mesh);
}

void append_arc(const Circle& circle, double angle, double size, const glm::vec3& color,
                ArrowMesh& mesh) {
  const double tip_angle = kTipLength * size / circle.radius;
  if (!(angle * circle.radius > 1e-3 * size)) {
    return;
  }
  const double shown = std::min(size, angle / tip_angle * 0.6 * size);
  const double shaft_angle = angle - tip_angle * shown / size;
  const glm::dvec3 y = glm::cross(circle.axis, circle.start);
  const auto ring_at = [&](double turn) {
    const glm::dvec3 out = std::cos(turn) * circle.start + std::sin(turn) * y;
    return Ring{circle.center + circle.radius * out, glm::cross(circle.axis, out), out,
                kShaft * shown, 0.0};
  };
  const int steps =
      std::max(1, static_cast<int>(std::ceil(shaft_angle / glm::two_pi<double>() * kArcSteps)));
  append_disc(ring_at(0.0), color, mesh);
  for (int step = 0; step < steps; ++step) {
    append_wall(ring_at(shaft_angle * step / steps), ring_at(shaft_angle * (step + 1) / steps),
                color, mesh);
  }
  const Ring last = ring_at(shaft_angle);
  // The straight tip leaves the circle along the chord, so that its point comes back to it.
  const double half_tip = 0.5 * tip_angle * shown / size;
  const glm::dvec3 along = std::cos(half_tip) * last.along - std::sin(half_tip) * last.side;
  append_tip(last.center, along, any_across(along), shown, color, mesh);
}

namespace {

/// Across `axis`: where an arc begins so that the gap that a full one leaves is toward the eye.
glm::dvec3 arc_start(const glm::dvec3& axis, const glm::dvec3& to_eye) {
  const glm::dvec3 across = to_eye - glm::dot(to_eye, axis) * axis;
  const double length = glm::length(across);
  const glm::dvec3 x = length > 1e-3 * glm::length(to_eye) ? across / length : any_across(axis);
  constexpr double kHalfGap = 0.5 * (glm::two_pi<double>() - kFullArc);
  return std::cos(kHalfGap) * x + std::sin(kHalfGap) * glm::cross(axis, x);
}

}  // namespace

namespace {

/// @param torque  N m, world
/// @param full    N m of an arc of 300 degrees
void append_torque(const glm::dvec3& torque, double full, const glm::dvec3& center, double radius,
                   const ArrowScale& scale, const glm::vec3& color, ArrowMesh& mesh) {
  const double size = glm::length(torque);
  if (size > 0.0) {
    const double angle = std::min(size / full, 1.0) * kFullArc;
    const glm::dvec3 axis = torque / size;
    append_arc({center, axis, arc_start(axis, scale.eye - center), radius}, angle, scale.length,
               color, mesh);
  }
}

/// The arcs of a tool's contact couples. @return their sum, N m, world
glm::dvec3 append_couples(const Snapshot& snapshot, std::uint32_t tool, const ArrowScale& scale,
                          ArrowMesh& mesh) {
  glm::dvec3 sum(0.0);
  for (std::uint32_t region = 0; region < snapshot.regions.size(); ++region) {
    const RegionIdentity& identity = snapshot.regions.at<RegionIdentity>(region);
    if (identity.tool == tool) {
      const Pose& body = scale.bodies[identity.body];
      const Contact& contact = snapshot.regions.at<Contact>(region);
      const glm::dvec3 couple = snapshot.regions.at<RegionFriction>(region).couple *
                                (body.rotation * snapshot.regions.at<RegionFrame>(region).normal);
      append_torque(couple, scale.full_couple,
                    body.position + body.rotation * contact.equivalent_point,
                    std::max(kAroundContact * contact.radius, kSmallestCoupleArc * scale.length),
                    scale, kCoupleColor, mesh);
      sum += couple;
    }
  }
  return sum;
}

}  // namespace

void append_wrenches(const Snapshot& snapshot, const ArrowScale& scale, ArrowMesh& mesh) {
  for (std::uint32_t tool = 0; tool < snapshot.tools.size(); ++tool) {
    const glm::dvec3& center = snapshot.tools.at<ToolMotion>(tool).mass_center;
    const Wrench& wrench = snapshot.tools.at<ToolWrench>(tool).total;
    append_arrow(center, wrench.force / scale.full_force * scale.length, scale.length, kForceColor,
                 mesh);
    const glm::dvec3 couples =
        scale.parts ? append_couples(snapshot, tool, scale, mesh) : glm::dvec3(0.0);
    append_torque(wrench.torque - couples, scale.full_torque, center, scale.arc_radii[tool], scale,
                  kTorqueColor, mesh);
  }
}

}  // namespace torsion::engine
