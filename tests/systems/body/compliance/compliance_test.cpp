#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/systems/body/compliance/soft_bodies.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kSmallBallRadius;
using test::kSoftShearModulus;

/// A box of these half sides on its fixed lower face, and a tool above the middle of its top.
SceneDescription box_scene(const glm::dvec3& half, std::vector<PartDescription> tool,
                           ContactModel contact, BodyModel body_model) {
  SceneDescription scene;
  BodyDescription body = test::make_body({test::make_part(
      ShapeKind::kBox, half, {glm::dvec3(0.0, half.y, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)})});
  body.fixed.kind = FixedKind::kFace;
  body.fixed.point = glm::dvec3(0.0);
  body.fixed.normal = {0.0, 1.0, 0.0};
  body.elasticity.poisson_ratio = 0.5;
  body.elasticity.youngs_modulus = 3.0 * kSoftShearModulus;
  body.friction = {5.0, 5.0};
  body.models.contact = contact;
  body.models.body = body_model;
  scene.bodies.push_back(std::move(body));
  scene.tools.push_back(test::make_tool(std::move(tool)));
  return scene;
}

PartDescription ball_at(double x) {
  return test::make_part(ShapeKind::kSphere, glm::dvec3(kSmallBallRadius),
                         {glm::dvec3(x, 0.0, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)});
}

