// The smooth compliance against bars, layers and what must hold for any body. Unit Young's modulus.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "systems/model/finite_elements/compliance.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/studies.hpp"
#include "tests/systems/model/finite_elements/elastic_solids.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

constexpr double kSquareTorsion = 0.14057701;  // J over b^4 of a square bar

SmoothCompliance build(const ElasticSolid& solid, const std::vector<Port>& ports,
                       std::uint32_t elements) {
  const auto built = build_smooth_compliance(solid, ports, {elements, 1, {}, true});
  EXPECT_TRUE(built.ok());
  return built ? built.value() : SmoothCompliance{};
}

double shear_modulus(double poisson_ratio) {
  return 0.5 / (1.0 + poisson_ratio);
}

/// Of the middle of the top, 6 x 6.
Eigen::MatrixXd at_top(const ElasticSolid& solid, std::uint32_t elements) {
  return build(solid, {top_port(solid.bounds.highest.z)}, elements).matrix;
}

TEST(SmoothComplianceTest, SquareBarTwistsByItsEffectiveLength) {
  // Less the half-space, a bar of side b twists as one of length h - 0.35 b (within 0.4 %
  // of that fit). Eight elements across leave 1.3 % of J, more across less.
  const double height = 4.0;
  const double exact = (height - 0.35) / (shear_modulus(0.3) * kSquareTorsion);
  const double coarse = at_top(block_solid({1.0, 1.0, height}, 0.3), 16)(5, 5);
  EXPECT_NEAR(coarse / exact, 1.0, 0.025);
  const double fine = at_top(block_solid({1.0, 1.0, height}, 0.3), 48)(5, 5);
  EXPECT_NEAR(fine / exact, 1.0, 0.01);
}

TEST(SmoothComplianceTest, TwistSpreadOverADiscOnACubeMeetsFiniteElements) {
  // A bonded rigid disc of radius a on a cube of side 1: the physics note has its torsional
  // stiffness over the half-space's 16/3 G a^3 by finite elements, to 1 %. The disc's tractions
  // r/sqrt(a^2 - r^2) act at 24 points (Gauss points in sqrt(1 - r^2/a^2)); by virtual work the
  // smooth part adds to the twist what it does to the mean over them. All of it is in the rows of
  // forces and displacements. A point couple instead would be 7 % off at the largest disc.
  const std::array<std::array<double, 2>, 3> table{{{0.2, 0.838}, {0.3, 0.587}, {0.4, 0.361}}};
  const std::array<double, 3> points{0.1127016654, 0.5, 0.8872983346};
  const std::array<double, 3> weights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const double g = shear_modulus(0.5);
  for (const auto& [radius, expected] : table) {
    std::vector<Port> ports;
    std::vector<glm::dvec3> forces;
    double torque = 0.0;
    for (int i = 0; i < 24; ++i) {
      const int ring = i / 8;
      const auto row = static_cast<std::size_t>(ring);
      const double share = std::sqrt(1.0 - points[row] * points[row]);
      const double angle = 0.25 * pi * (i + 0.5 * ring);
      const glm::dvec3 along(std::cos(angle), std::sin(angle), 0.0);
      ports.push_back({radius * share * along + glm::dvec3(0.0, 0.0, 1.0), {0.0, 0.0, 1.0}});
      forces.push_back(share * weights[row] * glm::dvec3(-along.y, along.x, 0.0));
      torque += share * weights[row] * radius * share;
    }
    const Eigen::MatrixXd smooth = build(block_solid({1.0, 1.0, 1.0}, 0.5), ports, 16).matrix;
    Eigen::VectorXd load = Eigen::VectorXd::Zero(smooth.rows());
    for (std::size_t i = 0; i < 24; ++i) {
      load.segment<3>(6 * static_cast<Eigen::Index>(i)) << forces[i].x, forces[i].y, forces[i].z;
    }
    const double half_space = 3.0 / (16.0 * g * radius * radius * radius);
    const double whole = half_space + load.dot(smooth * load) / (torque * torque);
    EXPECT_NEAR(half_space / whole / expected, 1.0, 0.012) << radius;
  }
}

