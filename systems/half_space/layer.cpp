#include "systems/half_space/layer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <glm/geometric.hpp>

#include "ecs/assert.hpp"
#include "systems/half_space/influence.hpp"

namespace torsion::engine {
namespace {

constexpr double kWide = 4.0;  // a body at least so many times as wide as thick is a layer

/// @param thickness  m, along the fixed face's normal
bool is_wide(const Model& model, std::uint32_t body, double thickness) {
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const glm::dvec3 along = glm::abs(fixed.normal);
  const glm::dvec3 across = (bounds.highest - bounds.lowest) * (1.0 - along);
  // Along two of the axes: the third one is nearest to the normal.
  const double steepest = std::max({along.x, along.y, along.z});
  double width = 1e300;
  bool seen = false;
  for (int axis = 0; axis < 3; ++axis) {
    if (along[axis] == steepest && !seen) {
      seen = true;
    } else {
      width = std::min(width, across[axis]);
    }
  }
  return width > kWide * thickness;
}

}  // namespace

bool is_layer(const Model& model, std::uint32_t body) {
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const double thickness = glm::dot(bounds.highest - bounds.lowest, glm::abs(fixed.normal));
  return fixed.kind == FixedKind::kFace && is_wide(model, body, thickness);
}

double layer_thickness(const Model& model, std::uint32_t body, const glm::dvec3& normal,
                       const glm::dvec3& point) {
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
  if (fixed.kind != FixedKind::kFace || glm::dot(fixed.normal, normal) < 0.9) {
    return 0.0;
  }
  const double thickness = glm::dot(point - fixed.point, fixed.normal);
  return thickness > 0.0 && is_wide(model, body, thickness) ? thickness : 0.0;
}

namespace {

/// Above this wave number a layer differs from a half-space by u^2 exp(-2u) < 1e-18.
constexpr double kLargestWave = 25.0;
/// The waves turn by kLargestWave kLayerReach = 300 rad up to the far end: more than four nodes a
/// turn.
constexpr int kWaves = 220;

struct Nodes {
  std::vector<double> places;
  std::vector<double> weights;
};

/// Nodes and weights of Gauss and Legendre on [0, end], by Newton's method on the three-term
/// recurrence.
Nodes gauss_legendre(int count, double end) {
  Nodes nodes;
  for (int i = 0; i < count; ++i) {
    double x = -std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
    double slope = 1.0;
    for (int iteration = 0; iteration < 8; ++iteration) {
      double before = 1.0;
      double value = x;
      for (int n = 2; n <= count; ++n) {
        const double next = ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n;
        before = value;
        value = next;
      }
      slope = count * (x * value - before) / (x * x - 1.0);
      x -= value / slope;
    }
    nodes.places.push_back(0.5 * end * (1.0 + x));
    nodes.weights.push_back(end / ((1.0 - x * x) * slope * slope));
  }
  return nodes;
}

/// Bessel's function J_2 from J_0 and J_1.
double bessel_2(double x) {
  return x < 1e-2 ? x * x / 8.0 * (1.0 - x * x / 12.0) : 2.0 / x * ::j1(x) - ::j0(x);
}

/// The four transforms at one distance: of the normal displacement (J0), of half the sum of those
/// along and across (J0), of half their difference (J2), and of the mixed one (J1).
struct Transforms {
  double sinking = 0.0;
  double mean = 0.0;
  double difference = 0.0;
  double mixed = 0.0;
};

/// Minus the half-space's own transforms, for distances where the layer hardly moves: all Bessel
/// functions integrate to 1.
Transforms still(double poisson_ratio, double distance) {
  return {-(1.0 - poisson_ratio) / distance, -(1.0 - 0.5 * poisson_ratio) / distance,
          0.5 * poisson_ratio / distance, -0.5 * (1.0 - 2.0 * poisson_ratio) / distance};
}

Transforms between(std::span<const double> kernel, double distance) {
  const double place = distance * (static_cast<double>(kLayerSteps) / kLayerReach);
  const auto row = std::min(static_cast<std::size_t>(place), kLayerSteps - 1);
  const double part = place - static_cast<double>(row);
  const double* const low = &kernel[4 * row];
  const auto mix = [&](std::size_t k) {
    return low[k] + part * (low[4 + k] - low[k]);
  };
  return {mix(0), mix(1), mix(2), mix(3)};
}

}  // namespace

WaveCompliance layer_wave_compliance(double poisson_ratio, double u) {
  // Unknowns: a and beta of the part that decays from the surface, b and delta of the one that
  // decays from the base; lengths over 1 / k.
  const double kappa = 3.0 - 4.0 * poisson_ratio;
  const double fall = std::exp(-u);
  const double shear = 0.5 * (kappa + 1.0);
  Eigen::Matrix4d conditions;
  conditions.row(0) << 2.0 * poisson_ratio - 1.0, -2.0, (2.0 * poisson_ratio - 1.0) * fall,
      2.0 * fall;                                                // normal stress at the surface
  conditions.row(1) << -shear, -2.0, shear * fall, -2.0 * fall;  // shear stress there
  conditions.row(2) << 0.5 * (kappa - u) * fall, fall, 0.5 * (kappa + u), -1.0;  // along, at base
  conditions.row(3) << -0.5 * u * fall, fall, -0.5 * u, 1.0;                     // down, at base
  Eigen::Matrix<double, 4, 2> loads = Eigen::Matrix<double, 4, 2>::Zero();
  loads(0, 0) = -1.0;  // pressure
  loads(1, 1) = -1.0;  // traction along
  const Eigen::Matrix<double, 4, 2> found = conditions.fullPivLu().solve(loads);
  const auto down = [&](int load) {
    return found(1, load) + found(3, load) * fall;
  };
  const auto along = [&](int load) {
    return found(1, load) + 0.5 * kappa * found(0, load) +
           (0.5 * kappa * found(2, load) - found(3, load)) * fall;
  };
  return {down(0) - (1.0 - poisson_ratio), along(1) - (1.0 - poisson_ratio), std::tanh(u) - 1.0,
          -along(0) - 0.5 * (1.0 - 2.0 * poisson_ratio)};
}

void fill_layer_kernel(double poisson_ratio, std::span<double> kernel) {
  TORSION_ASSERT(kernel.size() == kLayerKernelSize);
  const Nodes waves = gauss_legendre(kWaves, kLargestWave);
  std::vector<WaveCompliance> compliances;
  for (const double u : waves.places) {
    compliances.push_back(layer_wave_compliance(poisson_ratio, u));
  }
  for (std::size_t row = 0; row <= kLayerSteps; ++row) {
    const double distance =
        kLayerReach * static_cast<double>(row) / static_cast<double>(kLayerSteps);
    Transforms sum;
    for (std::size_t i = 0; i < compliances.size(); ++i) {
      const double phase = waves.places[i] * distance;
      const double weight = waves.weights[i];
      const WaveCompliance& at = compliances[i];
      sum.sinking += weight * at.sinking * ::j0(phase);
      sum.mean += weight * 0.5 * (at.along + at.across) * ::j0(phase);
      sum.difference += weight * 0.5 * (at.along - at.across) * bessel_2(phase);
      sum.mixed += weight * at.mixed * ::j1(phase);
    }
    kernel[4 * row] = sum.sinking;
    kernel[4 * row + 1] = sum.mean;
    kernel[4 * row + 2] = sum.difference;
    kernel[4 * row + 3] = sum.mixed;
  }
}

LayerResponse layer_response(std::span<const double> kernel, double poisson_ratio,
                             const glm::dvec2& offset) {
  const double distance = glm::length(offset);
  const Transforms at =
      distance < kLayerReach ? between(kernel, distance) : still(poisson_ratio, distance);
  const glm::dvec2 way = distance > 0.0 ? offset / distance : glm::dvec2(0.0);
  const double cosine = way.x * way.x - way.y * way.y;  // of twice the angle
  const double sine = 2.0 * way.x * way.y;
  constexpr double kShare = 0.5 / std::numbers::pi;
  return {kShare * at.sinking,
          kShare * (at.mean - cosine * at.difference),
          kShare * -sine * at.difference,
          kShare * (at.mean + cosine * at.difference),
          kShare * way.x * at.mixed,
          kShare * way.y * at.mixed};
}

namespace {

/// Mean over a cell at `offset` from a force, in the order of InfluenceKind.
std::array<double, kSolvedKinds> mean_response(std::span<const double> kernel, double poisson_ratio,
                                               const glm::dvec2& offset, const glm::dvec2& cell) {
  constexpr double kGauss = 0.28867513459481287;  // of the cell, from its centre
  std::array<double, kSolvedKinds> sum{};
  for (const double x : {-kGauss, kGauss}) {
    for (const double y : {-kGauss, kGauss}) {
      const LayerResponse at =
          layer_response(kernel, poisson_ratio, offset + cell * glm::dvec2(x, y));
      const std::array<double, kSolvedKinds> kinds{at.zz, at.xx, at.xy, at.yy, at.zx, at.zy};
      for (std::size_t kind = 0; kind < kSolvedKinds; ++kind) {
        sum[kind] += 0.25 * kinds[kind];
      }
    }
  }
  return sum;
}

}  // namespace

void fill_layer_influences(const InfluenceTables& half_space, std::span<const double> kernel,
                           double poisson_ratio, const glm::dvec2& cell, std::span<double> values) {
  const std::uint32_t side = half_space.side;
  TORSION_ASSERT(values.size() == layer_influence_count(side));
  const std::size_t width = half_space.width();
  const std::size_t table = values.size() / kInfluenceKinds;
  // Signs under x -> -x and y -> -y, in the order of InfluenceKind.
  constexpr std::array<double, kSolvedKinds> kOddInX{1.0, 1.0, -1.0, 1.0, -1.0, 1.0};
  constexpr std::array<double, kSolvedKinds> kOddInY{1.0, 1.0, -1.0, 1.0, 1.0, -1.0};
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const auto response = mean_response(kernel, poisson_ratio, cell * glm::dvec2(i, j), cell);
      for (std::size_t kind = 0; kind < kSolvedKinds; ++kind) {
        // The cell's area over its length along x leaves its width.
        const double value = response[kind] * cell.y;
        for (const bool left : {false, true}) {
          for (const bool below : {false, true}) {
            const std::size_t row = below ? side - 1 - j : side - 1 + j;
            const std::size_t column = left ? side - 1 - i : side - 1 + i;
            const std::size_t at = row * width + column;
            values[kind * table + at] =
                half_space.kinds[kind][at] +
                value * (left ? kOddInX[kind] : 1.0) * (below ? kOddInY[kind] : 1.0);
          }
        }
      }
    }
  }
  fill_differences(values);
}

