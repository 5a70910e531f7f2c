// Tools on bodies that deflect by far more than their contacts do, and what bounds a force
// whatever goes wrong.

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

#include <Eigen/Core>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/contact/region_wrenches.hpp"
#include "systems/contact/support/support_fit.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/patch/support.hpp"
#include "systems/scratch.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/pinched_column.hpp"
#include "tests/support/standout.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine::test {
namespace {

/// How nearly equal both sides' forces are to be, of the force. What one force F does to the column
/// alone, F l^3 / (3 E I), and what the other takes back of it are both some hundred to a thousand
/// times the depth (k l^3 / (3 E I) with k the contact's stiffness, 14 N/mm here), and the table of
/// the body's compliance has them to 1e-5 each.
double balance_of(double width) {
  constexpr double kTable = 1e-5;
  constexpr double kStiffness = 1.4e4;
  const double second_moment = std::pow(width, 4.0) / 12.0;
  const double sway = kStiffness * std::pow(0.08, 3.0) / (3.0 * 1e6 * second_moment);
  return std::max(1e-3, 2.0 * kTable * sway);
}

class PinchTest : public testing::TestWithParam<double> {};

TEST_P(PinchTest, ComesToRestWithTheSameForceFromBothSides) {
  const bool extreme = GetParam() == 0.36 || GetParam() == 0.15;
  if (test::is_left_out(extreme)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  const double width = GetParam() * 0.1;
  const auto held_force = [width](ContactModel contact) {
    Hand hand(pinched_column(width, contact, 0.8));
    for (int step = 0; step <= 200; ++step) {
      const double depth = 1e-3 * step / 200.0 - 5e-5;
      hand.step_to(pinch_poses(width, depth, depth));
    }
    double least = 1e300;
    double most = 0.0;
    for (int step = 0; step < 400; ++step) {
      hand.step_to(pinch_poses(width, 1e-3 - 5e-5, 1e-3 - 5e-5));
      const double force = glm::length(hand.wrench(0).force);
      if (step >= 200) {
        least = std::min(least, force);
        most = std::max(most, force);
        EXPECT_NEAR(hand.wrench(0).force.x, -hand.wrench(1).force.x, balance_of(width) * force);
      }
    }
    EXPECT_EQ(hand.clock().faults_ever, 0U);
    EXPECT_LT(most - least, 1e-6 * most);
    return most;
  };
  const double force = held_force(ContactModel::kPatch);
  // Springs know nothing of how the material bends under the contact: a few percent.
  EXPECT_NEAR(held_force(ContactModel::kMdr), force, 0.06 * force);
}

INSTANTIATE_TEST_SUITE_P(WidthOverHeight, PinchTest,
                         testing::Values(0.36, 0.32, 0.3, 0.25, 0.2, 0.15));

// Without friction a column that is pinched turns about its axis as the balls' places on it make
// it: nothing but its own stiffness and the balls' shapes holds it. Friction would, and hide an
// answer of the one region to the other that is wrong.
class SlipperyPinchTest : public testing::TestWithParam<std::tuple<double, double>> {
 protected:
  static constexpr double kPush = 1.5e-3;  // m, of each ball
  static constexpr int kSteps = 300;

  /// The force on the left ball in every step, N.
  static std::vector<glm::dvec3> pinch(ContactModel contact) {
    const auto [width, friction] = GetParam();
    Hand hand(pinched_column(width, contact, friction));
    std::vector<glm::dvec3> forces;
    for (int step = 0; step <= kSteps; ++step) {
      const double depth = kPush * step / kSteps;
      hand.step_to(pinch_poses(width, depth, depth));
      forces.push_back(hand.wrench(0).force);
    }
    EXPECT_EQ(hand.clock().faults_ever, 0U);
    return forces;
  }

  static double standout_share(const std::vector<glm::dvec3>& forces) {
    return largest_standout(forces).size / median_length(forces);
  }
};

TEST_P(SlipperyPinchTest, PressesSteadilyWhileItIsPressedHarder) {
  if (test::is_left_out(std::get<1>(GetParam()) == 0.0)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  const std::vector<glm::dvec3> by_springs = pinch(ContactModel::kMdr);
  const std::vector<glm::dvec3> by_cells = pinch(ContactModel::kPatch);
  // In 300 steps nothing changes by more than some of them; patch's grids and the supports under
  // them are laid anew now and then, and so soft a column makes much of what changes by that.
  EXPECT_LT(standout_share(by_springs), 0.05);
  EXPECT_LT(standout_share(by_cells), 0.25);
  EXPECT_NEAR(by_cells.back().x, by_springs.back().x, 0.06 * std::abs(by_springs.back().x));
}

INSTANTIATE_TEST_SUITE_P(Columns, SlipperyPinchTest,
                         testing::Combine(testing::Values(0.03, 0.02),  // m
                                          testing::Values(0.0, 1e-5, 1e-4, 1e-3, 0.02)));

// Taps of a ball on a half-space, a hundred a second: what the tool's own way makes of a new
// contact is no jump. The cells' first steps are coarse, so 5 % of the peak.
TEST(TapTest, AQuickTapIsFeltAsHertzHasIt) {
  constexpr double kRadius = 0.02;
  constexpr double kDepth = 3e-4;
  for (const ContactModel contact : {ContactModel::kMdr, ContactModel::kPatch}) {
    SceneDescription scene = ball_on_cube();
    scene.tools[0] = make_tool({make_part(ShapeKind::kSphere, glm::dvec3(kRadius))});
    BodyDescription& body = scene.bodies[0];
    body.models.contact = contact;
    body.models.body = BodyModel::kNone;
    body.elasticity = {1e6, 0.45, 1100.0};
    const double modulus = body.elasticity.contact_modulus();
    const auto hertz = [modulus](double depth) {
      return depth > 0.0 ? 4.0 / 3.0 * modulus * std::sqrt(kRadius) * std::pow(depth, 1.5) : 0.0;
    };
    Hand hand(scene);
    double farthest = 0.0;
    for (int step = 0; step < 100; ++step) {
      const double depth = -kDepth * std::cos(2.0 * 3.14159265358979 * step / 10.0);
      hand.step_to({{{0.0, 0.1 + kRadius - depth, 0.0}, glm::dquat(1, 0, 0, 0)}});
      farthest = std::max(farthest, std::abs(hand.wrench().force.y - hertz(depth)));
    }
    EXPECT_LT(farthest, 0.05 * hertz(kDepth)) << static_cast<int>(contact);
  }
}

/// The whole compliance of squares on a disc under pressure, half-space and body: its least
/// eigenvalue over the half-space's own, by other squares than the stiffness was made with.
double least_share(const SupportResponse& response, const SupportFit& support_fit,
                   const Elasticity& elasticity) {
  constexpr std::uint32_t kSide = 13;
  std::vector<double> values(influence_count(kSide));
  fill_influences(elasticity.poisson_ratio, kSide, values);
  const InfluenceTables tables = influence_tables(values, kSide, 0);
  const double length = 2.0 * support_fit.extent / kSide;
  std::vector<std::array<std::uint32_t, 2>> cells;
  for (std::uint32_t j = 0; j < kSide; ++j) {
    for (std::uint32_t i = 0; i < kSide; ++i) {
      if (std::hypot(2.0 * i + 1.0 - kSide, 2.0 * j + 1.0 - kSide) < kSide) {
        cells.push_back({i, j});
      }
    }
  }
  const auto count = static_cast<Eigen::Index>(cells.size());
  Eigen::MatrixXd half_space(count, count);
  Eigen::MatrixXd terms(count, static_cast<Eigen::Index>(kSupportTerms));
  for (Eigen::Index row = 0; row < count; ++row) {
    const auto& [i, j] = cells[static_cast<std::size_t>(row)];
    const glm::dvec2 at = length * (glm::dvec2(i, j) + 0.5 - 0.5 * kSide) / support_fit.reach;
    const auto of_cell = support_terms(at);
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      terms(row, static_cast<Eigen::Index>(k)) = of_cell[k];
    }
    for (Eigen::Index from = 0; from < count; ++from) {
      const auto& source = cells[static_cast<std::size_t>(from)];
      half_space(row, from) =
          tables.of(InfluenceKind::kZZ)[tables.index(source[0], source[1], i, j)] /
          (length * elasticity.shear_modulus());
    }
  }
  Eigen::MatrixXd normal(terms.cols(), terms.cols());
  for (Eigen::Index column = 0; column < terms.cols(); ++column) {
    for (Eigen::Index row = 0; row < terms.cols(); ++row) {
      normal(row, column) = response.terms[static_cast<std::size_t>(
          ((2 * kSupportColumn + column) * 3 + 2) * kSupportColumn + row)];
    }
  }
  const Eigen::MatrixXd whole = half_space + terms * normal * terms.transpose();
  return test::generalized_eigenvalues(whole, 0.5 * (half_space + half_space.transpose()))[0];
}

TEST(DefiniteResponseTest, LeavesAQuarterOfTheHalfSpaceAndTouchesNothingElse) {
  const DiscStiffness disc = make_disc_stiffness();
  const Elasticity elasticity{3e6, 0.5, 1100.0};
  SupportFit support_fit;
  support_fit.tangent_x = {1.0, 0.0, 0.0};
  support_fit.tangent_y = {0.0, 1.0, 0.0};
  support_fit.normal = {0.0, 0.0, 1.0};
  support_fit.reach = 0.02;
  support_fit.extent = 0.01;
  std::mt19937 random(7);
  std::normal_distribution<double> value;
  for (const double size : {1e-7, 1e-5, 1e-3}) {
    for (const double sign : {1.0, -1.0}) {
      // Of every rank and kind: x x' of random x, all three axes.
      SupportResponse response;
      for (int k = 0; k < 20; ++k) {
        std::array<double, 3 * kSupportTerms> x{};
        std::ranges::generate(x, [&] { return value(random); });
        for (std::size_t column = 0; column < x.size(); ++column) {
          for (std::size_t row = 0; row < x.size(); ++row) {
            const std::size_t at =
                ((column / kSupportTerms * kSupportColumn + column % kSupportTerms) * 3 +
                 row / kSupportTerms) *
                    kSupportColumn +
                row % kSupportTerms;
            response.terms[at] += sign * size * x[column] * x[row];
          }
        }
      }
      const SupportResponse before = response;
      const bool changed = make_definite(disc, elasticity, support_fit, response);
      const double least = least_share(response, support_fit, elasticity);
      // The disc's squares are others than the contact's: 5 %.
      EXPECT_GT(least, 0.95 * (1.0 + kLeastResponse)) << size << " " << sign;
      if (sign > 0.0) {
        EXPECT_FALSE(changed) << size;
      } else if (least_share(before, support_fit, elasticity) < 0.0) {
        EXPECT_TRUE(changed) << size;
      }
      if (!changed) {
        EXPECT_EQ(before.terms, response.terms);
      }
    }
  }
}

TEST(ForceBoundTest, AForceBeyondARigidPunchIsAFaultAndFades) {
  Hand hand(ball_on_cube());
  hand.step_to({{glm::dvec3(0.0, 0.151, 0.0), glm::dquat(1, 0, 0, 0)}});
  hand.move({0.0, -0.0015, 0.0}, {0.0, 1.0, 0.0}, 0.0, 100);
  ASSERT_EQ(hand.clock().faults_ever, 0U);
  const double before = hand.wrench().force.y;
  ASSERT_GT(before, 1.0);
  Simulation& simulation = hand.simulation();
  StepContext context =
      simulation.scratch->context(simulation.world.model, simulation.world.state, hand.poses);
  simulation.world.model.bodies.at<BodyModels>(0).contact = ContactModel::kMdr;
  simulation.world.state.regions.at<RegionNormal>(0).force = 1e4;
  region_wrenches(context);
  sum_wrenches(context);
  EXPECT_TRUE(raised(hand.clock().faults, Fault::kForceTooLarge));
  EXPECT_LT(hand.wrench().force.y, before);
  EXPECT_GT(hand.wrench().force.y, 0.8 * before);
}

// A ball's force takes 2/5 of force times depth to reach (Hertz). Five times that force at the same
// place is still less than a rigid punch would have that holds the samples in contact, but needs
// 25 times the energy.
TEST(ForceBoundTest, AForceForWhichNobodyHasWorkedIsAFault) {
  SceneDescription scene = ball_on_cube();
  scene.bodies[0].models.contact = ContactModel::kMdr;
  scene.bodies[0].models.body = BodyModel::kNone;
  Hand hand(scene);
  hand.step_to({{glm::dvec3(0.0, 0.151, 0.0), glm::dquat(1, 0, 0, 0)}});
  hand.move({0.0, -0.0025, 0.0}, {0.0, 1.0, 0.0}, 0.0, 100);
  ASSERT_EQ(hand.clock().faults_ever, 0U);
  Simulation& simulation = hand.simulation();
  StepContext context =
      simulation.scratch->context(simulation.world.model, simulation.world.state, hand.poses);
  RegionNormal& normal = simulation.world.state.regions.at<RegionNormal>(0);
  normal.force *= 5.0;
  region_wrenches(context);
  EXPECT_TRUE(raised(hand.clock().faults, Fault::kForceTooLarge));
}

// A step with a wrong force leaves no work behind by which the next wrong one would be allowed.
TEST(ForceBoundTest, AWrongForceHasDoneNoWork) {
  SceneDescription scene = ball_on_cube();
  scene.bodies[0].models.contact = ContactModel::kMdr;
  scene.bodies[0].models.body = BodyModel::kNone;
  Hand hand(scene);
  hand.step_to({{glm::dvec3(0.0, 0.151, 0.0), glm::dquat(1, 0, 0, 0)}});
  hand.move({0.0, -0.0025, 0.0}, {0.0, 1.0, 0.0}, 0.0, 100);
  Simulation& simulation = hand.simulation();
  StepContext context =
      simulation.scratch->context(simulation.world.model, simulation.world.state, hand.poses);
  for (const double times : {1000.0, 5.0}) {
    simulation.world.state.regions.at<RegionNormal>(0).force *= times;
    region_wrenches(context);
    EXPECT_TRUE(raised(hand.clock().faults, Fault::kForceTooLarge)) << times;
    hand.move({0.0, -2.5e-5, 0.0}, {0.0, 1.0, 0.0}, 0.0, 1);
    EXPECT_FALSE(raised(hand.clock().faults, Fault::kForceTooLarge)) << times;
  }
}

// Pressed in, dragged about and let go a hundred times: what the sum of the work drifts by is no
// fault.
TEST(ForceBoundTest, ALongSessionHasNoFault) {
  for (const ContactModel model : {ContactModel::kMdr, ContactModel::kPatch}) {
    SceneDescription scene = ball_on_cube();
    scene.bodies[0].models.contact = model;
    scene.bodies[0].models.body = BodyModel::kNone;
    Hand hand(scene);
    hand.step_to({{glm::dvec3(0.0, 0.149, 0.0), glm::dquat(1, 0, 0, 0)}});
    for (int k = 0; k < 100; ++k) {
      const double side = k % 2 == 0 ? 1.0 : -1.0;
      hand.move({1e-3 * side, -0.0015, 0.0}, {0.0, 1.0, 0.0}, 0.1 * side, 10);
      hand.move({0.0, 0.0015, 0.0}, {0.0, 1.0, 0.0}, 0.0, 10);
    }
    EXPECT_EQ(hand.clock().faults_ever, 0U);
  }
}

}  // namespace
}  // namespace torsion::engine::test
