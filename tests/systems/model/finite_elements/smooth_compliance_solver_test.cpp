// The parts under the smooth compliance: grid, element, factor, loads.

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Core>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "systems/model/finite_elements/loads.hpp"
#include "systems/model/finite_elements/solver.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/systems/model/finite_elements/elastic_solids.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

/// A cell whose corners are moved by up to a sixth of its sides.
std::array<glm::dvec3, 8> crooked_cell() {
  std::array<glm::dvec3, 8> corners{};
  for (std::uint32_t c = 0; c < 8; ++c) {
    const glm::dvec3 shift(std::sin(7.0 * c), std::sin(3.0 * c + 1.0), std::cos(5.0 * c));
    corners[c] = glm::dvec3(c & 1U, 1.5 * (c >> 1U & 1U), 0.8 * (c >> 2U)) + shift / 6.0;
  }
  return corners;
}

TEST(ElementStiffnessTest, ResistsAllButRigidMotions) {
  for (const double bulk : {2.0 / 3.0, 1e4}) {
    const ElementStiffness stiffness = element_stiffness(crooked_cell(), bulk);
    EXPECT_LT((stiffness - stiffness.transpose()).norm(), 1e-12 * stiffness.norm());
    const Eigen::VectorXd values = test::eigenvalues(stiffness);
    EXPECT_LT(std::abs(values[5]), 1e-11 * values[23]);
    EXPECT_GT(values[6], 1e-2);  // of the shear modulus times a side of 1 m
  }
}

TEST(ElementStiffnessTest, CrookedElementHoldsConstantStrainExactly) {
  // Patch test: the energy of a linear displacement is that of its constant strain.
  const std::array<glm::dvec3, 8> corners = crooked_cell();
  const glm::dmat3 gradient(0.1, 0.3, -0.2, 0.4, -0.25, 0.15, 0.05, 0.6, 0.35);
  Eigen::Matrix<double, 24, 1> motion;
  for (std::uint32_t c = 0; c < 8; ++c) {
    const glm::dvec3 u = gradient * corners[c];
    motion.segment<3>(3 * Eigen::Index{c}) << u.x, u.y, u.z;
  }
  double volume = 0.0;
  for (std::uint32_t c = 0; c < 8; ++c) {
    const double g = 1.0 / std::sqrt(3.0);
    volume += glm::determinant(
        element_jacobian(corners, {c & 1U ? g : -g, c & 2U ? g : -g, c & 4U ? g : -g}));
  }
  const glm::dmat3 strain = 0.5 * (gradient + glm::transpose(gradient));
  const double trace = strain[0][0] + strain[1][1] + strain[2][2];
  double squares = 0.0;
  for (int k = 0; k < 3; ++k) {
    squares += glm::dot(strain[k], strain[k]);
  }
  const double bulk = 5.0;
  const double energy = volume * (2.0 * squares + (bulk - 2.0 / 3.0) * trace * trace);
  EXPECT_NEAR(motion.dot(element_stiffness(corners, bulk) * motion), energy, 1e-12 * energy);
}

TEST(ElementStiffnessTest, OneElementBendsExactlyEvenWhenIncompressible) {
  // u = (x z, -nu y z, (nu (y^2 - z^2) - x^2)/2) has the curvature 1 and the stress E z along x;
  // its second moment over a 2 m cube is I = 4/3, and the energy E I L = 8/3 E.
  std::array<glm::dvec3, 8> corners{};
  Eigen::Matrix<double, 24, 1> motion;
  for (const double poisson_ratio : {0.0, 0.3, 0.4999}) {
    for (std::uint32_t c = 0; c < 8; ++c) {
      corners[c] = 2.0 * glm::dvec3(c & 1U, c >> 1U & 1U, c >> 2U) - glm::dvec3(1.0);
      const glm::dvec3& p = corners[c];
      // at the corners the squares are all 1
      motion.segment<3>(3 * Eigen::Index{c}) << p.x * p.z, -poisson_ratio * p.y * p.z, 0.0;
    }
    const double youngs_modulus = 2.0 * (1.0 + poisson_ratio);
    const double bulk = youngs_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio));
    EXPECT_NEAR(motion.dot(element_stiffness(corners, bulk) * motion) / youngs_modulus, 8.0 / 3.0,
                1e-6);
  }
}

TEST(SolidGridTest, BlocksAreFilledExactlyAndRoundBarsToTheirPolygon) {
  const auto block = build_solid_grid(block_solid({1.0, 0.7, 0.9}, 0.3), 10);
  const auto bar = build_solid_grid(round_bar(0.5, 1.0, 0.3), 16);
  ASSERT_TRUE(block && bar);
  const auto volume = [](const SolidGrid& grid) {
    double sum = 0.0;
    for (const std::array<std::uint32_t, 4>& face : grid.faces) {  // by the divergence theorem
      const glm::dvec3& a = grid.nodes[face[0]];
      const glm::dvec3& c = grid.nodes[face[2]];
      sum += glm::dot(a + grid.nodes[face[1]] + c + grid.nodes[face[3]],
                      glm::cross(c - a, grid.nodes[face[3]] - grid.nodes[face[1]])) /
             24.0;
    }
    return sum;
  };
  EXPECT_NEAR(volume(block.value()), 0.63, 1e-12);
  EXPECT_NEAR(volume(bar.value()) / (0.25 * pi), 1.0, 0.005);
  const ElasticSolid solid = round_bar(0.5, 1.0, 0.3);
  for (const std::array<std::uint32_t, 4>& face : bar.value().faces) {
    for (const std::uint32_t node : face) {
      EXPECT_NEAR(solid.signed_distance(bar.value().nodes[node]).value, 0.0, 1e-6);
    }
  }
}