TEST(SmoothComplianceTest, RoundBarTwistsByItsEffectiveLength) {
  // h - 0.6 r likewise; a polygon of 26 sides has 2 % less J than its circle.
  const double radius = 0.5;
  const double height = 3.0;
  const double exact =
      (height - 0.6 * radius) / (shear_modulus(0.5) * 0.5 * pi * std::pow(radius, 4));
  EXPECT_NEAR(at_top(round_bar(radius, height, 0.5), 24)(5, 5) / exact, 1.0, 0.03);
  EXPECT_NEAR(at_top(round_bar(radius, height, 0.5), 48)(5, 5) / exact, 1.0, 0.012);
}

TEST(SmoothComplianceTest, ALongerBarAddsItsStretchAndItsBend) {
  // Between two lengths all end effects on stretch and turn drop out. The elements are exact in
  // both.
  for (const double poisson_ratio : {0.0, 0.3, 0.5}) {
    const Eigen::MatrixXd added = at_top(block_solid({1.0, 1.0, 6.0}, poisson_ratio), 18) -
                                  at_top(block_solid({1.0, 1.0, 4.0}, poisson_ratio), 12);
    EXPECT_NEAR(added(2, 2) / 2.0, 1.0, 2e-3);
    EXPECT_NEAR(added(3, 3) / 24.0, 1.0, 2e-3);
    EXPECT_NEAR(added(4, 4) / 24.0, 1.0, 2e-3);
    if (poisson_ratio == 0.0) {  // else the clamp's hold on the width enters the deflection
      const double bend = (216.0 - 64.0) * 4.0;
      const double shear = 2.0 * 1.2 / shear_modulus(0.0);
      EXPECT_NEAR(added(0, 0) / (bend + shear), 1.0, 2e-3);
      EXPECT_NEAR(added(0, 4) / 120.0, 1.0, 2e-3);  // by a couple: (6^2 - 4^2) / (2 E I)
    }
  }
}

TEST(SmoothComplianceTest, CantileversDeflectWithTheirLengthCubed) {
  // The clamp's hold, shear and the tip are at most quadratic in the length: third differences
  // leave 6/(3 E I) = 24. They lose two digits.
  for (const double poisson_ratio : {0.3, 0.5}) {
    double difference = 0.0;
    for (int k = 0; k < 4; ++k) {
      const double weight = std::array{-1.0, 3.0, -3.0, 1.0}[static_cast<std::size_t>(k)];
      const Eigen::MatrixXd bar = at_top(block_solid({1.0, 1.0, 4.0 + k}, poisson_ratio),
                                         static_cast<std::uint32_t>(8 + 2 * k));
      EXPECT_NEAR(bar(1, 1) / bar(0, 0), 1.0, 1e-7);
      difference += weight * bar(0, 0);
    }
    EXPECT_NEAR(difference / 24.0, 1.0, 0.01);
  }
}

TEST(SmoothComplianceTest, BondedLayerStiffensAsItsSeriesBegins) {
  // F = F_Hertz (1 + 1.133 a/h + ...) at equal depth (nu = 0.5, bonded) is depth = depth_Hertz +
  // S F with S = -1.133 (2/3) (3/4) / (E* h); T = T_half-space (1 + 0.09566 (a/h)^3 + ...) is
  // S = -(3/16) 0.09566 / (G h^3). A width of 8 h is endless to 1 %; eight elements through the
  // layer see the turn under the port, a second derivative of what they hold, to 10 %.
  const double contact_modulus = 1.0 / 0.75;
  const Eigen::MatrixXd layer = at_top(block_solid({8.0, 8.0, 1.0}, 0.5), 32);
  EXPECT_NEAR(layer(2, 2) * contact_modulus, -0.5665, 0.012);
  EXPECT_NEAR(layer(5, 5) * shear_modulus(0.5), -0.01794, 0.0022);
}

