#include "app/report/exact_cases.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "app/report/paper_ball.hpp"
#include "app/report/rolling_case.hpp"
#include "app/report/sphere_on_half_space.hpp"
#include "tests/reference/exact/cattaneo_mindlin.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/limit_surface.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/reference/exact/masing.hpp"
#include "tests/reference/exact/materials.hpp"

namespace torsion::engine {
namespace {

constexpr int kPointsOfLeg = 16;

/// To `amplitude`, to -amplitude, and back: calls add(value, leg) for each point.
template <class Add>
void to_and_fro(double amplitude, const Add& add) {
  for (int i = 1; i <= kPointsOfLeg; ++i) {
    add(amplitude * i / kPointsOfLeg, Leg::kLoad);
  }
  for (int i = 1; i <= 2 * kPointsOfLeg; ++i) {
    add(amplitude * (kPointsOfLeg - i) / kPointsOfLeg, Leg::kUnload);
  }
  for (int i = 1; i <= 2 * kPointsOfLeg; ++i) {
    add(amplitude * (i - kPointsOfLeg) / kPointsOfLeg, Leg::kReload);
  }
}

/// How far the largest couple of a sphere is from that of Hertz' pressure of the same force and
/// radius. A profile with g = x^2 / R + x^4 / (3 R^3) has the line load (1 - x^2) + k (1 - x^4)
/// over a, k = (a / R)^2 / 3, and a couple of the integral of x times it: 0.375 (1 + 2 k / 15) F a
/// to first order.
double pressure_error(const SphereOnHalfSpace& sphere) {
  const double share = sphere.hertz.radius / kPaperBallRadius;
  return 2.0 / 15.0 * share * share / 3.0;
}

ReferenceCase twist_case(bool quick) {
  const SphereOnHalfSpace sphere = sphere_on_half_space(quick);
  const reference::LubkinContact contact{reference::PressureShape::kHertz, sphere.hertz.force,
                                         sphere.friction.dynamic_friction, sphere.hertz.radius,
                                         sphere.elasticity.shear_modulus()};
  // All but a disc of a tenth of the radius has slipped there: the torque is all but saturated.
  const double amplitude = reference::slip_twist(contact, 0.1 * contact.radius);
  ReferenceCase result;
  result.name = "sphere_twist";
  result.title = "Ball on a half-space, turned to and fro";
  result.description =
      sphere_text(sphere) +
      fmt::format(
          " Then it is turned to {:.3g} rad, back to \u2212{:.3g} rad and up again, at "
          "constant depth.",
          amplitude, amplitude);
  result.reference = fmt::format(
      "Sneddon (1965) for force and contact radius, Lubkin (1951) for torque and twist field, "
      "Masing\u2019s rule after each reversal; evaluated to 1e-11. That a sphere presses not "
      "quite as Hertz\u2019 paraboloid changes the torque by {:.1g}\u00a0%.",
      100.0 * pressure_error(sphere));
  result.force_meaning = "normal force, pressing and turning";
  result.torque_meaning = "torque about the axis of the turn";
  result.scene = scene_of(sphere);
  result.path = press(sphere, true);
  for (PathPoint& point : result.path) {
    point.torque = 0.0;
  }
  result.path.front().force = 0.0;
  reference::MasingHistory history;
  to_and_fro(amplitude, [&](double turn, Leg leg) {
    const double torque = reference::move_to(
        history, [&](double phi) { return reference::torque(contact, phi); }, turn);
    result.path.push_back(
        {pose_at(kPaperBallDepth, turn, 0.0), sphere.steps, leg, turn, sphere.hertz.force, torque});
    if (turn == amplitude && leg == Leg::kLoad) {
      result.field.point = result.path.size() - 1;
    }
  });
  result.x = {PlotAxis::Quantity::kAbscissa, "turn of the tool (mrad)", 1e3};
  result.y = {PlotAxis::Quantity::kTorque, "torque (mN m)", 1e3};
  result.field.tool_turn = amplitude;
  result.field.contact_radius = contact.radius;
  for (int i = 1; i <= 80; ++i) {
    const double r = 0.1 * i * contact.radius;
    result.field.radii.push_back(r);
    result.field.twists.push_back(reference::twist_displacement(contact, amplitude, r) / r);
  }
  return result;
}

reference::CattaneoMindlin pushed(const SphereOnHalfSpace& sphere) {
  return {sphere.hertz.force, sphere.friction.dynamic_friction, sphere.hertz.radius,
          reference::tangential_modulus(sphere.elasticity.youngs_modulus,
                                        sphere.elasticity.poisson_ratio)};
}

ReferenceCase shear_case(bool quick) {
  const SphereOnHalfSpace sphere = sphere_on_half_space(quick);
  const reference::CattaneoMindlin contact = pushed(sphere);
  const double amplitude = 0.95 * reference::full_slip_displacement(contact);
  ReferenceCase result;
  result.name = "sphere_shear";
  result.title = "Ball on a half-space, pushed to and fro";
  result.description =
      sphere_text(sphere) +
      fmt::format(
          " Then it is pushed sideways by {:.3g} mm, back to \u2212{:.3g} mm and forth again, "
          "at constant depth: 95 % of the way to full sliding.",
          1e3 * amplitude, 1e3 * amplitude);
  result.reference =
      "Cattaneo (1938) and Mindlin (1949), Masing\u2019s rule after each turn. The theory neglects "
      "the slip across the push: 0.2 % of the force at \u03bd = 0.5.";
  result.force_meaning = "force along the push";
  result.scene = scene_of(sphere);
  result.path = press(sphere, false);
  result.force_axis = {-1.0, 0.0, 0.0};
  reference::MasingHistory history;
  to_and_fro(amplitude, [&](double shift, Leg leg) {
    const double force = reference::move_to(
        history, [&](double u) { return reference::tangential_force(contact, u); }, shift);
    result.path.push_back(
        {pose_at(kPaperBallDepth, 0.0, shift), sphere.steps, leg, shift, force, kNoReference});
  });
  result.x = {PlotAxis::Quantity::kAbscissa, "shift of the tool (mm)", 1e3};
  result.y = {PlotAxis::Quantity::kForce, "force along the push (N)", 1.0};
  return result;
}

ReferenceCase slide_and_spin_case(bool quick) {
  const SphereOnHalfSpace sphere = sphere_on_half_space(quick);
  const double radius = sphere.hertz.radius;
  const double limit = sphere.friction.dynamic_friction * sphere.hertz.force;
  const reference::CattaneoMindlin shear = pushed(sphere);
  // Long enough for all to slip whatever the motion before, next to the axis of the rotation too,
  // where the way is short: after half of it the friction there still points along the motion
  // before, which is 2 % of the force with any number of cells; after all of it 0.1 %.
  const double way = 10.0 * reference::full_slip_displacement(shear);
  ReferenceCase result;
  result.name = "sphere_slide_and_spin";
  result.title = "Ball on a half-space, sliding while it spins";
  result.description =
      sphere_text(sphere) +
      fmt::format(
          " Then it slides with the speed v and spins with \u03c9 at once, at nine ratios of v "
          "to \u03c9a one after another, {:.2g} mm of way each: force and torque are compared "
          "at each one\u2019s end, when all slips steadily.",
          1e3 * way);
  result.reference =
      "The exact limit surface of Hertz\u2019s pressure (Contensou 1962, Zhuravlev 1998), to "
      "1e-13.";
  result.force_meaning = "friction force against the sliding";
  result.torque_meaning = "friction torque against the spin";
  result.scene = scene_of(sphere);
  result.path = press(sphere, false);
  result.force_axis = {-1.0, 0.0, 0.0};
  constexpr int kRatios = 9;
  double turn = 0.0;
  double shift = 0.0;
  for (int i = 0; i < kRatios; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / (kRatios - 1);  // 0: only spins
    const double slide = way * std::sin(angle);
    const double rim = i == kRatios - 1 ? 0.0 : way * std::cos(angle);
    shift += slide;
    turn += rim / radius;
    const reference::SlidingSpinning load = reference::hertz_limit_surface(slide, rim);
    result.path.push_back({pose_at(kPaperBallDepth, turn, shift), 8 * sphere.steps, Leg::kLoad,
                           angle, limit * load.force, limit * radius * load.moment});
  }
  result.connected = false;
  result.x = {PlotAxis::Quantity::kForce, "friction force (N)", 1.0};
  result.y = {PlotAxis::Quantity::kTorque, "friction torque (mN m)", 1e3};
  return result;
}

}  // namespace

std::vector<ReferenceCase> exact_cases(bool quick) {
  std::vector<ReferenceCase> cases;
  cases.push_back(twist_case(quick));
  cases.push_back(shear_case(quick));
  cases.push_back(slide_and_spin_case(quick));
  cases.push_back(rolling_case(quick));
  return cases;
}

}  // namespace torsion::engine
