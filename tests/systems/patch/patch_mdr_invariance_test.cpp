#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/math/frames.hpp"
#include "tests/support/studies.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::Hand;
using test::kBallDepth;
using test::make_ball_scene;
using test::options_of;
using test::PressedBall;

constexpr int kPathSteps = 300;

/// Presses, slides and twists, about an axis that is not quite the normal.
/// @param t       0 to 1
/// @param length  scale of all lengths
/// @param hand    -1: mirrored in x = 0
Pose pose_at(double t, double length = 1.0, double hand = 1.0) {
  const glm::dvec3 place(hand * 0.002 * t, 0.15 + 2e-4 - 7e-4 * std::min(1.0, 3.0 * t), 0.001 * t);
  // A mirrored turn is about the mirrored axis, the other way round.
  const glm::dvec3 axis = glm::normalize(glm::dvec3(hand * 0.1, 1.0, -0.05));
  return {length * place, glm::angleAxis(hand * 0.8 * t, axis)};
}

struct InvarianceCase {
  const char* name;
  BallScene scene;
  double mirror;  // bound of the mirrored wrench's difference, relative
};

void PrintTo(const InvarianceCase& model, std::ostream* out) {
  *out << model.name;
}

// The mirror: the samples on the tool are not mirror images. mdr takes all from the shapes, to
// rounding; patch lays its grid by the overlap alone, where iterations end at 1e-9 of it, and
// solves for all cells at once. Grids of even sides lie half a cell aside of the contact's middle,
// to the same hand for mirror images: that must not show either.
const InvarianceCase kInvarianceCases[] = {
    {"mdr", {.model = ContactModel::kMdr, .poisson = 0.45}, 1e-9},
    {"patch12", {.poisson = 0.3, .side = 12}, 1e-8},
    {"patch16", {.poisson = 0.45}, 1e-8},
    {"patch17", {.poisson = 0.5, .side = 17}, 1e-8},
};

// A grid so coarse that its place tells in how many steps it has come there; and the paper's cube,
// whose ports are mirror images, too.
const InvarianceCase kOtherInvarianceCases[] = {
    {"mdr_on_cube",
     {.model = ContactModel::kMdr, .poisson = 0.45, .body = BodyModel::kCompliance},
     1e-8},
    {"patch8", {.poisson = 0.45, .side = 8}, 1e-8},
    {"patch12_on_cube", {.poisson = 0.45, .side = 12, .body = BodyModel::kCompliance}, 1e-8},
    {"patch16_on_cube", {.poisson = 0.3, .body = BodyModel::kCompliance}, 1e-8},
};

class InvariantModelTest : public testing::TestWithParam<InvarianceCase> {
 protected:
  void SetUp() override {
    if (test::is_left_out(std::string_view(GetParam().name) != "patch16_on_cube")) {
      GTEST_SKIP() << test::kLeftOut;
    }
  }
};
class ScaledModelTest : public InvariantModelTest {};

void expect_near(const Wrench& found, const Wrench& expected, double bound) {
  EXPECT_LE(glm::distance(found.force, expected.force),
            bound * glm::length(expected.force) + 1e-300);
  EXPECT_LE(glm::distance(found.torque, expected.torque),
            bound * glm::length(expected.torque) + 1e-300);
}

TEST_P(InvariantModelTest, TheSceneTurnedAndShiftedGivesTheSameForcesTurned) {
  const Pose moved{{12.0, -7.0, 3.0},
                   glm::angleAxis(1.1, glm::normalize(glm::dvec3(0.3, -0.5, 0.8)))};
  const SceneDescription scene = make_ball_scene(GetParam().scene);
  SceneDescription turned = scene;
  turned.bodies[0].pose = moved;
  Hand hand(scene, options_of(GetParam().scene));
  Hand hand_turned(turned, options_of(GetParam().scene));
  for (int i = 0; i <= kPathSteps; ++i) {
    const Pose pose = pose_at(static_cast<double>(i) / kPathSteps);
    hand.step_to({pose});
    hand_turned.step_to({{to_outer(moved, pose.position), moved.rotation * pose.rotation}});
    // Poses 14 m away are rounded to 2e-15 m, 4e-12 of the depth; the issue asks for 1e-6.
    const Wrench expected{moved.rotation * hand.wrench().force,
                          moved.rotation * hand.wrench().torque};
    expect_near(hand_turned.wrench(), expected, 1e-8);
  }
  EXPECT_GT(hand.wrench().force.y, 1.0);
  EXPECT_GT(std::abs(hand.wrench().torque.y), 1e-3);
}