InfluenceTables layer_influence_tables(std::span<const double> values, std::uint32_t side) {
  TORSION_ASSERT(values.size() == layer_influence_count(side));
  InfluenceTables tables;
  tables.side = side;
  for (std::size_t kind = 0; kind < kInfluenceKinds; ++kind) {
    tables.kinds[kind] = values.data() + kind * (values.size() / kInfluenceKinds);
  }
  return tables;
}

std::span<const double> layer_kernel(const Model& model, std::uint32_t body) {
  static_assert(sizeof(Influence) == sizeof(double));
  const auto rows = model.influences.rows<Influence>(model.bodies.at<OwnedRows>(body).layer_kernel);
  return {rows.empty() ? nullptr : &rows.front().value, rows.size()};
}

glm::dmat3 layer_coupling(const Model& model, std::uint32_t body, const glm::dvec3& normal,
                          const glm::dvec3& offset, double thickness) {
  const std::span<const double> kernel = layer_kernel(model, body);
  const Elasticity& elasticity = model.bodies.at<Elasticity>(body);
  const glm::dvec3 other =
      std::abs(normal.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 first = glm::normalize(glm::cross(normal, other));
  const glm::dvec3 second = glm::cross(normal, first);
  const glm::dvec2 along(glm::dot(first, offset), glm::dot(second, offset));
  const LayerResponse at = layer_response(kernel, elasticity.poisson_ratio, along / thickness);
  // In the kernel, z points into the layer. u_x by pressure is minus u_z by traction along x.
  const glm::dmat3 local(at.xx, at.xy, -at.zx, at.xy, at.yy, -at.zy, at.zx, at.zy, at.zz);
  const glm::dmat3 axes(first, second, normal);
  return axes * local * glm::transpose(axes) / (elasticity.shear_modulus() * thickness);
}

}  // namespace torsion::engine