TEST(SolidGridTest, ElementsOfSmoothBodiesKeepTheirShape) {
  const ElasticSolid solid = ball_solid(0.5, 0.3);
  for (const std::uint32_t elements : {8U, 12U, 16U, 24U}) {
    const auto built = build_solid_grid(solid, elements);
    ASSERT_TRUE(built.ok());
    const SolidGrid& grid = built.value();
    const double cell = grid.spacing.x * grid.spacing.y * grid.spacing.z;
    for (std::size_t e = 0; e < grid.elements.size(); ++e) {
      EXPECT_GT(8.0 * glm::determinant(element_jacobian(element_corners(grid, e), {})), 0.1 * cell);
    }
    for (const std::array<std::uint32_t, 4>& face : grid.faces) {
      EXPECT_NEAR(solid.signed_distance(grid.nodes[face[0]]).value, 0.0, 1e-6);
    }
  }
}

TEST(StiffnessFactorTest, SolvesWhatADenseFactorSolves) {
  const auto built = build_solid_grid(round_bar(0.5, 1.0, 0.3), 8);
  ASSERT_TRUE(built.ok());
  const SolidGrid& grid = built.value();
  const auto stiffness = [&](std::size_t e) {
    return element_stiffness(element_corners(grid, e), 10.0);
  };
  const auto factor = factor_stiffness(grid, stiffness, {});
  ASSERT_TRUE(factor.ok());
  const std::vector<std::uint32_t>& order = factor.value().order;
  const Eigen::Index size = 3 * Eigen::Index{factor.value().free_nodes};
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t e = 0; e < grid.elements.size(); ++e) {
    const ElementStiffness part = stiffness(e);
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t j = 0; j < 8; ++j) {
        const std::uint32_t row = order[grid.elements[e][i]];
        const std::uint32_t column = order[grid.elements[e][j]];
        if (row != kNoRow && column != kNoRow) {
          dense.block<3, 3>(3 * Eigen::Index{row}, 3 * Eigen::Index{column}) +=
              part.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j));
        }
      }
    }
  }
  NodeColumns columns(size, 2);
  for (Eigen::Index row = 0; row < size; ++row) {
    columns.row(row) << std::sin(3.0 * static_cast<double>(row)),
        std::cos(static_cast<double>(row * row));
  }
  const Eigen::MatrixXd expected = test::solve_definite(dense, columns);
  solve_stiffness(factor.value(), columns);
  EXPECT_LT((columns - expected).norm(), 1e-10 * expected.norm());
}

TEST(PortLoadsTest, LoadsAndTheClampsTractionsBalanceTheWrench) {
  // All of the half-space's tractions on the body's surface balance the wrench at the port, so the
  // loads, clamp included, sum up to it: on a block, and on a ball, where some are put in its
  // place.
  const Elasticity elasticity{2.6, 0.3, 1000.0};
  const Port on_ball{0.5 * glm::normalize(glm::dvec3(0.3, 0.5, 0.8)),
                     glm::normalize(glm::dvec3(0.3, 0.5, 0.8))};
  const Port on_block{glm::dvec3(0.2, 0.1, 1.0), glm::dvec3(0.0, 0.0, 1.0)};
  for (const bool ball : {false, true}) {
    const ElasticSolid solid = ball ? ball_solid(0.5, 0.3) : block_solid({1.0, 1.0, 1.0}, 0.3);
    const Port& port = ball ? on_ball : on_block;
    const auto grid = build_solid_grid(solid, 12);
    ASSERT_TRUE(grid.ok());
    const PortLoads loads = loads_of_port(grid.value(), elasticity, port, 1.0, 6);
    Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
    for (std::size_t node = 0; node < grid.value().nodes.size(); ++node) {
      const auto row = 3 * static_cast<Eigen::Index>(node);
      const glm::dvec3 arm = grid.value().nodes[node] - port.position;
      for (int column = 0; column < 6; ++column) {
        const glm::dvec3 force(loads.forces(row, column), loads.forces(row + 1, column),
                               loads.forces(row + 2, column));
        const glm::dvec3 torque = glm::cross(arm, force);
        for (int axis = 0; axis < 3; ++axis) {
          sum(axis, column) += force[axis];
          sum(3 + axis, column) += torque[axis];
        }
      }
    }
    EXPECT_LT((sum - Eigen::Matrix<double, 6, 6>::Identity()).norm(), 1e-9);
  }
}

TEST(MotionFitTest, QuadraticFieldsComeOutExactly) {
  const auto grid = build_solid_grid(ball_solid(0.5, 0.3), 10);
  ASSERT_TRUE(grid.ok());
  const glm::dvec3 at = 0.5 * glm::normalize(glm::dvec3(1.0, 2.0, 2.0));
  const MotionFit fit = fit_motion(grid.value(), at);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  const auto field = [](const glm::dvec3& p) {
    return 1.0 + p.x - 2.0 * p.y * p.z + 3.0 * p.z * p.z;
  };
  for (std::size_t k = 0; k < fit.nodes.size(); ++k) {
    sum += field(grid.value().nodes[fit.nodes[k]]) * fit.weights.col(static_cast<Eigen::Index>(k));
  }
  EXPECT_NEAR(sum[0], field(at), 1e-10);
  EXPECT_NEAR(sum[1], 1.0, 1e-9);
  EXPECT_NEAR(sum[2], -2.0 * at.z, 1e-9);
  EXPECT_NEAR(sum[3], -2.0 * at.y + 6.0 * at.z, 1e-9);
}

}  // namespace
}  // namespace torsion::engine
