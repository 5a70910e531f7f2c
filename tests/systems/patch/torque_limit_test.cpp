// Which pressure does a contact model's largest torque belong to? Engines assume independent
// springs (8/15 mu F a for a ball) or an even pressure (2/3); an elastic half-space has Hertz' for
// a ball (3 pi / 16) and Boussinesq's for a flat end (pi / 4).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "tests/reference/exact/torque_limits.hpp"
#include "tests/support/directions.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using reference::PressureShape;
using test::BallScene;
using test::Hand;
using test::kUp;

constexpr double kPunch = 0.01;       // m: radius of the flat end
constexpr double kPunchDepth = 2e-4;  // m

struct LimitCase {
  const char* name;
  BallScene scene;
  bool is_punch;
  PressureShape expected;
};

void PrintTo(const LimitCase& each, std::ostream* out) {
  *out << each.name;
}

// A model's own radius of contact: Hertz' for springs and cells, the overlap's for paper, which
// spreads its force evenly over that by its own account.
const LimitCase kLimitCases[] = {
    {"BallMdr", {.model = ContactModel::kMdr}, false, PressureShape::kHertz},
    {"BallMdrCompressible",
     {.model = ContactModel::kMdr, .poisson = 0.3},
     false,
     PressureShape::kHertz},
    {"BallPatch16", {.side = 16}, false, PressureShape::kHertz},
    {"BallPatch16Compressible", {.poisson = 0.3, .side = 16}, false, PressureShape::kHertz},
    {"BallPatch24", {.side = 24}, false, PressureShape::kHertz},
    {"BallPaper", {.model = ContactModel::kPaper}, false, PressureShape::kUniform},
    {"PunchMdr", {.model = ContactModel::kMdr}, true, PressureShape::kFlatPunch},
    {"PunchPatch16", {.side = 16}, true, PressureShape::kFlatPunch},
    {"PunchPatch24", {.side = 24}, true, PressureShape::kFlatPunch},
    {"PunchPatch32", {.side = 32}, true, PressureShape::kFlatPunch},
};

class TorqueLimitTest : public testing::TestWithParam<LimitCase> {};

// Neighbouring limits are 10 to 18 % apart, so that 3 % tells them (exact_sliding_test.cpp). Of its
// own force and of the shape's radius: what the rim of a flat end's grid takes from the one it
// takes from the other.
TEST_P(TorqueLimitTest, LargestTorqueIsThatOfTheRightPressureAndOfNoOther) {
  const BallScene& ball = GetParam().scene;
  SceneDescription scene = test::make_ball_scene(ball);
  double lowest = test::kBallRadius;
  double depth = test::kBallDepth;
  double radius = std::sqrt(test::kBallRadius * depth);
  if (GetParam().is_punch) {
    lowest = 0.02;
    depth = kPunchDepth;
    radius = kPunch;
    scene.tools[0] = test::make_tool(
        {test::make_part(ShapeKind::kCylinder, {kPunch, lowest, kPunch}, {}, false, 24)});
  } else if (ball.model == ContactModel::kPaper) {
    radius = std::sqrt(2.0) * radius;  // of the overlap
  }
  Hand hand(scene, test::options_of(ball));
  hand.step_to({{glm::dvec3(0.0, 0.1 + lowest + 1e-6, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  hand.move({0.0, -1e-6 - depth, 0.0}, kUp, 0.0, 200);
  hand.move(glm::dvec3(0.0), kUp, ball.model == ContactModel::kPaper ? 8.0 : 1.0, 600);
  const double factor =
      -hand.wrench().torque.y / (ball.dynamic_friction * hand.wrench().force.y * radius);
  for (const reference::TorqueLimit& limit : reference::kTorqueLimits) {
    const double off = std::abs(factor / limit.factor - 1.0);
    if (limit.shape == GetParam().expected) {
      EXPECT_LE(off, 0.03) << limit.name << " " << factor;
    } else {
      EXPECT_GT(off, 0.03) << limit.name << " " << factor;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, TorqueLimitTest, testing::ValuesIn(kLimitCases),
                         [](const auto& at) { return std::string(at.param.name); });

}  // namespace
}  // namespace torsion::engine
