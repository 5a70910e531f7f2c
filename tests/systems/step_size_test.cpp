// The same path in a hundred steps and in ten thousand: force and torque are functions of the path,
// not of how it is cut.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/reference/exact/torque_limits.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::Hand;
using test::kBallDepth;
using test::kBallRadius;
using test::make_ball_scene;
using test::options_of;

constexpr int kCoarseSteps = 100;
constexpr int kFineSteps = 10000;
constexpr double kDuration = 10.0;  // s: what a region's beginning fades in is over in 10 ms

struct StepCase {
  const char* name;
  BallScene scene;
  BodyModel body = BodyModel::kNone;
};

void PrintTo(const StepCase& each, std::ostream* out) {
  *out << each.name;
}

const StepCase kStepCases[] = {
    {"MdrRubber", {.model = ContactModel::kMdr}},
    {"MdrCompressible", {.model = ContactModel::kMdr, .poisson = 0.3}},
    {"PatchRubber", {}},
    {"PatchCompressible", {.poisson = 0.3}},
    {"PatchDefaultGrid", {.side = 0}},
    {"PatchDefaultGridCompressible", {.poisson = 0.3, .side = 0}},
    {"MdrOnABodyThatGivesWay",
     {.model = ContactModel::kMdr, .poisson = 0.3},
     BodyModel::kCompliance},
    {"PatchOnABodyThatGivesWay", {.poisson = 0.3, .side = 12}, BodyModel::kCompliance},
};

/// A place on the path, in units of the depth, of the slide that makes everything slip, and of the
/// turn that would make the saturated torque if nothing slipped.
struct Corner {
  double time;  // of the whole; a multiple of a coarse step
  double depth;
  double slide;
  double turn;
};

/// Twists and slides to where about half has slipped, presses on meanwhile, lifts a little; turns
/// back half of the way, so that at the end history is all that there is.
constexpr std::array<Corner, 5> kPath = {{{0.0, 1.0, 0.0, 0.0},
                                          {0.3, 1.0, 0.1, 0.5},
                                          {0.5, 1.06, 0.35, 0.6},
                                          {0.7, 1.0, 0.2, 0.4},
                                          {1.0, 1.0, 0.2, 0.1}}};

/// The ball's pose after this step of so many. Straight between the corners, which both cuts have.
Pose pose_at(int step, int steps) {
  // mu E* / Gt of the depth (Cattaneo and Mindlin), and the natural turn T_sat / K0 = (9 pi / 256)
  // mu F / (G a^2); at nu = 0.5, which other materials may be pushed as far as.
  constexpr double kSlide = 1.5 * test::kBallFriction * kBallDepth;
  constexpr double kTurn = 0.0401;  // rad
  const double time = static_cast<double>(step) / steps;
  const auto after =
      std::ranges::find_if(kPath.begin() + 1, kPath.end(),
                           [time](const Corner& corner) { return corner.time >= time - 1e-12; });
  const Corner& to = *after;
  const Corner& from = *(after - 1);
  const double share = (time - from.time) / (to.time - from.time);
  const double depth = kBallDepth * std::lerp(from.depth, to.depth, share);
  const double slide = kSlide * std::lerp(from.slide, to.slide, share);
  const double turn = kTurn * std::lerp(from.turn, to.turn, share);
  return {{slide, 0.1 + kBallRadius - depth, 0.4 * slide},
          glm::angleAxis(turn, glm::dvec3(0.0, 1.0, 0.0))};
}

struct Curve {
  std::vector<Wrench> wrenches;  // at every pose that the coarse path has
  double softness = 0.0;         // how far the body deflects along the surface, over the contact
};

/// The body's compliance along its surface times the contact's stiffness without slip (Mindlin).
double softness_of(const World& world, double poisson) {
  const glm::dvec3& moved = world.state.regions.at<RegionSupport>(0).translation;
  const glm::dvec2& force = world.state.regions.at<RegionFriction>(0).force;
  const double stiffness =
      8.0 * test::kBallShearModulus * world.state.regions.at<Contact>(0).radius / (2.0 - poisson);
  return stiffness * std::hypot(moved.x, moved.z) / glm::length(force);
}

