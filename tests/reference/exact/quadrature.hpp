#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace torsion::engine::reference {

/// Nodes and weights of a rule on an interval.
struct Quadrature {
  std::vector<double> nodes;
  std::vector<double> weights;
};

/// Gauss-Legendre rule of `count` >= 1 nodes on [start, end], nodes ascending: exact for
/// polynomials of degree 2 count - 1. Error of nodes and weights: a few 1e-16 of the interval.
/// Source: Newton's method on the three-term recurrence from Tricomi's first guess.
inline Quadrature gauss_legendre(std::size_t count, double start = -1.0, double end = 1.0) {
  Quadrature rule{std::vector<double>(count), std::vector<double>(count)};
  const double middle = 0.5 * (start + end);
  const double half = 0.5 * (end - start);
  const auto degree = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    double x = -std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (degree + 0.5));
    double slope = 1.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double before = 1.0;
      double value = x;
      for (std::size_t n = 2; n <= count; ++n) {
        const auto order = static_cast<double>(n);
        const double next = ((2.0 * order - 1.0) * x * value - (order - 1.0) * before) / order;
        before = value;
        value = next;
      }
      slope = degree * (x * value - before) / (x * x - 1.0);
      const double change = value / slope;
      x -= change;
      if (std::abs(change) < 1e-15) {
        break;
      }
    }
    rule.nodes[i] = middle + half * x;
    rule.weights[i] = half * 2.0 / ((1.0 - x * x) * slope * slope);
  }
  return rule;
}

/// The sum of weight times integrand over the rule; `integrand(x)`.
template <class Integrand>
double integrate(const Quadrature& rule, Integrand&& integrand) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    sum += rule.weights[i] * integrand(rule.nodes[i]);
  }
  return sum;
}

/// Double-exponential (tanh-sinh) quadrature of an integrand that is smooth inside [start, end] and
/// may have integrable singularities at the ends. `integrand(x, from_start, to_end)` gets its
/// distances to both ends to all digits, where x alone would cancel. Error: relative under 1e-13 of
/// the integral of |integrand| for algebraic and logarithmic ends (measured in the tests); the step
/// is halved until two sums agree to 1e-11. Source: Takahasi and Mori, Publ. RIMS 9 (1974) 721.
template <class Integrand>
double integrate_tanh_sinh(Integrand&& integrand, double start, double end) {
  const double length = end - start;
  if (length == 0.0) {
    return 0.0;
  }
  // x = middle + half tanh((pi/2) sinh t); from_start / length = 1 / (1 + exp(-pi sinh t)). At |t|
  // = kReach the distance to the end is 1e-274 of the length, so that even a 1/sqrt end leaves
  // nothing out.
  constexpr double kReach = 6.0;
  const auto term = [&](double t) {
    const double grow = std::exp(std::numbers::pi * std::sinh(t));
    const double from_start = grow >= 1.0 ? 1.0 / (1.0 + 1.0 / grow) : grow / (1.0 + grow);
    const double to_end = 1.0 / (1.0 + grow);
    const double weight = std::numbers::pi * std::cosh(t) * from_start * to_end;
    const double x = t < 0.0 ? start + length * from_start : end - length * to_end;
    return weight * integrand(x, length * from_start, length * to_end);
  };
  double step = 0.5;
  double sum = term(0.0);
  double size = std::abs(sum);
  const auto add = [&](double t) {
    for (const double value : {term(t), term(-t)}) {
      sum += value;
      size += std::abs(value);
    }
  };
  for (double t = step; t <= kReach; t += step) {
    add(t);
  }
  for (int level = 0; level < 8; ++level) {
    const double coarse = sum * step;
    step *= 0.5;
    for (double t = step; t <= kReach; t += 2.0 * step) {
      add(t);
    }
    // The error of this rule is squared by each halving: half the digits agreeing is all of them
    // right.
    if (std::abs(sum * step - coarse) <= 1e-11 * size * step) {
      break;
    }
  }
  return length * step * sum;
}

}  // namespace torsion::engine::reference
