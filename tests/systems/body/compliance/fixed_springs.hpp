#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tests/reference/exact/cattaneo_mindlin.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/reference/exact/quadrature.hpp"

namespace torsion::engine::test {

/// Springs of a half-space under a sphere, at fixed places, whose limits follow the depth: the
/// method of dimensionality reduction without resampling, for twist alone or sliding alone. Exact
/// for a normal force that is constant or grows (what is new starts without deflection); for one
/// that shrinks, rings that lose contact or slip are the model itself. Error: a few 1 / kCount of
/// the limit, where a spring's limit cuts the rule. Source: Popov & Hess, Method of Dimensionality
/// Reduction in Contact Mechanics and Friction, 2015; docs/models.md.
struct FixedSprings {
  static constexpr std::size_t kCount = 600;
  reference::Quadrature rule;
  std::vector<double> turns = std::vector<double>(kCount, 0.0);
  std::vector<double> slides = std::vector<double>(kCount, 0.0);
  double torque = 0.0;  // N m, along the turn
  double force = 0.0;   // N, along the slide

  /// @param largest_radius  of the contact, m
  explicit FixedSprings(double largest_radius)
      : rule(reference::gauss_legendre(kCount, 0.0, largest_radius)) {}

  /// Moves on under the present normal contact.
  void move(const reference::LubkinContact& twisted, const reference::CattaneoMindlin& pushed,
            double slide, double turn) {
    torque = 0.0;
    force = 0.0;
    const double a = twisted.radius;
    const double line_load = 0.75 * reference::full_slip_force(pushed) / a;  // at x = 0, N/m
    for (std::size_t i = 0; i < kCount; ++i) {
      const double x = rule.nodes[i];
      const bool touches = x < a;
      const double turn_limit = touches ? reference::slip_twist(twisted, x) : 0.0;
      const double slide_limit =
          touches ? line_load / pushed.tangential_modulus * (1.0 - x * x / (a * a)) : 0.0;
      turns[i] = std::clamp(turns[i] + turn, -turn_limit, turn_limit);
      slides[i] = std::clamp(slides[i] + slide, -slide_limit, slide_limit);
      torque += 16.0 * twisted.shear_modulus * rule.weights[i] * x * x * turns[i];
      force += 2.0 * pushed.tangential_modulus * rule.weights[i] * slides[i];
    }
  }
};

}  // namespace torsion::engine::test