/// Pressed alike whatever the cut, and first as deep as the path goes: how a grid of patch follows
/// a contact that grows decides which staircase of a rim it ends with, and two of them are as far
/// apart as each is from the circle.
Curve curve(const StepCase& each, int steps) {
  SceneDescription scene = make_ball_scene(each.scene);
  scene.bodies[0].models.body = each.body;
  PrepareOptions options = options_of(each.scene);
  options.rate = steps / kDuration;
  Hand hand(scene, options);
  Pose over = pose_at(0, steps);
  const glm::dvec3 down(0.0, -1.02 * kBallDepth, 0.0);
  const glm::dvec3 deeper(0.0, -0.06 * kBallDepth, 0.0);
  over.position -= down;
  hand.step_to({over});
  hand.move(down + deeper, down, 0.0, 100);
  hand.move(-deeper, down, 0.0, 20);
  hand.move(glm::dvec3(0.0), down, 0.0, 20);
  Curve found;
  for (int step = 1; step <= steps; ++step) {
    hand.step_to({pose_at(step, steps)});
    if (step % (steps / kCoarseSteps) == 0) {
      found.wrenches.push_back(hand.wrench());
    }
  }
  found.softness = softness_of(hand.world(), each.scene.poisson);
  EXPECT_EQ(hand.clock().faults_ever, 0U);
  return found;
}

/// What a curve has, of one kind: N or N m.
struct Load {
  const char* name;
  glm::dvec3 (*of)(const Wrench&);
  double limit;
};

/// Of a contact that presses with this force, N, at most: mu F, and Lubkin's (3 pi / 16) mu F a.
std::array<Load, 3> loads_of(double force, double poisson) {
  const double modulus = 2.0 * test::kBallShearModulus / (1.0 - poisson);
  const double radius = std::cbrt(0.75 * force * kBallRadius / modulus);
  const double friction = test::kBallFriction * force;
  return {{{"normal force",
            [](const Wrench& wrench) { return glm::dvec3(0.0, wrench.force.y, 0.0); }, force},
           {"friction",
            [](const Wrench& wrench) { return glm::dvec3(wrench.force.x, 0.0, wrench.force.z); },
            friction},
           {"couple", [](const Wrench& wrench) { return glm::dvec3(0.0, wrench.torque.y, 0.0); },
            reference::torque_limit_factor(reference::PressureShape::kHertz) * friction * radius}}};
}

/// The largest of a load, and the largest difference of two neighbours.
struct Extent {
  double most = 0.0;
  double step = 0.0;
};

Extent extent_of(const Load& load, const std::vector<Wrench>& wrenches) {
  Extent extent;
  glm::dvec3 before = load.of(wrenches.front());
  for (const Wrench& wrench : wrenches) {
    extent.most = std::max(extent.most, glm::length(load.of(wrench)));
    extent.step = std::max(extent.step, glm::distance(load.of(wrench), before));
    before = load.of(wrench);
  }
  return extent;
}

class StepSizeTest : public testing::TestWithParam<StepCase> {};

// The issue asks for half a per cent of the largest loads. mdr sees a body that deflects from
// where it was a step before, and finds the body's motion by one Newton step with the contact's
// stiffness K as if nothing slipped. In steady motion with a stiffness k, 0 <= k <= K, over a body
// of compliance C that is behind by C k (1 + C K) / (1 + C k) of what a step adds to the force: by
// C K at most.
TEST_P(StepSizeTest, AHundredStepsAndTenThousandGiveTheSameCurves) {
  const Curve coarse = curve(GetParam(), kCoarseSteps);
  const Curve fine = curve(GetParam(), kFineSteps);
  ASSERT_EQ(coarse.wrenches.size(), fine.wrenches.size());
  const bool is_behind = GetParam().scene.model == ContactModel::kMdr;
  const double behind = is_behind ? fine.softness : 0.0;
  double normal = 0.0;
  for (const Wrench& wrench : fine.wrenches) {
    normal = std::max(normal, wrench.force.y);
  }
  for (const Load& load : loads_of(normal, GetParam().scene.poisson)) {
    const Extent extent = extent_of(load, fine.wrenches);
    const double bound = 0.005 * load.limit + behind * extent.step;
    for (std::size_t i = 0; i < fine.wrenches.size(); ++i) {
      EXPECT_LE(glm::distance(load.of(coarse.wrenches[i]), load.of(fine.wrenches[i])), bound)
          << load.name << " " << i;
    }
    // It is partial slip that is compared.
    EXPECT_GT(extent.most, 0.15 * load.limit) << load.name;
    EXPECT_TRUE(extent.most < 0.7 * load.limit || load.limit == normal) << load.name;
  }
  // And a torque that has come back from its largest, at half of the time.
  EXPECT_LT(std::abs(fine.wrenches.back().torque.y), 0.5 * std::abs(fine.wrenches[49].torque.y));
}

INSTANTIATE_TEST_SUITE_P(Cases, StepSizeTest, testing::ValuesIn(kStepCases),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace torsion::engine
