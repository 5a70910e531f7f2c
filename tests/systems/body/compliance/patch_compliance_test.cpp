// Contact model patch on bodies that deflect themselves: what their compliance does to every cell
// is part of the equations of a step, so that nothing swings between the two models.

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/body/compliance/supported_regions.hpp"
#include "systems/contact/support/contact_load.hpp"
#include "systems/contact/support/support_fit.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kUp;

/// A block on its fixed lower face, and a ball that is pressed into the middle of its top.
struct Ground {
  const char* name;
  glm::dvec3 half;  // m
  double ball;      // m
  double depth;     // m
  double poisson_ratio;
};

/// From a layer, which is stiffer than a half-space, to columns that sway and tilt many times as
/// far as the contact is deep.
const Ground kGrounds[] = {{"Layer", {0.02, 0.006, 0.02}, 0.02, 1e-3, 0.5},
                           {"Column", {0.012, 0.06, 0.012}, 0.02, 1e-3, 0.5},
                           {"LargeContact", {0.025, 0.025, 0.025}, 0.2, 2e-3, 0.4999},
                           {"LargeContactCoupled", {0.025, 0.025, 0.025}, 0.2, 2e-3, 0.3},
                           {"LargeContactOnAColumn", {0.025, 0.1, 0.025}, 0.2, 2e-3, 0.4999},
                           {"Cork", {0.03, 0.03, 0.03}, 0.03, 2e-3, 0.0}};

