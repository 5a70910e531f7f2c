#include "systems/surface/twist_and_dent.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>

#include <glm/geometric.hpp>

#include "systems/body/skeleton/skeleton.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/half_space/fields.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

/// Height over the fixed region, one at `contact`: over a fixed face measured from the face, else
/// along `direction` from q_f. Where the contact's height is less than `least`, the heights fade to
/// zero instead of changing sign abruptly.
HeightShare height_share(const FixedRegion& fixed, const glm::dvec3& contact,
                         const glm::dvec3& direction, double least) {
  const glm::dvec3 along = fixed.kind == FixedKind::kFace ? fixed.normal : direction;
  const double height = glm::dot(contact - fixed.point, along);
  const double square = std::max(height * height, least * least);
  return {fixed.point, square > 0.0 ? along * (height / square) : glm::dvec3(0.0)};
}

/// Turn at the contact by the torque of a region that the tool's axis misses: T l / (G J), (10). J
/// is the polar second moment about that axis of the body's section, Saint-Venant's constant about
/// the section's own middle; it is the harmonic mean along the main beam.
double turn_past_region(const Model& model, std::uint32_t body, const glm::dvec3& contact,
                        const glm::dvec3& axis, const glm::dvec3& on_axis, double torque) {
  const MainBeam beam = main_beam(model, body, contact);
  if (!beam.has_sections) {
    return 0.0;
  }
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const glm::dvec3 offset = 0.5 * (bounds.lowest + bounds.highest) - on_axis;
  const glm::dvec3 arm = offset - axis * glm::dot(offset, axis);
  double compliance = 0.0;  // 1/m^4, mean of 1/J
  for (const BeamSection& section : beam.sections) {
    compliance += 1.0 / (section.torsion_constant + section.area * glm::dot(arm, arm));
  }
  compliance /= static_cast<double>(kBeamStations);
  const double lever = std::abs(glm::dot(contact - model.bodies.at<FixedRegion>(body).point, axis));
  return torque * lever * compliance / model.bodies.at<Elasticity>(body).shear_modulus();
}

/// Displacement of an elastic half-space under a contact of radius 1, 1 at the centre.
struct Profiles {
  double hertz;  // paraboloid
  double punch;  // flat end
};

/// asin(1 / r) for r > 1; far away its series, which is cheaper and within 5e-9 from r = 8 on.
double inverse_sine_of_reciprocal(double r) {
  if (r < 8.0) {
    return std::asin(1.0 / r);
  }
  const double x = 1.0 / r;
  const double z = x * x;
  return x * (1.0 + z * (1.0 / 6.0 + z * (3.0 / 40.0 + z * (15.0 / 336.0))));
}

/// Source: Johnson, Contact Mechanics, 1985, chapters 3 and 4.
Profiles half_space_profiles(double r) {
  if (r <= 1.0) {
    return {1.0 - 0.5 * r * r, 1.0};
  }
  const double angle = inverse_sine_of_reciprocal(r);
  return {((2.0 - r * r) * angle + std::sqrt(r * r - 1.0)) / pi, 2.0 / pi * angle};
}

/// The sums of a half-space model in a region; radius 0 where it has none.
TurnedDiscs turned_discs(const Snapshot& snapshot, std::uint32_t region) {
  const RegionField& field = snapshot.region_fields.at<RegionField>(region);
  const RegionFrame& frame = snapshot.regions.at<RegionFrame>(region);
  TurnedDiscs discs;
  discs.center = grid_to_body(frame, {field.center, 0.0});
  discs.normal = frame.normal;
  discs.radius = field.radius;
  std::copy(std::begin(field.turn), std::end(field.turn), discs.turn.begin());
  discs.most = snapshot.regions.at<RegionMotion>(region).largest_turn;
  discs.sum_far_terms();
  return discs;
}