TEST(SmoothComplianceTest, LargeBlockLeavesTwoPortsOnItsTopToTheHalfSpace) {
  // Far from all sides, what is left between two ports is what the clamp takes from both, smaller
  // than the half-space's part by their distance over the block's size to some power.
  const std::vector<Port> ports{{glm::dvec3(-0.08, 0.0, 1.0), glm::dvec3(0.0, 0.0, 1.0)},
                                {glm::dvec3(0.08, 0.0, 1.0), glm::dvec3(0.0, 0.0, 1.0)}};
  const ElasticSolid solid = block_solid({2.0, 2.0, 1.0}, 0.5);
  const Eigen::MatrixXd smooth = build(solid, ports, 24).matrix;
  const auto direct = half_space_coupling(ports[0], ports[1], solid.elasticity);
  EXPECT_LT(smooth.block(3, 9, 3, 3).norm(), 0.01 * direct.bottomRightCorner(3, 3).norm());
  // and the smooth part hardly knows the two ports apart
  EXPECT_LT((smooth.block(0, 6, 3, 3) - smooth.block(0, 0, 3, 3)).norm(),
            0.1 * smooth.block(0, 0, 3, 3).norm());
}

TEST(SmoothComplianceTest, IsTheSameToTheBitWhateverTheCachesOfTheMachine) {
  const ElasticSolid solid = block_solid({1.0, 1.0, 1.0}, 0.4);
  const std::vector<Port> ports = choose_ports(solid, 20);
  Eigen::setCpuCacheSizes(32 << 10, 256 << 10, 8 << 20);
  const Eigen::MatrixXd small = build(solid, ports, 20).matrix;
  Eigen::setCpuCacheSizes(128 << 10, 4 << 20, 64 << 20);
  EXPECT_EQ((build(solid, ports, 20).matrix - small).norm(), 0.0);
}

TEST(SmoothComplianceTest, WhatOnePortDoesToAnotherIsReciprocal) {
  if (test::is_left_out(false)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  // Between forces and displacements the grid is right to 0.3 %; torques see derivatives, which
  // are worst between ports on both sides of an edge, nearer to it than three elements.
  for (const double poisson_ratio : {0.3, 0.5}) {
    const ElasticSolid block = block_solid({1.0, 1.0, 1.0}, poisson_ratio);
    EXPECT_LT(build(block, choose_ports(block, 40), 16).relative_asymmetry, 0.06);
    const ElasticSolid ball = ball_solid(0.5, poisson_ratio);
    EXPECT_LT(build(ball, choose_ports(ball, 40), 16).relative_asymmetry, 0.02);
  }
}

TEST(SmoothComplianceTest, MatrixIsSymmetricAndGivesAllBodiesTheEnergyOfTheirLoads) {
  // With half-spaces between ports, and with what a contact of radius a tenth of the ports'
  // distance does at its own, the compliance stores energy under any loads.
  const ElasticSolid solid = block_solid({1.0, 1.0, 1.0}, 0.4);
  const std::vector<Port> ports = choose_ports(solid, 30);
  Eigen::MatrixXd whole = build(solid, ports, 16).matrix;
  EXPECT_EQ((whole - whole.transpose()).norm(), 0.0);
  const double radius = 0.02;
  const double g = shear_modulus(0.4);
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
    whole.diagonal().segment<3>(row).array() += 0.6 / (4.0 * g * radius);  // softest: normal
    whole.diagonal().segment<3>(row + 3).array() += 3.0 / (16.0 * g * std::pow(radius, 3));
    for (std::size_t j = 0; j < ports.size(); ++j) {
      if (i != j) {
        whole.block<6, 6>(row, 6 * static_cast<Eigen::Index>(j)) +=
            half_space_coupling(ports[i], ports[j], solid.elasticity);
      }
    }
  }
  const Eigen::VectorXd scale = whole.diagonal().cwiseSqrt().cwiseInverse();
  whole = (scale.asDiagonal() * whole * scale.asDiagonal()).eval();
  EXPECT_GT(test::eigenvalues(whole).minCoeff(), 0.0);
}