Hand hand_over(const Ground& ground, std::uint32_t side, std::uint32_t iterations) {
  SceneDescription scene;
  BodyDescription body = test::make_body(
      {test::make_part(ShapeKind::kBox, ground.half,
                       {glm::dvec3(0.0, ground.half.y, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)})});
  body.fixed.kind = FixedKind::kFace;
  body.fixed.point = glm::dvec3(0.0);
  body.fixed.normal = kUp;
  body.elasticity.poisson_ratio = ground.poisson_ratio;
  body.elasticity.youngs_modulus = 3.0e5;
  body.friction = {1.0, 1.0};
  body.models.contact = ContactModel::kPatch;
  body.models.body = BodyModel::kCompliance;
  scene.bodies.push_back(std::move(body));
  scene.tools.push_back(
      test::make_tool({test::make_part(ShapeKind::kSphere, glm::dvec3(ground.ball))}));
  PrepareOptions options;
  options.settings.grid_side = side;
  options.settings.iterations = iterations;
  Hand hand(scene, options);
  hand.step_to(
      {{glm::dvec3(0.0, 2.0 * ground.half.y + ground.ball, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  return hand;
}

/// Length that makes a torque a force.
double lever(const Ground& ground) {
  return std::sqrt(ground.ball * ground.depth);
}

/// Larger change of force and torque over the force.
double change(const Wrench& from, const Wrench& to, const Ground& ground) {
  return std::max(glm::distance(from.force, to.force),
                  glm::distance(from.torque, to.torque) / lever(ground)) /
         glm::length(from.force);
}

struct CalmCase {
  Ground ground;
  std::uint32_t side;
};

class PatchComplianceTest : public testing::TestWithParam<CalmCase> {};

// Whatever the hand did: a while after it has stopped nothing moves any more, to the solver's own
// threshold (1e-9 of the mean pressure). While it moves, the contact is
// never lost, and never presses more than thrice as at first.
TEST_P(PatchComplianceTest, ComesToRestAfterAnyMotion) {
  const std::string_view on = GetParam().ground.name;
  if (test::is_left_out(GetParam().side == 12 && on != "LargeContact" && on != "Layer")) {
    GTEST_SKIP() << test::kLeftOut;
  }
  const Ground& ground = GetParam().ground;
  Hand hand = hand_over(ground, GetParam().side, 2);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  hand.move(glm::dvec3(0.0, -ground.depth, 0.0), kUp, 0.0, 50);
  const double pressed = hand.wrench().force.y;
  for (int leg = 0; leg < 5; ++leg) {
    const glm::dvec3 way =
        ground.depth * glm::dvec3(part(random), 0.3 * part(random), part(random));
    const double turn = 0.3 * part(random);
    for (int k = 0; k < 50; ++k) {
      hand.move(way / 50.0, kUp, turn / 50.0, 1);
      ASSERT_GT(hand.wrench().force.y, 0.3 * pressed);
      ASSERT_LT(hand.wrench().force.y, 3.0 * pressed);
    }
    hand.move(-way, kUp, 0.0, 50);
    hand.move(glm::dvec3(0.0), kUp, 0.0, 60);
    const Wrench settled = hand.wrench();
    hand.move(glm::dvec3(0.0), kUp, 0.0, 1);
    EXPECT_LT(change(settled, hand.wrench(), ground), 1e-8);
    hand.move(glm::dvec3(0.0), kUp, 0.0, 9);
    EXPECT_LT(change(settled, hand.wrench(), ground), 1e-8);
  }
  EXPECT_EQ(hand.clock().faults_ever, 0U);
}

/// Largest second difference of the force, N, of a motion in equal steps. Its first two steps do
/// not count: what was before went another way.
double largest_bend(Hand& hand, const glm::dvec3& way, double turn, int steps) {
  glm::dvec3 before = hand.wrench().force;
  glm::dvec3 added(0.0);
  double worst = 0.0;
  for (int k = 0; k < steps; ++k) {
    hand.move(way / static_cast<double>(steps), kUp, turn / steps, 1);
    const glm::dvec3 adds = hand.wrench().force - before;
    worst = k > 1 ? std::max(worst, glm::distance(adds, added)) : 0.0;
    before = hand.wrench().force;
    added = adds;
  }
  return worst;
}

// Nothing rattles while the hand moves either: where it goes on as before, a step adds to the force
// what the step before added, but for cells that come to slip or to touch. All of them together
// change it by no more than what the contact alone, the stiffest part, makes of a step's motion: a
// disc pressed in, 2 E* a (Johnson, Contact Mechanics, 1985, (3.36)); along and around it is
// softer.
TEST_P(PatchComplianceTest, AddsInAStepWhatTheStepBeforeAdded) {
  if (test::is_left_out(GetParam().side == 12)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  const Ground& ground = GetParam().ground;
  Hand hand = hand_over(ground, GetParam().side, 2);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  constexpr int kSteps = 50;
  hand.move(glm::dvec3(0.0, -ground.depth, 0.0), kUp, 0.0, kSteps);
  const double modulus = hand.world().model.bodies.at<Elasticity>(0).contact_modulus();
  for (int leg = 0; leg < 3; ++leg) {
    const glm::dvec3 way =
        ground.depth * glm::dvec3(part(random), 0.3 * part(random), part(random));
    const double turn = 0.3 * part(random);
    // There and back, so that it stays on the body.
    for (const double sign : {1.0, -1.0}) {
      const double bend = largest_bend(hand, sign * way, sign * turn, kSteps);
      const double radius = hand.world().state.regions.at<Contact>(0).radius;
      const double step = (glm::length(way) + std::abs(turn) * radius) / kSteps;
      EXPECT_LT(bend, 2.0 * modulus * radius * step) << leg << " " << sign;
    }
  }
}

// A step's iterations are enough: twenty times as many press and turn to the same wrench.
TEST_P(PatchComplianceTest, MoreSweepsEndAtTheSameWrench) {
  if (test::is_left_out(GetParam().side == 12)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  const Ground& ground = GetParam().ground;
  Hand few = hand_over(ground, GetParam().side, 2);
  Hand many = hand_over(ground, GetParam().side, 40);
  for (Hand* hand : {&few, &many}) {
    hand->move(glm::dvec3(0.0, -ground.depth, 0.0), kUp, 0.0, 100);
    hand->move(glm::dvec3(0.1 * ground.depth, 0.0, 0.0), kUp, 0.1, 100);
  }
  EXPECT_LT(change(many.wrench(), few.wrench(), ground), 2e-3);
}

std::vector<CalmCase> calm_cases() {
  std::vector<CalmCase> cases;
  for (const Ground& ground : kGrounds) {
    for (const std::uint32_t side : {8U, 12U, 16U}) {
      cases.push_back({ground, side});
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Grounds, PatchComplianceTest, testing::ValuesIn(calm_cases()),
                         [](const testing::TestParamInfo<CalmCase>& at) {
                           return std::string(at.param.ground.name) + std::to_string(at.param.side);
                         });

// The response is what forces at the ports make of moments, to rounding.
TEST(SupportResponseTest, IsWhatThePortsMakeOfMoments) {
  Hand hand = hand_over(kGrounds[1], 12, 2);
  hand.move(glm::dvec3(0.0, -1e-3, 0.0), kUp, 0.0, 50);
  const World& world = hand.world();
  const PortCompliance ports = ports_of(world.model, 0);
  const SupportFit& support_fit = world.state.support_fits.at<SupportFit>(0);
  ASSERT_GT(support_fit.count, 10U);
  SupportResponse response;
  find_response(ports, support_fit, response);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  SupportMoments moments;
  for (glm::dvec3& moment : moments) {
    moment = {part(random), part(random), part(random)};
  }
  PortVectors forces;
  PortVectors displacements;
  forces_at_ports(support_fit, moments, forces);
  displacements_at_ports(ports, support_fit, forces, displacements);
  const SupportField field = bending(support_fit, displacements, Vector6::Zero());
  double largest = 0.0;
  double error = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      double sum = 0.0;
      for (std::size_t force = 0; force < 3; ++force) {
        for (std::size_t l = 0; l < kSupportTerms; ++l) {
          const std::size_t column = force * kSupportColumn + l;
          sum += response.terms[column * 3 * kSupportColumn + axis * kSupportColumn + k] *
                 moments[l][static_cast<int>(force)];
        }
      }
      const double expected = support_fit.share * field.terms[k][static_cast<int>(axis)];
      largest = std::max(largest, std::abs(expected));
      error = std::max(error, std::abs(sum - expected));
    }
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(error, 1e-11 * largest);
}

// A contact that has just begun may be a nanometre wide. Far smaller than the distances between
// ports it moves the body as a small one does, by forces and by couples, not by rounding.
TEST(PointContactTest, MovesTheBodyAsASmallOneDoes) {
  Hand hand = hand_over(kGrounds[1], 12, 2);
  hand.move(glm::dvec3(0.0, -1e-3, 0.0), kUp, 0.0, 50);
  State& state = hand.simulation().world.state;
  const Model& model = hand.world().model;
  const CompliantBody body{model, state, 0, ports_of(model, 0)};
  const SupportedRegion supported;
  const auto own_of = [&](double radius) {
    ContactEllipse contact = contact_ellipse(model, state, 0);
    contact.axis_1 = radius * glm::normalize(contact.axis_1);
    contact.axis_2 = radius * glm::normalize(contact.axis_2);
    contact.radius = radius;
    fit_region_support(body, supported, contact);
    return Matrix6(Eigen::Map<const Matrix6>(support_fit_of(body, supported).own.data()));
  };
  const Matrix6 small = own_of(1e-5);
  ASSERT_GT((small.topLeftCorner<3, 3>().norm()), 0.0);
  for (const double radius : {1e-7, 1e-9, 1e-11, 1e-13, 0.0}) {
    // The mean of a smooth displacement over a disc is even in its radius: 1e-5 m over the ports'
    // 7.7 mm, squared, are 2e-6.
    const Matrix6 apart = own_of(radius) - small;
    for (const auto& [row, column] : {std::pair{0, 0}, {3, 0}, {3, 3}}) {
      EXPECT_LT((apart.block<3, 3>(row, column).norm()),
                1e-5 * (small.block<3, 3>(row, column).norm()))
          << radius << " " << row << " " << column;
    }
  }
}

}  // namespace
}  // namespace torsion::engine