/// The forces of a half-space model in a region; count 0 where it has none.
/// @param share  of their displacement that is drawn
PressedSurface pressed_surface(const Model& model, const Snapshot& snapshot, std::uint32_t region,
                               double share) {
  const RegionField& field = snapshot.region_fields.at<RegionField>(region);
  const RegionFrame& frame = snapshot.regions.at<RegionFrame>(region);
  const Elasticity& elasticity =
      model.bodies.at<Elasticity>(snapshot.regions.at<RegionIdentity>(region).body);
  PressedSurface pressed;
  const double normal_force = snapshot.regions.at<RegionNormal>(region).force;
  if (field.radius <= 0.0 || normal_force <= 0.0) {
    return pressed;
  }
  const glm::dvec3 drag =
      tangent_to_body(frame, snapshot.regions.at<RegionFriction>(region).force) / -normal_force;
  const double turn = glm::dot(snapshot.regions.at<RegionCarrier>(region).rotation, frame.normal);
  const double sine = std::sin(turn);
  const double cosine = std::cos(turn);
  for (const PressedBlock& block : field.blocks) {
    if (block.force > 0.0) {
      const glm::dvec3 force = (drag - frame.normal) * block.force;
      // The grid lies on the material, which has turned under the contact.
      const glm::dvec2 arm = block.place - field.center;
      const glm::dvec2 turned(cosine * arm.x - sine * arm.y, sine * arm.x + cosine * arm.y);
      const glm::dvec3 place(field.center + turned, 0.0);
      pressed.forces[pressed.count++] = {grid_to_body(frame, place), force};
      pressed.all.force += force;
    }
  }
  pressed.all.place = grid_to_body(frame, {field.center, 0.0});
  pressed.normal = frame.normal;
  pressed.radius = field.radius;
  pressed.spread = field.spread;
  pressed.shear_modulus = elasticity.shear_modulus();
  pressed.poisson_ratio = elasticity.poisson_ratio;
  pressed.share = share;
  return pressed;
}

}  // namespace

void TurnedDiscs::sum_far_terms() {
  turn_3 = turn_5 = 0.0;
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    const double s = radius * static_cast<double>(j + 1) / kFieldDiscs;
    const double cube = s * s * s;
    turn_3 += 4.0 / (3.0 * pi) * cube * turn[j];
    turn_5 += 2.0 / (5.0 * pi) * cube * s * s * turn[j];
  }
}

double TurnedDiscs::far_angle(double height, double square) const {
  const double inverse = 1.0 / square;
  return (turn_3 + turn_5 * inverse * (1.0 - 5.0 * height * height * inverse)) * inverse /
         std::sqrt(square);
}

double TurnedDiscs::angle(const glm::dvec3& point) const {
  const glm::dvec3 away = point - center;
  const double height = glm::dot(away, normal);
  const double square = glm::dot(away, away);
  const double lateral = std::max(square - height * height, 0.0);
  const double near = 1.0 - smooth_step(std::sqrt(square) / radius - 3.0);
  const double far = near < 1.0 ? far_angle(height, square) : 0.0;
  if (near == 0.0) {
    return std::clamp(far, -most, most);
  }
  double sum = 0.0;
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    const double s = radius * static_cast<double>(j + 1) / kFieldDiscs;
    const double z = height / s;
    const double excess = (lateral + height * height) / (s * s) - 1.0;
    const double zeta_2 = 0.5 * (excess + std::sqrt(excess * excess + 4.0 * z * z));
    const double zeta = std::sqrt(std::max(zeta_2, 0.0));
    sum += turn[j] * 2.0 / pi * (0.5 * pi - std::atan(zeta) - zeta / (1.0 + zeta_2));
  }
  return std::clamp(near * sum + (1.0 - near) * far, -most, most);
}

double PressedSurface::near_share(const glm::dvec3& point) const {
  return 1.0 - smooth_step(glm::distance(point, all.place) / radius - 3.0);
}