TEST(SmoothComplianceTest, HalfSpaceCouplingIsReciprocal) {
  const Port a{glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 0.0, 1.0)};
  const Port b{glm::dvec3(0.5, 0.1, 0.6), glm::normalize(glm::dvec3(1.0, 0.2, 0.3))};
  const Elasticity elasticity{2.0, 0.3, 1000.0};
  EXPECT_NEAR(
      (half_space_coupling(a, b, elasticity) - half_space_coupling(b, a, elasticity).transpose())
          .norm(),
      0.0, 1e-15);
}

TEST(SmoothComplianceTest, IncompressibleIsTheLimitOfNearlyIncompressible) {
  // By the closed forms of bars and layers, the change from nu = 0.5 to 0.499 is some 0.3 %.
  const ElasticSolid half = block_solid({1.0, 1.0, 0.6}, 0.5);
  const ElasticSolid nearly = block_solid({1.0, 1.0, 0.6}, 0.499);
  const std::vector<Port> ports = choose_ports(half, 8);
  const Eigen::MatrixXd a = build(half, ports, 12).matrix;
  EXPECT_LT((a - build(nearly, ports, 12).matrix).norm(), 0.01 * a.norm());
}

TEST(SmoothComplianceTest, MovedTurnedAndScaledScenesGiveTheSame) {
  // The lattice follows the bounds; a cyclic change of axes permutes it, a scale is a unit.
  const ElasticSolid solid = block_solid({1.0, 1.2, 0.8}, 0.3);
  std::vector<Port> ports = choose_ports(solid, 8);
  const Eigen::MatrixXd here = build(solid, ports, 12).matrix;
  const glm::dvec3 shift(3.0, -2.0, 7.0);
  const double size = 0.01;
  const auto out = [&](const glm::dvec3& p) {
    return size * glm::dvec3(p.z, p.x, p.y) + shift;
  };
  const auto in = [&](const glm::dvec3& p) {
    const glm::dvec3 q = (p - shift) / size;
    return glm::dvec3(q.y, q.z, q.x);
  };
  const ElasticSolid moved{
      [&](const glm::dvec3& p) {
        const Distance d = solid.signed_distance(in(p));
        return Distance{size * d.value, {d.gradient.z, d.gradient.x, d.gradient.y}};
      },
      {out(solid.bounds.lowest), out(solid.bounds.highest)},
      [&](const glm::dvec3& p) { return solid.clamped(in(p)); },
      {5e6, 0.3, 1000.0}};
  Eigen::MatrixXd turn = Eigen::MatrixXd::Zero(here.rows(), here.cols());
  for (std::size_t k = 0; k < ports.size(); ++k) {
    ports[k] = {out(ports[k].position), {ports[k].normal.z, ports[k].normal.x, ports[k].normal.y}};
    for (int part = 0; part < 2; ++part) {
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(k) + 3 * Eigen::Index{part};
      const double unit = part == 0 ? 1.0 : 1.0 / size;
      turn(row, row + 2) = unit;
      turn(row + 1, row) = unit;
      turn(row + 2, row + 1) = unit;
    }
  }
  const Eigen::MatrixXd expected = turn * here * turn.transpose() / (5e6 * size);
  EXPECT_LT((build(moved, ports, 12).matrix - expected).norm(), 1e-6 * expected.norm());
}

TEST(SmoothComplianceTest, AClampMayEndBetweenTheLatticesPlanes) {
  // Holding the lowest part of a bar is standing on its upper end.
  const double short_bar = at_top(block_solid({1.0, 1.0, 3.0}, 0.3), 24)(3, 3);
  for (const double held : {0.31, 0.4}) {
    ElasticSolid bar = block_solid({1.0, 1.0, 3.0 + held}, 0.3);
    bar.clamped = [held](const glm::dvec3& p) {
      return p.z <= held;
    };
    EXPECT_NEAR(at_top(bar, 24)(3, 3) / short_bar, 1.0, 2e-3);
  }
  // On a ball the clamp's end crosses the cells in all directions. Nodes left where the lattice has
  // them changed this by 10 % between 16 and 24 elements.
  const Port top{glm::dvec3(0.0, 0.0, 0.5), glm::dvec3(0.0, 0.0, 1.0)};
  const double coarse = build(ball_solid(0.5, 0.3), {top}, 16).matrix(0, 0);
  EXPECT_NEAR(build(ball_solid(0.5, 0.3), {top}, 24).matrix(0, 0) / coarse, 1.0, 0.03);
}

