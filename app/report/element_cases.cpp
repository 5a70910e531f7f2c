#include "app/report/element_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "app/report/element_curve.hpp"
#include "app/report/element_scenes.hpp"

namespace torsion::engine {
namespace {

constexpr double kFieldReach = 8.0;  // contact radii
constexpr int kFieldPoints = 80;

std::string reference_text(const ElementCurve& curve) {
  const std::string error =
      curve.force_error && curve.torque_error
          ? fmt::format(
                "Between this mesh and the next coarser one the force differs by "
                "{:.2g}\u00a0%, the torque by {:.2g}\u00a0% of the largest value.",
                100.0 * *curve.force_error, 100.0 * *curve.torque_error)
          : "This is the only mesh: its own error is not known.";
  return fmt::format(
      "Finite elements (GetFEM) with Coulomb friction and history, {} quadratic ones to the radius "
      "of the contact or its shorter half axis. {}",
      curve.divisions, error);
}

std::string path_text(const ElementCurve& curve) {
  const auto by_turn = std::ranges::minmax(curve.rows, {}, &ElementCurve::Row::turn);
  return fmt::format(
      " It is pressed {:.4g} mm deep, turned to {:.3g} rad and back to \u2212{:.3g} rad.",
      1e3 * curve.rows.back().depth, by_turn.max.turn, -by_turn.min.turn);
}

/// What moves the tool in the finite element path: depth below the first touch and turn.
std::vector<PathPoint> path_of(const ElementCurve& curve, const Pose& touching, int steps) {
  std::vector<PathPoint> path;
  Leg leg = Leg::kApproach;
  for (const ElementCurve::Row& row : curve.rows) {
    const double before = path.empty() ? 0.0 : path.back().abscissa;
    if (row.turn != before) {
      const bool forth = row.turn > before;
      leg = leg == Leg::kApproach || (forth && leg == Leg::kLoad) ? Leg::kLoad
            : forth                                               ? Leg::kReload
                                                                  : Leg::kUnload;
    }
    PathPoint point;
    const double depth = path.empty() ? -kStartClearance : row.depth;
    point.tool = {touching.position - glm::dvec3(0.0, depth, 0.0),
                  glm::angleAxis(row.turn, glm::dvec3(0.0, 1.0, 0.0))};
    point.steps = path.empty() ? 1 : steps;
    point.leg = leg;
    point.abscissa = row.turn;
    point.force = row.force;
    point.torque = row.torque;
    path.push_back(point);
  }
  return path;
}

ReferenceField field_of(const ElementCurve& curve) {
  ReferenceField field;
  const auto most = std::ranges::max_element(curve.rows, {}, &ElementCurve::Row::turn);
  field.point = static_cast<std::size_t>(most - curve.rows.begin());
  field.tool_turn = most->turn;
  field.contact_radius = most->contact_radius;
  const double reach = std::min(kFieldReach * most->contact_radius, curve.field.back().radius);
  for (int i = 1; i <= kFieldPoints; ++i) {
    field.radii.push_back(reach * i / kFieldPoints);
    field.twists.push_back(field_twist(curve, field.radii.back()));
  }
  return field;
}

}  // namespace

std::vector<ReferenceCase> element_cases(bool quick) {
  std::vector<ReferenceCase> cases;
  for (const ElementScene& element_scene : element_scenes()) {
    const std::vector<std::string_view> names = element_case_names();
    if (std::ranges::find(names, element_scene.name) == names.end()) {
      continue;
    }
    const ElementCurve curve = finest_curve(element_scene.name);
    ReferenceCase one;
    one.name = element_scene.name;
    one.title = element_scene.title;
    one.description = element_scene.description + path_text(curve);
    one.reference = reference_text(curve);
    one.force_meaning = "normal force";
    one.torque_meaning = "torque about the axis of the turn";
    one.scene = element_scene.scene;
    one.finite_body = element_scene.finite_body;
    one.path = path_of(curve, element_scene.touching, quick ? 8 : 40);
    one.x = {PlotAxis::Quantity::kAbscissa, "turn of the tool (mrad)", 1e3};
    const bool large = std::ranges::max(curve.rows, {}, &ElementCurve::Row::torque).torque > 1.0;
    one.y = {PlotAxis::Quantity::kTorque, large ? "torque (N m)" : "torque (mN m)",
             large ? 1.0 : 1e3};
    if (element_scene.flat_top && !curve.field.empty()) {
      one.field = field_of(curve);
    }
    cases.push_back(std::move(one));
  }
  return cases;
}

}  // namespace torsion::engine
