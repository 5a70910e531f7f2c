// The layer's kernel and a contact's tables on a layer, against exact solutions.

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/half_space/layer.hpp"
#include "systems/patch/solver.hpp"
#include "tests/reference/airy_layer.hpp"
#include "tests/reference/exact/layers.hpp"

namespace torsion::engine {
namespace {

std::vector<double> kernel_of(double poisson_ratio) {
  std::vector<double> kernel(kLayerKernelSize);
  fill_layer_kernel(poisson_ratio, kernel);
  return kernel;
}

/// The whole layer's compliance from its boundary conditions: along by traction along, and minus
/// along by pressure.
std::pair<double, double> along_and_mixed(double poisson_ratio, double u) {
  const reference::AiryRows base = reference::airy_rows(poisson_ratio, 0.0);
  const reference::AiryRows top = reference::airy_rows(poisson_ratio, u);
  Eigen::Matrix4d conditions;
  conditions << base.normal, base.sideways, top.slope, top.phi;
  const Eigen::FullPivLU<Eigen::Matrix4d> solver(conditions);
  const Eigen::Vector4d dragged = solver.solve(Eigen::Vector4d(0.0, 0.0, 1.0, 0.0));
  const Eigen::Vector4d pressed = solver.solve(Eigen::Vector4d(0.0, 0.0, 0.0, 1.0));
  return {0.5 * top.sideways.dot(dragged), -0.5 * top.sideways.dot(pressed)};
}

TEST(LayerKernelTest, WavesMeetTheExactLayer) {
  for (const double poisson_ratio : {0.0, 0.3, 0.5}) {
    for (const double u : {0.3, 1.0, 3.0, 8.0}) {
      const WaveCompliance beside = layer_wave_compliance(poisson_ratio, u);
      const double half_space = 1.0 - poisson_ratio;
      EXPECT_NEAR(
          (beside.sinking + half_space) / half_space,
          reference::layer_compliance_ratio(reference::LayerBase::kBonded, poisson_ratio, u),
          1e-12);
      const auto [along, mixed] = along_and_mixed(poisson_ratio, u);
      EXPECT_NEAR(beside.along + half_space, along, 1e-10);
      EXPECT_NEAR(beside.mixed + 0.5 * (1.0 - 2.0 * poisson_ratio), mixed, 1e-10);
      EXPECT_NEAR(beside.across + 1.0, std::tanh(u), 1e-15);
    }
  }
}

// At the middle J0 = 1: without J's oscillation the transform is a plain integral, by Simpson's
// rule here.
TEST(LayerKernelTest, MiddleIsTheIntegralOverAllWaves) {
  for (const double poisson_ratio : {0.0, 0.3, 0.5}) {
    double sum = 0.0;
    constexpr int kSteps = 4000;
    constexpr double kStep = 25.0 / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
      const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
      const double u = std::max(i * kStep, 1e-9);
      sum += weight * layer_wave_compliance(poisson_ratio, u).sinking * kStep / 3.0;
    }
    EXPECT_NEAR(layer_response(kernel_of(poisson_ratio), poisson_ratio, {0.0, 0.0}).zz,
                sum / (2.0 * std::numbers::pi), 1e-9);
  }
}

// Where the table ends the layer is taken as at rest: what it still moves is below a thousandth of
// what the half-space does there.
TEST(LayerKernelTest, LayerIsAtRestFarAway) {
  for (const double poisson_ratio : {0.0, 0.3, 0.5}) {
    const std::vector<double> kernel = kernel_of(poisson_ratio);
    const glm::dvec2 way(0.8, 0.6);
    const LayerResponse inside =
        layer_response(kernel, poisson_ratio, way * (kLayerReach * (1.0 - 1e-9)));
    const LayerResponse outside =
        layer_response(kernel, poisson_ratio, way * (kLayerReach * (1.0 + 1e-9)));
    const double bound = 1e-3 / (2.0 * std::numbers::pi * kLayerReach);
    EXPECT_NEAR(inside.zz, outside.zz, bound);
    EXPECT_NEAR(inside.xx, outside.xx, bound);
    EXPECT_NEAR(inside.xy, outside.xy, bound);
    EXPECT_NEAR(inside.yy, outside.yy, bound);
    EXPECT_NEAR(inside.zx, outside.zx, bound);
    EXPECT_NEAR(inside.zy, outside.zy, bound);
  }
}

/// Cells of one grid and the columns that they are solved in.
struct Grid {
  static constexpr std::uint32_t kSide = 20;
  std::vector<double> memory = std::vector<double>(11 * kSide * kSide, 0.0);
  PatchColumns columns;