TEST_P(InvariantModelTest, TheMirroredMotionGivesTheMirroredWrench) {
  const SceneDescription scene = make_ball_scene(GetParam().scene);
  Hand hand(scene, options_of(GetParam().scene));
  Hand mirrored(scene, options_of(GetParam().scene));
  for (int i = 0; i <= kPathSteps; ++i) {
    const double t = static_cast<double>(i) / kPathSteps;
    hand.step_to({pose_at(t)});
    mirrored.step_to({pose_at(t, 1.0, -1.0)});
    const Wrench& wrench = hand.wrench();
    expect_near(mirrored.wrench(),
                {{-wrench.force.x, wrench.force.y, wrench.force.z},
                 {wrench.torque.x, -wrench.torque.y, -wrench.torque.z}},
                GetParam().mirror);
  }
}

/// A tool of one exact part over an ellipsoid, moved as pose_at moves the ball; mirrored too.
void expect_mirrored(const PartDescription& part, double low) {
  SceneDescription scene = make_ball_scene({.model = ContactModel::kMdr, .poisson = 0.45});
  const BodyDescription body = test::make_body(
      {test::make_part(ShapeKind::kEllipsoid, {0.07, 0.05, 0.06},
                       {glm::dvec3(0.0, 0.05, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)})});
  scene.bodies[0].parts = body.parts;
  scene.bodies[0].fixed = body.fixed;
  scene.tools[0] = test::make_tool({part});
  Hand hand(scene);
  Hand mirrored(scene);
  glm::dvec3 largest(0.0);
  for (int i = 0; i <= kPathSteps; ++i) {
    const double t = static_cast<double>(i) / kPathSteps;
    Pose pose = pose_at(t);
    Pose mirror = pose_at(t, 1.0, -1.0);
    pose.position.y += low - 0.05;
    mirror.position.y += low - 0.05;
    hand.step_to({pose});
    mirrored.step_to({mirror});
    const Wrench& wrench = hand.wrench();
    expect_near(mirrored.wrench(),
                {{-wrench.force.x, wrench.force.y, wrench.force.z},
                 {wrench.torque.x, -wrench.torque.y, -wrench.torque.z}},
                1e-6);
    largest = glm::max(largest, glm::abs(wrench.torque));
  }
  EXPECT_GT(largest.y, 1e-3);
}

TEST(MdrInvarianceTest, MirroredMotionsOfLongShapesOnAnEllipsoidAreTheSame) {
  // The 1e-6 for exact shapes, where curvatures differ and the contact rolls.
  expect_mirrored(test::make_part(ShapeKind::kEllipsoid, {0.06, 0.05, 0.04}), 0.05);
  const Pose lying{glm::dvec3(0.0), glm::angleAxis(-1.5707963267948966, glm::dvec3(0.0, 0.0, 1.0))};
  expect_mirrored(test::make_part(ShapeKind::kCapsule, {0.015, 0.035, 0.015}, lying), 0.015);
}

/// Scales of length and of Young's modulus.
struct Scale {
  double length;
  double modulus;
};

/// The ball scene with both scaled.
SceneDescription scaled_scene(const BallScene& ball, const Scale& scale) {
  SceneDescription scene = make_ball_scene(ball);
  const glm::dvec3 half(0.05 * scale.length);
  const BodyDescription body = test::make_body({test::make_part(
      ShapeKind::kBox, half, {glm::dvec3(0.0, half.y, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)})});
  scene.bodies[0].parts = body.parts;
  scene.bodies[0].fixed = body.fixed;
  scene.bodies[0].elasticity.youngs_modulus *= scale.modulus;
  scene.tools[0] = test::make_tool({test::make_part(ShapeKind::kSphere, half)});
  return scene;
}