/// Touching the top of a body this high.
Hand hand_over(const SceneDescription& scene, double height) {
  PrepareOptions options;
  options.settings.grid_side = 12;
  Hand hand(scene, options);
  hand.step_to({{glm::dvec3(0.0, height + kSmallBallRadius, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  return hand;
}

double normal_force(const Hand& hand) {
  return hand.wrench().force.y;
}

// A column three times as high as wide: the disc's twist (Reissner and Sagoci) and the bar's
// (Saint-Venant, less the length that the disc's own field takes) add. Of the bar the finite
// elements miss 2 %, interpolation between ports another 2 %; mdr's first springs that slip make
// the contact 0.5 % softer or stiffer than the disc.
TEST(ComplianceTest, TwistOfAColumnAndOfItsContactAdd) {
  const glm::dvec3 half(0.02, 0.06, 0.02);
  const double side = 2.0 * half.x;
  Hand hand = hand_over(box_scene(half, {ball_at(0.0)}, ContactModel::kMdr, BodyModel::kCompliance),
                        2.0 * half.y);
  hand.move(glm::dvec3(0.0, -8e-4, 0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 200);
  hand.move(glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 20);
  const RegionSupport pressed = hand.world().state.regions.at<RegionSupport>(0);
  constexpr double kTurn = 1e-3;
  hand.move(glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), kTurn, 100);
  hand.move(glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 20);
  const double a = hand.world().state.regions.at<Contact>(0).radius;
  const double disc = 16.0 / 3.0 * kSoftShearModulus * a * a * a;
  const double length = 2.0 * half.y - 0.35 * side;
  const double bar = 0.140577 * kSoftShearModulus * std::pow(side, 4) / length;
  const double in_series = disc * bar / (disc + bar);
  ASSERT_GT(disc / bar, 0.05);
  EXPECT_NEAR(-hand.wrench().torque.y / kTurn / in_series, 1.0, 0.005 + 0.04 * disc / bar);
  const RegionSupport& support = hand.world().state.regions.at<RegionSupport>(0);
  const double turned = support.rotation.y - pressed.rotation.y;
  EXPECT_NEAR(turned / (kTurn * in_series / bar), 1.0, 0.04);
  // Pressing turns nothing, by symmetry; the ports are not placed symmetrically.
  EXPECT_LT(std::abs(pressed.rotation.y) * a, 1e-3 * std::abs(pressed.translation.y));
}

TEST(ComplianceTest, ABodyThatGivesWayIsPressedLess) {
  const glm::dvec3 half(0.02, 0.06, 0.02);
  Hand stiff =
      hand_over(box_scene(half, {ball_at(0.0)}, ContactModel::kPatch, BodyModel::kNone), 0.12);
  Hand soft = hand_over(
      box_scene(half, {ball_at(0.0)}, ContactModel::kPatch, BodyModel::kCompliance), 0.12);
  for (Hand* hand : {&stiff, &soft}) {
    hand->move(glm::dvec3(0.0, -1e-3, 0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 200);
    hand->move(glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 50);
  }
  // What is left of the depth presses as on the half-space: F ~ depth^1.5.
  const double sunk = -soft.world().state.regions.at<RegionSupport>(0).translation.y;
  EXPECT_GT(sunk, 5e-5);
  EXPECT_NEAR(normal_force(soft) / normal_force(stiff), std::pow(1.0 - sunk / 1e-3, 1.5), 0.02);
}

// Whatever happens at a bar's ends, each length between them adds its stretch L / (E A)
// (Saint-Venant). Elements of the same shape are exact in it; two heights have other ports, each
// good for half a per cent of a bar.
TEST(ComplianceTest, AHigherColumnSinksByTheStretchOfWhatIsAdded) {
  const auto compliance_of = [](double height) {
    const glm::dvec3 half(0.02, 0.5 * height, 0.02);
    Hand hand = hand_over(
        box_scene(half, {ball_at(0.0)}, ContactModel::kPatch, BodyModel::kCompliance), height);
    hand.move(glm::dvec3(0.0, -1e-3, 0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 100);
    hand.move(glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 50);
    return -hand.world().state.regions.at<RegionSupport>(0).translation.y / normal_force(hand);
  };
  const double bar = 1.0 / (3.0 * kSoftShearModulus * 0.04 * 0.04);  // 1/N: E A, E = 3 G
  const double low = compliance_of(0.08);
  const double high = compliance_of(0.16);
  EXPECT_NEAR((high - low) / (0.08 * bar), 1.0, 0.015);
}

TEST(ComplianceTest, ComesBackToRest) {
  Hand hand = hand_over(
      box_scene(glm::dvec3(0.03), {ball_at(0.0)}, ContactModel::kPatch, BodyModel::kCompliance),
      0.06);
  hand.move(glm::dvec3(0.0, -1e-3, 0.0), glm::dvec3(0.0, 1.0, 0.0), 0.2, 100);
  Snapshot snapshot;
  snapshot.reserve(hand.world().model, hand.world().state);
  take_snapshot(hand.simulation(), snapshot);
  double most = 0.0;
  for (const AnchorMotion& anchor : snapshot.anchors.column<AnchorMotion>()) {
    most = std::max(most, glm::length(anchor.displacement));
  }
  EXPECT_GT(most, 1e-5);
  hand.move(glm::dvec3(0.0, 2e-3, 0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 100);
  EXPECT_EQ(hand.world().state.regions.size(), 0U);
  EXPECT_EQ(glm::length(hand.wrench().force), 0.0);
  take_snapshot(hand.simulation(), snapshot);
  for (const AnchorMotion& anchor : snapshot.anchors.column<AnchorMotion>()) {
    EXPECT_EQ(glm::length(anchor.displacement), 0.0);
  }
}

// Two feet push each other's ground down; whichever is listed first, the outcome is one. Other
// samples on the tool's two balls change the force of mdr by parts in a hundred thousand.
TEST(ComplianceTest, TheOrderOfRegionsDoesNotMatter) {
  const glm::dvec3 half(0.05, 0.04, 0.05);
  const auto pressed = [&half](double first, double second) {
    Hand hand = hand_over(box_scene(half, {ball_at(first), ball_at(second)}, ContactModel::kMdr,
                                    BodyModel::kCompliance),
                          0.08);
    hand.move(glm::dvec3(0.0, -1e-3, 0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 100);
    hand.move(glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), 0.1, 100);
    EXPECT_EQ(hand.world().state.regions.size(), 2U);
    return hand.wrench();
  };
  const Wrench one = pressed(-0.022, 0.023);
  const Wrench other = pressed(0.023, -0.022);
  EXPECT_NEAR(glm::distance(one.force, other.force) / glm::length(one.force), 0.0, 1e-4);
  EXPECT_NEAR(glm::distance(one.torque, other.torque) / glm::length(one.torque), 0.0, 1e-4);
}

// A layer stiffens its contacts, so its compliance beside the half-space's is negative: the
// iteration must not build up, whatever the hand does.
TEST(ComplianceTest, StaysCalmOnALayerAndOnASoftColumn) {
  for (const glm::dvec3& half : {glm::dvec3(0.04, 0.006, 0.04), glm::dvec3(0.012, 0.06, 0.012)}) {
    for (const ContactModel model : {ContactModel::kMdr, ContactModel::kPatch}) {
      Hand hand =
          hand_over(box_scene(half, {ball_at(0.0)}, model, BodyModel::kCompliance), 2.0 * half.y);
      hand.move(glm::dvec3(0.0, -1e-3, 0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 100);
      std::mt19937 random(7);
      std::uniform_real_distribution<double> part(-1.0, 1.0);
      const double hertz =
          16.0 / 3.0 * kSoftShearModulus * std::sqrt(kSmallBallRadius) * std::pow(1e-3, 1.5);
      for (int leg = 0; leg < 20; ++leg) {
        const glm::dvec3 way(1e-3 * part(random), 0.0, 1e-3 * part(random));
        hand.move(way, glm::dvec3(0.0, 1.0, 0.0), 0.3 * part(random), 50);
        EXPECT_GT(normal_force(hand), 0.02 * hertz);
        EXPECT_LT(normal_force(hand), 3.0 * hertz);
        hand.move(-way, glm::dvec3(0.0, 1.0, 0.0), 0.0, 50);
      }
      hand.move(glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 200);
      const Wrench settled = hand.wrench();
      hand.move(glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 1);
      EXPECT_NEAR(glm::distance(hand.wrench().force, settled.force) / glm::length(settled.force),
                  0.0, 1e-4);
      EXPECT_EQ(hand.clock().faults_ever, 0U);
    }
  }
}

/// How many support fits have been laid, and couplings found, in the last step.
struct Laid {
  std::vector<std::uint64_t> support_fits;
  std::vector<std::uint64_t> couplings;

  explicit Laid(const World& world) {
    for (const SupportFit& support_fit : world.state.support_fits.column<SupportFit>()) {
      support_fits.push_back(support_fit.serial);
    }
    for (const RegionCoupling& coupling : world.state.couplings.column<RegionCoupling>()) {
      couplings.push_back(
          coupling.serial_to == 0 ? 0 : coupling.serial_to * 100003 + coupling.serial_from);
    }
  }
  /// Of what is there now, how much was not so before; what has been let go does not count.
  static std::size_t newer(const std::vector<std::uint64_t>& now,
                           const std::vector<std::uint64_t>& before) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      count += now[i] != 0 && now[i] != before[i] ? 1U : 0U;
    }
    return count;
  }
};

// Nine feet slide over a cube's top, so that all of their support fits wear out at once: a step
// lays one anew and finds the couplings of one, whatever the speed, and the force does not jump
// when it does. When the feet touch down, each support fit is laid at once.
TEST(ComplianceTest, AStepRefitsOneSupportAndTheForceDoesNotJump) {
  std::vector<PartDescription> feet;
  for (int i = 0; i < 9; ++i) {
    feet.push_back(test::make_part(
        ShapeKind::kSphere, glm::dvec3(0.01),
        {glm::dvec3(0.03 * (i % 3 - 1), 0.0, 0.03 * (i / 3 - 1)), glm::dquat(1.0, 0.0, 0.0, 0.0)}));
  }
  SceneDescription scene =
      box_scene(glm::dvec3(0.06), std::move(feet), ContactModel::kMdr, BodyModel::kCompliance);
  scene.bodies[0].friction = {0.3, 0.3};
  Hand hand(scene);
  hand.step_to({{glm::dvec3(0.0, 0.13, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  Laid before(hand.world());
  std::size_t most_support_fits = 0;
  std::size_t most_couplings = 0;
  std::size_t laid = 0;
  double jump = 0.0;
  glm::dvec3 force(0.0);
  for (int step = 0; step < 700; ++step) {
    const bool presses = step < 100;
    const std::uint32_t regions = hand.world().state.regions.size();
    hand.move(presses ? glm::dvec3(0.0, -1e-5, 0.0) : glm::dvec3(2e-5, 0.0, 1e-5),
              glm::dvec3(0.0, 1.0, 0.0), 0.0, 1);
    const Laid now(hand.world());
    const std::size_t support_fits = Laid::newer(now.support_fits, before.support_fits);
    most_support_fits =
        std::max(most_support_fits, support_fits - (hand.world().state.regions.size() - regions));
    most_couplings = std::max(most_couplings, Laid::newer(now.couplings, before.couplings));
    if (step > 300) {
      laid += support_fits;
      jump = std::max(jump, glm::distance(hand.wrench().force, force) / glm::length(force));
    }
    force = hand.wrench().force;
    before = now;
  }
  EXPECT_EQ(hand.world().state.regions.size(), 9U);
  EXPECT_EQ(most_support_fits, 1U);
  EXPECT_LE(most_couplings, 16U);
  EXPECT_GT(laid, 9U);
  EXPECT_LT(jump, 0.003);
}

TEST(ComplianceTest, SaysHowFarItIsWhileItIsFound) {
  SceneDescription scene =
      box_scene(glm::dvec3(0.03), {ball_at(0.0)}, ContactModel::kMdr, BodyModel::kCompliance);
  scene.bodies.push_back(scene.bodies.front());
  std::vector<double> shares;
  PrepareOptions options;
  options.use_cache = false;
  options.progress = [&shares](double share) {
    shares.push_back(share);
  };
  const Hand two_bodies(scene, options);
  ASSERT_GE(shares.size(), 10U);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GE(shares.front(), 0.0);
  EXPECT_LT(shares.front(), 0.2);
  EXPECT_EQ(shares.back(), 1.0);
  // One body is half of the work.
  EXPECT_NE(std::ranges::find(shares, 0.5), shares.end());
  shares.clear();
  options.body_model = BodyModel::kNone;
  const Hand without(scene, options);
  EXPECT_TRUE(shares.empty());
}

}  // namespace
}  // namespace torsion::engine
