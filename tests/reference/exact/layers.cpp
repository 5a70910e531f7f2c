#include "tests/reference/exact/layers.hpp"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Dense>

#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/quadrature.hpp"

namespace torsion::engine::reference {

namespace {

using std::numbers::pi;

/// Beyond k h = 25 what distinguishes a layer from a half-space, of order u^2 exp(-2 u), is under
/// 1e-18.
constexpr double kLargestWave = 25.0;

/// 1 - L(u), every term positive.
double compliance_lack(LayerBase base, double poisson, double u) {
  const double shrink = std::exp(-2.0 * u);
  if (base == LayerBase::kFrictionless) {
    return 2.0 * shrink * (2.0 * u - std::expm1(-2.0 * u)) /
           (-std::expm1(-4.0 * u) + 4.0 * u * shrink);
  }
  const double kappa = 3.0 - 4.0 * poisson;
  const double square = 1.0 + kappa * kappa + 4.0 * u * u;
  return shrink * (square + 4.0 * u + 2.0 * kappa * shrink) /
         (kappa * (1.0 + shrink * shrink) + square * shrink);
}

/// The equation chi(x) - (2/pi) int_0^1 chi(s) [int_0^inf lack(k h) w(k s) w(k x) dk] ds = g(x) on
/// the unit interval, w the cosine or the sine, as a matrix on Gauss-Legendre nodes.
struct Fredholm {
  Quadrature places;
  Eigen::VectorXd weights;     // of the places
  Eigen::MatrixXd waves;       // w(k x), a row per place
  Eigen::VectorXd rim_waves;   // w(k)
  Eigen::VectorXd wave_power;  // (2/pi) lack(k h) dk
  Eigen::PartialPivLU<Eigen::MatrixXd> solver;
};

/// @param thickness h over the radius of the disc
template <class Lack, class Wave>
Fredholm make_fredholm(double thickness, Lack&& lack, Wave&& wave) {
  // The kernel is as wide as the layer is thick, the waves turn kLargestWave / thickness times a
  // radian over the disc: a few nodes for each, and some for the smooth rest.
  const auto place_count = static_cast<std::size_t>(40.0 + 10.0 / thickness);
  const auto wave_count = static_cast<std::size_t>(100.0 + 30.0 / thickness);
  Fredholm equation;
  equation.places = gauss_legendre(place_count, 0.0, 1.0);
  const Quadrature numbers = gauss_legendre(wave_count, 0.0, kLargestWave);
  const auto rows = static_cast<Eigen::Index>(place_count);
  const auto columns = static_cast<Eigen::Index>(wave_count);
  equation.weights = Eigen::Map<const Eigen::VectorXd>(equation.places.weights.data(), rows);
  equation.waves.resize(rows, columns);
  equation.rim_waves.resize(columns);
  equation.wave_power.resize(columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    const double u = numbers.nodes[static_cast<std::size_t>(j)];
    const double k = u / thickness;
    equation.wave_power[j] =
        2.0 / pi * lack(u) * numbers.weights[static_cast<std::size_t>(j)] / thickness;
    equation.rim_waves[j] = wave(k);
    for (Eigen::Index i = 0; i < rows; ++i) {
      equation.waves(i, j) = wave(k * equation.places.nodes[static_cast<std::size_t>(i)]);
    }
  }
  const Eigen::MatrixXd kernel =
      equation.waves * equation.wave_power.asDiagonal() * equation.waves.transpose();
  equation.solver.compute(Eigen::MatrixXd::Identity(rows, rows) -
                          kernel * equation.weights.asDiagonal());
  return equation;
}

/// chi at the rim x = 1, where g has the value `rim`, by the equation itself.
double rim_value(const Fredholm& equation, const Eigen::VectorXd& chi, double rim) {
  const Eigen::VectorXd transform = equation.waves.transpose() * equation.weights.cwiseProduct(chi);
  return rim + equation.rim_waves.dot(equation.wave_power.cwiseProduct(transform));
}

}  // namespace

double layer_torsion_ratio(double thickness_over_radius) {
  assert(thickness_over_radius > 0.0);
  // 1 - tanh(u) = 2 / (exp(2 u) + 1).
  const Fredholm equation = make_fredholm(
      thickness_over_radius, [](double u) { return 2.0 / (std::exp(2.0 * u) + 1.0); },
      [](double phase) { return std::sin(phase); });
  const Eigen::Map<const Eigen::VectorXd> x(equation.places.nodes.data(), equation.weights.size());
  const Eigen::VectorXd chi = equation.solver.solve(x);
  // T = 16 G a^3 int_0^1 x chi dx for a unit twist, against 16/3 G a^3.
  return 3.0 * equation.weights.dot(x.cwiseProduct(chi));
}

double layer_compliance_ratio(LayerBase base, double poisson, double u) {
  assert(u > 0.0);
  return 1.0 - compliance_lack(base, poisson, u);
}

LayerContact layer_sphere_at_radius(const Layer& layer, double sphere_radius, double radius) {
  assert(layer.thickness > 0.0 && sphere_radius > 0.0 && radius > 0.0);
  const Fredholm equation = make_fredholm(
      layer.thickness / radius,
      [&](double u) { return compliance_lack(layer.base, layer.poisson, u); },
      [](double phase) { return std::cos(phase); });
  const Eigen::Map<const Eigen::VectorXd> x(equation.places.nodes.data(), equation.weights.size());
  // chi = depth flat - (a^2/R) curved, and it vanishes at the rim, where the pressure must not be
  // infinite.
  const Eigen::VectorXd flat = equation.solver.solve(Eigen::VectorXd::Ones(x.size()));
  const Eigen::VectorXd curved = equation.solver.solve(x.cwiseAbs2().eval());
  const double drop = radius * radius / sphere_radius;
  const double depth = drop * rim_value(equation, curved, 1.0) / rim_value(equation, flat, 1.0);
  const double scale = 2.0 * layer.modulus * radius;
  const double force = scale * equation.weights.dot(depth * flat - drop * curved);
  return {.radius = radius,
          .depth = depth,
          .force = force,
          .hertz_ratio = force / hertz_sphere_at_depth(sphere_radius, layer.modulus, depth).force,
          .stiffness = scale * equation.weights.dot(flat)};
}

LayerContact layer_sphere_at_depth(const Layer& layer, double sphere_radius, double depth) {
  assert(depth > 0.0);
  // In logarithms the depth is nearly a straight line of the radius. Between a half-space, a^2 = R
  // depth, and the sphere's own section of an incompressible film, a^2 < 4 R depth.
  double low = 0.5 * std::log(sphere_radius * depth) - 0.1;
  double high = low + 1.0;
  const auto excess = [&](double log_radius) {
    return std::log(layer_sphere_at_radius(layer, sphere_radius, std::exp(log_radius)).depth /
                    depth);
  };
  double low_value = excess(low);
  double high_value = excess(high);
  // Regula falsi in the Illinois form: the value of an end that stays is halved.
  double middle = low;
  for (int iteration = 0; iteration < 60 && high - low > 1e-13; ++iteration) {
    const double next = (low * high_value - high * low_value) / (high_value - low_value);
    const double value = excess(next);
    const bool settled = std::abs(next - middle) < 1e-13;
    middle = next;
    if (settled || value == 0.0) {
      break;
    }
    const bool is_low = (value < 0.0) == (low_value < 0.0);
    (is_low ? low : high) = next;
    (is_low ? low_value : high_value) = value;
    (is_low ? high_value : low_value) *= 0.5;
  }
  return layer_sphere_at_radius(layer, sphere_radius, std::exp(middle));
}

}  // namespace torsion::engine::reference