void expect_scaled(const BallScene& ball, const Scale& scale, double bound) {
  Hand hand(make_ball_scene(ball), options_of(ball));
  Hand scaled(scaled_scene(ball, scale), options_of(ball));
  const double force = scale.modulus * scale.length * scale.length;
  for (int i = 0; i <= kPathSteps; ++i) {
    const double t = static_cast<double>(i) / kPathSteps;
    hand.step_to({pose_at(t)});
    scaled.step_to({pose_at(t, scale.length)});
    const Wrench& wrench = scaled.wrench();
    expect_near({wrench.force / force, wrench.torque / (force * scale.length)}, hand.wrench(),
                bound);
  }
}

TEST_P(ScaledModelTest, PowersOfTwoScaleToTheBit) {
  // By Buckingham's theorem forces go with E L^2 and torques with E L^3: nothing in the models is
  // an absolute length or pressure, and powers of two round nothing.
  for (const Scale& scale : {Scale{8.0, 8.0}, {64.0, 1.0}, {1.0 / 64.0, 1.0}, {1.0, 1024.0}}) {
    expect_scaled(GetParam().scene, scale, 0.0);
  }
}

TEST_P(ScaledModelTest, OneMillimetreToTenMetresAndRubberToDiamondScale) {
  // The 1e-6. Rounding moves no more than itself.
  const double bound = GetParam().scene.model == ContactModel::kMdr ? 1e-9 : 1e-6;
  for (const Scale& scale :
       {Scale{10.0, 10.0}, {0.01, 1.0}, {100.0, 1.0}, {1.0, 1e-3}, {1.0, 1e5}}) {
    expect_scaled(GetParam().scene, scale, bound);
  }
}

/// Friction over its limit and couple over its largest, after three straight legs.
std::array<double, 3> after_three_legs(const BallScene& scene, int steps) {
  PressedBall ball(scene);
  ball.press(kBallDepth, 200);
  const double slide = reference::full_slip_displacement(ball.mindlin());
  const double limit = reference::full_slip_force(ball.mindlin());
  const double largest = reference::saturated_torque(ball.lubkin());
  const double turn = largest / reference::torsional_stiffness(ball.lubkin());
  ball.go(kBallDepth, {0.5 * slide, 0.2 * slide}, 0.8 * turn, steps);
  ball.go(1.2 * kBallDepth, {-0.8 * slide, 0.3 * slide}, -1.5 * turn, steps);
  ball.go(kBallDepth, {3.0 * slide, 0.0}, turn, steps);
  return {ball.friction().x / limit, ball.friction().y / limit, ball.couple() / largest};
}

TEST_P(ScaledModelTest, TheSamePathInMoreStepsEndsAlike) {
  if (test::is_left_out(GetParam().scene.side <= 12 ||
                        GetParam().scene.model == ContactModel::kMdr)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  // The issue: a hundred steps and ten thousand within 0.5 % of the largest loads.
  const std::array<double, 3> fine = after_three_legs(GetParam().scene, 10000);
  for (const int steps : {100, 200, 400, 800}) {
    const std::array<double, 3> coarse = after_three_legs(GetParam().scene, steps);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(coarse[k], fine[k], 0.005) << steps << " " << k;
    }
  }
}

// What a step's last iteration leaves must not lead friction astray from step to step. Two
// iterations did by 0.012, with 800 steps and with 10000.
TEST_P(ScaledModelTest, MoreIterationsEndAlike) {
  constexpr int kSteps = 800;
  BallScene longer = GetParam().scene;
  longer.iterations = 40;
  const std::array<double, 3> found = after_three_legs(GetParam().scene, kSteps);
  const std::array<double, 3> solved = after_three_legs(longer, kSteps);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(found[k], solved[k], 5e-4) << k;
  }
}

TEST_P(ScaledModelTest, TheSamePathAgainGivesTheSameBits) {
  EXPECT_EQ(after_three_legs(GetParam().scene, 200), after_three_legs(GetParam().scene, 200));
}

std::string name_of_case(const testing::TestParamInfo<InvarianceCase>& instance) {
  return instance.param.name;
}

INSTANTIATE_TEST_SUITE_P(Models, InvariantModelTest, testing::ValuesIn(kInvarianceCases),
                         name_of_case);
INSTANTIATE_TEST_SUITE_P(Others, InvariantModelTest, testing::ValuesIn(kOtherInvarianceCases),
                         name_of_case);
INSTANTIATE_TEST_SUITE_P(Models, ScaledModelTest, testing::ValuesIn(kInvarianceCases),
                         name_of_case);

}  // namespace
}  // namespace torsion::engine
