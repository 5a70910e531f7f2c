#include "app/view/exact_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "app/view/panel_style.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/limit_surface.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/reference/exact/masing.hpp"

namespace torsion::engine {
namespace {

/// First loading of any sphere's contact: the couple over mu F a, by the turn over mu F / (G a^2).
/// A table, since a curve is drawn anew for every picture.
class FirstLoading {
 public:
  FirstLoading() {
    const reference::LubkinContact unit{reference::PressureShape::kHertz, 1.0, 1.0, 1.0, 1.0};
    for (std::size_t i = 0; i < couples_.size(); ++i) {
      couples_[i] = reference::torque(unit, turn_of(static_cast<double>(i)));
    }
  }

  [[nodiscard]] double operator()(double turn) const {
    const double at = std::sqrt(std::abs(turn) / kMost) * (kRows - 1.0);
    const auto row = std::min(static_cast<std::size_t>(at), couples_.size() - 2);
    const double low = turn_of(static_cast<double>(row));
    const double high = turn_of(static_cast<double>(row) + 1.0);
    const double share = std::min((std::abs(turn) - low) / (high - low), 1.0);
    return std::copysign(std::lerp(couples_[row], couples_[row + 1], share), turn);
  }

 private:
  static constexpr double kRows = 257.0;
  static constexpr double kMost = 3.0;  // there the couple is all but saturated

  static double turn_of(double row) {
    const double share = row / (kRows - 1.0);
    return kMost * share * share;
  }

  std::array<double, 257> couples_{};
};

/// The newest contact of a generation: its first point, and one past its last.
Range newest_contact(const History& history, std::uint64_t generation) {
  auto end = static_cast<std::uint32_t>(history.size());
  while (end > 0 && (history[end - 1].generation != generation || history[end - 1].region == 0)) {
    --end;
  }
  std::uint32_t first = end;
  while (first > 0 && history[first - 1].generation == generation &&
         history[first - 1].region == history[end - 1].region) {
    --first;
  }
  return {first, end - first};
}

}  // namespace

double exact_radius(const ExactContact& contact, double force) {
  constexpr double kWidest = 0.999;  // of the sphere's radius
  double low = 0.0;
  double high = kWidest * contact.sphere_radius;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    const double at =
        reference::sneddon_sphere_at_radius(contact.sphere_radius, contact.modulus, middle).force;
    (at < force ? low : high) = middle;
  }
  return low;
}

std::optional<ExactContact> exact_contact(const SceneDescription& scene, const Model& model,
                                          std::uint32_t tool) {
  const std::vector<PartDescription>& parts = scene.tools[tool].parts;
  if (parts.size() != 1 || parts[0].shape.kind != ShapeKind::kSphere || model.bodies.empty()) {
    return std::nullopt;
  }
  const auto& elasticity = model.bodies.at<Elasticity>(0);
  const auto& friction = model.bodies.at<Friction>(0);
  for (std::uint32_t body = 0; body < model.bodies.size(); ++body) {
    const auto& other = model.bodies.at<Elasticity>(body);
    const auto& its = model.bodies.at<Friction>(body);
    const bool same = other.youngs_modulus == elasticity.youngs_modulus &&
                      other.poisson_ratio == elasticity.poisson_ratio &&
                      its.dynamic_friction == friction.dynamic_friction;
    if (!same || its.static_friction != its.dynamic_friction) {
      return std::nullopt;
    }
  }
  if (friction.dynamic_friction <= 0.0) {
    return std::nullopt;
  }
  const double poisson = elasticity.poisson_ratio;
  return ExactContact{parts[0].shape.half_extent.x,
                      elasticity.youngs_modulus / (1.0 - poisson * poisson),
                      elasticity.youngs_modulus / (2.0 * (1.0 + elasticity.poisson_ratio)),
                      friction.dynamic_friction};
}

Curve exact_over_turn(const History& history, std::uint64_t generation,
                      const ExactContact& contact) {
  constexpr double kSteady = 0.03;    // of the force
  constexpr double kSideways = 0.05;  // of mu F
  constexpr double kUnturned = 0.01;  // of mu F / (G a^2): what a turn does to the couple before
  static const FirstLoading kFirstLoading;
  Curve curve{"exact", kLightCurve, {}, {}, true};
  const Range points = newest_contact(history, generation);
  reference::MasingHistory path;
  double force = 0.0;
  double turn_unit = 1.0;    // rad
  double couple_unit = 1.0;  // N m
  for (std::uint32_t i = points.first; i < points.first + points.count; ++i) {
    const PlotPoint& point = history[i];
    const bool unturned = curve.x.empty();
    if (unturned && point.normal_force != force && point.normal_force > 0.0) {
      force = point.normal_force;
      const double radius = exact_radius(contact, force);
      turn_unit = contact.friction * force / (contact.shear_modulus * radius * radius);
      couple_unit = contact.friction * force * radius;
    }
    if (!(force > 0.0)) {
      continue;
    }
    if (std::abs(point.normal_force - force) > kSteady * force ||
        point.friction_force > kSideways * contact.friction * force) {
      break;
    }
    const double turn = point.turn / turn_unit;
    if (unturned && i == points.first && std::abs(turn) > kUnturned) {
      break;  // the contact's beginning is no longer there
    }
    if (unturned && std::abs(turn) < kUnturned) {
      continue;
    }
    curve.x.push_back(point.turn * 180.0 / std::numbers::pi);
    // A tool is turned against.
    curve.y.push_back(-couple_unit * reference::move_to(path, kFirstLoading, turn));
  }
  return curve;
}

Curve exact_limit(double normal_force, const ExactContact& contact) {
  constexpr int kCurvePoints = 40;
  const double force = contact.friction * normal_force;
  const double radius = exact_radius(contact, normal_force);
  Curve curve{"exact", kLightCurve, {}, {}, true};
  for (int i = 0; i <= kCurvePoints; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / kCurvePoints;
    const reference::SlidingSpinning load =
        reference::hertz_limit_surface(std::sin(angle), std::cos(angle));
    curve.x.push_back(force * load.force);
    curve.y.push_back(force * radius * load.moment);
  }
  return curve;
}

}  // namespace torsion::engine