TEST(SmoothComplianceTest, ConvergesWithElements) {
  // Against 24 elements; the least across any side are 8, so this starts there.
  const ElasticSolid solid = round_bar(0.5, 1.0, 0.3);
  const std::vector<Port> ports{top_port(1.0), {{0.5, 0.0, 0.6}, {1.0, 0.0, 0.0}}};
  const Eigen::MatrixXd fine = build(solid, ports, 24).matrix;
  const double coarse_error = (build(solid, ports, 8).matrix - fine).norm() / fine.norm();
  const double error = (build(solid, ports, 14).matrix - fine).norm() / fine.norm();
  EXPECT_LT(error, 0.6 * coarse_error);
  EXPECT_LT(error, 0.08);
}

TEST(SmoothComplianceTest, ConcaveBodiesAreReciprocalToo) {
  // A block with a slot: its walls look at each other, where a port's half-space formulas reach far
  // over its plane. At nu = 0.5 these are exact there, below that they are made up for:
  // otherwise the asymmetry is 1.
  const ElasticSolid block = block_solid({1.0, 0.6, 1.0}, 0.5);
  const ElasticSolid slot = block_solid({0.4, 2.0, 2.0}, 0.5);
  for (const double poisson_ratio : {0.0, 0.3, 0.5}) {
    ElasticSolid solid = block;
    solid.elasticity.poisson_ratio = poisson_ratio;
    solid.signed_distance = [&](const glm::dvec3& p) {
      const Distance outer = block.signed_distance(p);
      const Distance inner = slot.signed_distance(p - glm::dvec3(0.0, 0.0, 0.4));
      return outer.value > -inner.value ? outer : Distance{-inner.value, -inner.gradient};
    };
    const std::vector<Port> ports{{{-0.2, 0.0, 0.75}, {1.0, 0.0, 0.0}},
                                  {{0.2, 0.05, 0.7}, {-1.0, 0.0, 0.0}},
                                  {{0.5, 0.0, 0.6}, {1.0, 0.0, 0.0}}};
    EXPECT_LT(build(solid, ports, 20).relative_asymmetry, 0.01) << poisson_ratio;
  }
}

TEST(SmoothComplianceTest, ThreadsGiveTheSameBits) {
  const ElasticSolid solid = block_solid({1.0, 1.0, 1.0}, 0.3);
  const std::vector<Port> ports = choose_ports(solid, 20);
  double last = 0.0;
  const auto progress = [&](double done) {
    EXPECT_GE(done, last);
    last = done;
  };
  const auto one = build_smooth_compliance(solid, ports, {8, 1, progress});
  const auto two = build_smooth_compliance(solid, ports, {8, 2, {}});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one.value().matrix, two.value().matrix);
  EXPECT_DOUBLE_EQ(last, 1.0);
}

TEST(SmoothComplianceTest, SaysWhatIsWrongWithABody) {
  const std::vector<Port> ports{top_port(1.0)};
  ElasticSolid free = block_solid({1.0, 1.0, 1.0}, 0.3);
  free.clamped = [](const glm::dvec3&) {
    return false;
  };
  EXPECT_FALSE(build_smooth_compliance(free, ports, {8, 1, {}}).ok());
  ElasticSolid hinged = block_solid({1.0, 1.0, 1.0}, 0.3);
  hinged.clamped = [](const glm::dvec3& p) {
    return p.z < 1e-6 && p.x < -0.5 + 1e-6;
  };
  EXPECT_FALSE(build_smooth_compliance(hinged, ports, {8, 1, {}}).ok());
  ElasticSolid hollow = block_solid({1.0, 1.0, 1.0}, 0.3);
  hollow.signed_distance = [](const glm::dvec3&) {
    return Distance{1.0, {0.0, 0.0, 1.0}};
  };
  EXPECT_FALSE(build_smooth_compliance(hollow, ports, {8, 1, {}}).ok());
  ElasticSolid flat = block_solid({1.0, 1.0, 1.0}, 0.3);
  flat.bounds.highest.x = flat.bounds.lowest.x;
  EXPECT_FALSE(build_smooth_compliance(flat, ports, {8, 1, {}}).ok());
  EXPECT_FALSE(build_smooth_compliance(block_solid({1.0, 1.0, 1.0}, 0.6), ports, {8, 1, {}}).ok());
}