  Grid() {
    std::size_t next = 0;
    for (std::span<double>* each :
         {&columns.depth, &columns.friction, &columns.target_x, &columns.target_y,
          &columns.pressure, &columns.traction_x, &columns.traction_y, &columns.depression,
          &columns.moved_x, &columns.moved_y, &columns.slips}) {
      *each = std::span(memory).subspan(next++ * kSide * kSide, kSide * kSide);
    }
  }
};

constexpr double kDisc = 0.8;  // of the grid's half side

/// Place of a cell's centre over the disc's radius.
glm::dvec2 place_of(std::uint32_t i, std::uint32_t j) {
  const glm::dvec2 cell(i, j);
  return ((cell + 0.5) * (2.0 / Grid::kSide) - 1.0) / kDisc;
}

struct DiscForces {
  double force = 0.0;
  double torque = 0.0;
};

/// A bonded disc is pressed by 1 and turned by 1 (G = 1, cells 1 long along x).
DiscForces press_and_turn(const InfluenceTables& tables) {
  Grid grid;
  for (std::uint32_t j = 0; j < Grid::kSide; ++j) {
    for (std::uint32_t i = 0; i < Grid::kSide; ++i) {
      const std::size_t cell = j * Grid::kSide + i;
      const glm::dvec2 place = place_of(i, j);
      const bool in_disc = glm::dot(place, place) < 1.0;
      grid.columns.depth[cell] = in_disc ? 1.0 : -1e30;
      grid.columns.friction[cell] = in_disc ? 1e6 : 0.0;
      grid.columns.target_x[cell] = -place.y;
      grid.columns.target_y[cell] = place.x;
    }
  }
  PatchProblem problem;
  problem.influences = tables;
  problem.compliance = 1.0;
  problem.coupled = false;  // as the exact solutions have it
  problem.reference = 0.05;
  problem.skip = 1e-7;
  problem.settled = 0.0;
  problem.iterations = 2000;
  PatchWork work;
  work.reserve(Grid::kSide);
  solve_patch(problem, grid.columns, work);
  DiscForces forces;
  for (std::uint32_t j = 0; j < Grid::kSide; ++j) {
    for (std::uint32_t i = 0; i < Grid::kSide; ++i) {
      const std::size_t cell = j * Grid::kSide + i;
      const glm::dvec2 place = place_of(i, j);
      forces.force += grid.columns.pressure[cell];
      forces.torque +=
          place.x * grid.columns.traction_y[cell] - place.y * grid.columns.traction_x[cell];
    }
  }
  return forces;
}

// Stiffness of a disc on a layer over that on a half-space. Both have the same cells, so what
// their steps at the rim do to each cancels but for parts of a per cent.
TEST(LayerInfluenceTest, DiscsOnLayersMeetTheIntegralEquations) {
  for (const double poisson_ratio : {0.3, 0.5}) {
    std::vector<double> half_space(influence_count(Grid::kSide));
    fill_influences(poisson_ratio, Grid::kSide, half_space);
    const InfluenceTables free = influence_tables(half_space, Grid::kSide, 0);
    const std::vector<double> kernel = kernel_of(poisson_ratio);
    const DiscForces endless = press_and_turn(free);
    for (const double thickness : {0.5, 1.0, 2.0}) {  // over the disc's radius
      std::vector<double> values(layer_influence_count(Grid::kSide));
      const double cell = 2.0 / (Grid::kSide * kDisc) / thickness;
      fill_layer_influences(free, kernel, poisson_ratio, {cell, cell}, values);
      const DiscForces bonded = press_and_turn(layer_influence_tables(values, Grid::kSide));
      const double torsion = reference::layer_torsion_ratio(thickness);
      EXPECT_NEAR(bonded.torque / endless.torque / torsion, 1.0, 0.01) << thickness;
      // A punch's stiffness, over 2 E* a.
      const reference::Layer layer{reference::LayerBase::kBonded, thickness, poisson_ratio, 1.0};
      const double punch = reference::layer_sphere_at_radius(layer, 100.0, 1.0).stiffness / 2.0;
      EXPECT_NEAR(bonded.force / endless.force / punch, 1.0, 0.015) << thickness;
    }
  }
}

}  // namespace
}  // namespace torsion::engine