glm::dvec3 PressedSurface::displacement(const glm::dvec3& point) const {
  const HalfSpace half_space{normal, shear_modulus, poisson_ratio};
  const double near = near_share(point);
  const glm::dvec3 far =
      near < 1.0 ? displacement_by_force(half_space, point - all.place, all.force, spread)
                 : glm::dvec3(0.0);
  if (near == 0.0) {
    return share * far;
  }
  glm::dvec3 sum(0.0);
  for (const Force& each : std::span(forces).first(count)) {
    sum += displacement_by_force(half_space, point - each.place, each.force, spread);
  }
  return share * (near * sum + (1.0 - near) * far);
}

double HeightShare::at(const glm::dvec3& point) const {
  return std::clamp(glm::dot(point - origin, slope), 0.0, 1.0);
}

double RegionTwist::angle(const glm::dvec3& rest) const {
  if (discs.radius > 0.0) {
    return discs.angle(rest);
  }
  double turn = 0.0;
  if (through > 0.0 && stick_turn != 0.0) {
    const glm::dvec3 offset = rest - point;
    const glm::dvec3 arm = offset - direction * glm::dot(offset, direction);
    const double distance = glm::length(arm);
    const double share = distance > stick_radius ? stick_radius / distance : 1.0;
    turn += through * stick_turn * share * through_height.at(rest);
  }
  if (past_turn != 0.0) {
    turn += past_turn * past_height.at(rest);
  }
  return turn;
}

RegionTwist region_twist(const Model& model, const Snapshot& snapshot, std::uint32_t region) {
  const RegionIdentity& identity = snapshot.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = snapshot.regions.at<RegionFrame>(region);
  const Contact& contact = snapshot.regions.at<Contact>(region);
  const RegionMotion& motion = snapshot.regions.at<RegionMotion>(region);
  const RegionFriction& friction = snapshot.regions.at<RegionFriction>(region);
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(identity.body);
  const glm::dvec3 place = contact.rest_point;

  RegionTwist twist;
  twist.discs = turned_discs(snapshot, region);
  if (twist.discs.radius > 0.0) {
    twist.axis.point = glm::vec4(glm::vec3(twist.discs.center), 0.0F);
    twist.axis.direction = glm::vec4(glm::vec3(twist.discs.normal), 0.0F);
    return twist;
  }
  if (law_of(model, identity.body).keeps != KeptColumns::kNone) {
    // The region is so new that there is no field yet: it has hardly turned anything.
    twist.axis.point = glm::vec4(glm::vec3(place), 0.0F);
    twist.axis.direction = glm::vec4(glm::vec3(frame.normal), 0.0F);
    return twist;
  }
  twist.through = motion.axis_share;
  // The turn that the tractions correspond to. A slide may have left some of them: at most the turn
  // of the tool.
  twist.stick_turn = std::clamp(friction.stick_turn, -motion.largest_turn, motion.largest_turn);
  twist.stick_radius = std::max(friction.stick_radius, 1e-3 * contact.radius);
  twist.through_height = height_share(fixed, place, frame.normal, contact.radius);
  const double height = body_to_grid(frame, contact.equivalent_point).z;
  const glm::dvec3 pivot = grid_to_body(frame, glm::dvec3(motion.pivot, height));
  twist.point = pivot;
  twist.direction = frame.normal;
  const double past = 1.0 - motion.axis_share;
  if (past > 0.0 && glm::dot(motion.axis, motion.axis) > 0.0) {
    const Pose& pose = snapshot.bodies.at<BodyPose>(identity.body).now;
    const ToolOverBody& tool = snapshot.over(identity.tool, identity.body);
    const glm::dvec3 torque =
        glm::conjugate(pose.rotation) * snapshot.regions.at<RegionWrench>(region).on_tool.torque;
    // The sense of the axis is arbitrary: it is chosen along the normal, so that both branches turn
    // alike.
    const glm::dvec3 axis = glm::dot(motion.axis, frame.normal) < 0.0 ? -motion.axis : motion.axis;
    const glm::dvec3& center = tool.center;
    // A turn of less than a hundredth of a radian hardly has an axis: it is faded in. A tool that
    // goes on turning about one axis soon has twice as much (systems/contact/tool_motion.cpp).
    constexpr double kFirstTurn = 0.01;
    const double known = smooth_step(tool.axis_turn / kFirstTurn);
    // A beam softer than the contact would turn farther than the tool that turns it.
    twist.past_turn = past * known *
                      std::clamp(turn_past_region(model, identity.body, place, axis, center,
                                                  -glm::dot(torque, axis)),
                                 -motion.largest_rotation, motion.largest_rotation);
    twist.past_height = height_share(fixed, place, axis, contact.radius);
    twist.point = pivot * motion.axis_share + center * past;
    const glm::dvec3 blended = frame.normal * motion.axis_share + axis * past;
    twist.direction = blended / glm::length(blended);
  }
  twist.axis.point = glm::vec4(glm::vec3(twist.point), 0.0F);
  twist.axis.direction = glm::vec4(glm::normalize(glm::vec3(twist.direction)), 0.0F);
  return twist;
}