// A contact there knows the body's turns and bends only by the ports that it sees.
TEST(ChoosePortsTest, TheEndOfASlenderColumnHasPortsToo) {
  for (const double width : {0.3, 0.15, 0.08}) {
    const ElasticSolid solid = block_solid({width, width, 1.0}, 0.3);
    const std::vector<Port> ports = choose_ports(solid, 128);
    EXPECT_GE(std::ranges::count_if(ports, [](const Port& port) { return port.normal.z > 0.9; }), 7)
        << width;
    EXPECT_LT(port_distance_over_thickness(solid, ports, {}), 1.0) << width;
  }
}

TEST(ChoosePortsTest, OnAThinWallTheyAreDenseWhereContactsAreExpected) {
  const ElasticSolid plate = block_solid({0.1, 1.0, 1.0}, 0.3);
  const ExpectedPlace place{true, {0.0, 0.2, 1.0}, 0.03};
  const double usual = port_distance_over_thickness(plate, choose_ports(plate, 128), place);
  const double dense = port_distance_over_thickness(plate, choose_ports(plate, 128, place), place);
  EXPECT_GT(usual, 0.6);  // how far they may be apart there
  EXPECT_LT(dense, 0.6);
}

TEST(ChoosePortsTest, PortsLieOnTheFreeSurfaceSpreadAndAwayFromEdges) {
  const ElasticSolid solid = block_solid({1.0, 1.0, 1.0}, 0.3);
  const std::vector<Port> ports = choose_ports(solid, 60);
  // With its mirror images a port comes with up to three others.
  ASSERT_LE(ports.size(), 60U);
  ASSERT_GT(ports.size(), 60U - 4U);
  EXPECT_GT(ports.front().position.z, 0.999);  // the far end from the clamp
  const double spacing = std::sqrt(6.0 / 60.0);
  // Distances count up to 2.5 times as much where contacts are expected: an even spread would keep
  // half the mean spacing, this one that over 2.5 at the worst.
  double nearest_at_end = 1.0;
  double nearest_at_clamp = 1.0;
  for (std::size_t i = 0; i < ports.size(); ++i) {
    EXPECT_NEAR(solid.signed_distance(ports[i].position).value, 0.0, 1e-9);
    EXPECT_NEAR(glm::length(ports[i].normal), 1.0, 1e-9);
    EXPECT_FALSE(solid.clamped(ports[i].position));
    const glm::dvec3 from_center = glm::abs(ports[i].position - glm::dvec3(0.0, 0.0, 0.5));
    std::array<double, 3> sorted{from_center.x, from_center.y, from_center.z};
    std::sort(sorted.begin(), sorted.end());
    EXPECT_LT(sorted[1], 0.5 - 0.3 * spacing);
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = glm::distance(ports[i].position, ports[j].position);
      EXPECT_GT(distance, 0.5 * spacing / 2.5);
      const double height = std::min(ports[i].position.z, ports[j].position.z);
      double& nearest = height > 0.999 ? nearest_at_end : nearest_at_clamp;
      nearest = height > 0.999 || height < 0.4 ? std::min(nearest, distance) : nearest;
    }
  }
  EXPECT_LT(nearest_at_end, 0.75 * nearest_at_clamp);  // denser where contacts are expected
}

}  // namespace
}  // namespace torsion::engine