/// Distance from the contact's centre over its radius. The surface near the contact need not be
/// flat: heights of less than half a radius are ignored.
double RegionDent::reach(const glm::dvec3& point) const {
  const glm::dvec3 offset = point - center;
  const double height = glm::dot(offset, normal);
  const double counted = std::max(std::abs(height) - 0.5 * radius, 0.0);
  const double lateral = std::max(glm::dot(offset, offset) - height * height, 0.0);
  return std::sqrt(lateral + counted * counted) / radius;
}

glm::dvec3 RegionDent::displacement(const glm::dvec3& point) const {
  if (radius <= 0.0) {
    return glm::dvec3(0.0);
  }
  if (pressed.count > 0) {
    return pressed.displacement(point);
  }
  const Profiles profile = half_space_profiles(reach(point));
  const double down = depth * (flatness * profile.punch + (1.0 - flatness) * profile.hertz);
  return drag * profile.punch - normal * down;
}

double RegionDent::far_share(const glm::dvec3& point) const {
  return radius <= 0.0 ? 0.0 : smooth_step((reach(point) - 2.0) / 3.0);
}

RegionDent region_dent(const Model& model, const Snapshot& snapshot, std::uint32_t region,
                       const glm::dvec3& moved) {
  const RegionIdentity& identity = snapshot.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = snapshot.regions.at<RegionFrame>(region);
  const Contact& contact = snapshot.regions.at<Contact>(region);
  const double depth = snapshot.regions.at<Overlap>(region).largest_depth;
  const RegionFriction& friction = snapshot.regions.at<RegionFriction>(region);
  const Elasticity& elasticity = model.bodies.at<Elasticity>(identity.body);
  RegionDent dent;
  if (contact.radius <= 0.0 || depth <= 0.0) {
    return dent;
  }
  // A paraboloid overlaps by half its depth on average and has pressure on half the overlap's area
  // (Hertz); a flat end overlaps by its full depth and has pressure everywhere.
  const double fullness = std::clamp(contact.depth / depth, 0.5, 1.0);
  dent.flatness = 2.0 * fullness - 1.0;
  dent.radius = contact.radius * std::sqrt(fullness);
  dent.center = contact.rest_point;
  dent.normal = frame.normal;
  dent.depth = std::max(depth + glm::dot(moved, frame.normal), 0.0);
  // Tangential compliance of a disc (2 - nu) / (8 G a); the force on the body is minus that on the
  // tool.
  const double compliance =
      (2.0 - elasticity.poisson_ratio) / (8.0 * elasticity.shear_modulus() * contact.radius);
  dent.drag = tangent_to_body(frame, friction.force) * -compliance;
  dent.pressure =
      contact.area > 0.0 ? snapshot.regions.at<RegionNormal>(region).force / contact.area : 0.0;
  const bool in_series = body_law_of(model, identity.body).moves_as_a_whole;
  dent.pressed = pressed_surface(model, snapshot, region, in_series ? 1.0 : dent.depth / depth);
  dent.full_overlap = 0.1 * depth;
  return dent;
}

}  // namespace torsion::engine
