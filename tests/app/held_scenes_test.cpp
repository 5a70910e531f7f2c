// Every shipped scene in an emulated hand, loose to firm: what the device's thread runs, the step,
// and the hand, with no hardware. TORSION_LOOP_SECONDS=60 holds each for a minute.

#include <cstdlib>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/session.hpp"
#include "device/scripted_motion.hpp"
#include "systems/held_tool/handle_side.hpp"
#include "systems/held_tool/tool_equilibrium.hpp"
#include "systems/rotation_vector.hpp"
#include "tests/support/paths.hpp"
#include "tests/systems/emulated_hand.hpp"

namespace torsion {
namespace {

using test::EmulatedHand;
using test::HandTraits;

constexpr double kPeriod = 1e-3;   // s
constexpr double kApproach = 0.5;  // s: for the part of the animation that is taken

double held_seconds() {
  const char* const wanted = std::getenv("TORSION_LOOP_SECONDS");
  return wanted != nullptr ? std::atof(wanted) : 0.6;
}

/// All grips when it is held for a minute, else the loosest and the firmest.
std::vector<double> grips() {
  return std::getenv("TORSION_LOOP_SECONDS") != nullptr ? std::vector{50.0, 200.0, 1000.0}
                                                        : std::vector{50.0, 1000.0};
}

Session open(const std::string& name, double rate = 1.0 / kPeriod) {
  PrepareOptions options;
  options.rate = rate;
  auto opened = open_session(test::shipped_scene(name), options, true);
  EXPECT_TRUE(opened) << opened.error().text;
  return std::move(opened).value();
}

/// When the animation presses hardest, s.
double hardest(const std::string& name) {
  constexpr double kRate = 100.0;  // Hz: only to find the moment
  Session session = open(name, kRate);
  const auto steps = steps_in(session, session.scene.duration);
  double most = 0.0;
  double time = 0.0;
  for (std::uint64_t i = 0; i < steps; ++i) {
    set_scripted_poses(session);
    step(session.simulation, session.tool_poses);
    const double force = glm::length(session.simulation.world.tools.at<ToolWrench>(0).total.force);
    if (force > most) {
      most = force;
      time = static_cast<double>(i) / kRate;
    }
  }
  return time;
}

struct LoopOutcome {
  double force = 0.0;        // N: length of the mean over the last half of the hold
  double ripple = 0.0;       // N: farthest from it
  double torque = 0.0;       // N m
  double turn_ripple = 0.0;  // N m
  double most_gained = 0.0;  // J: the most that the motors had given to the hand at any time
  double one_sample = 0.0;   // J: the most that they did in one sample
  std::uint32_t faults = 0;
};

/// Farthest and mean of what is felt, gathered over the end of a run.
struct Felt {
  std::vector<glm::dvec3> values;

  [[nodiscard]] glm::dvec3 mean() const {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& value : values) {
      sum += value;
    }
    return sum / static_cast<double>(values.size());
  }
  [[nodiscard]] double farthest() const {
    const glm::dvec3 middle = mean();
    double most = 0.0;
    for (const glm::dvec3& value : values) {
      most = std::max(most, glm::length(value - middle));
    }
    return most;
  }
};

/// The person follows the first tool's animation until `until`, and holds it there.
LoopOutcome hold(const std::string& name, const HandTraits& traits, double until) {
  Session session = open(name);
  const auto& tools = session.scene.tools;
  World& world = session.simulation.world;
  Pose wanted = scripted_pose(tools[0].script, 0.0);
  EmulatedHand hand(traits, wanted);
  HandleSide side;
  side.home = wanted;
  DeviceSample sample;
  sample.state = DeviceState::kLive;
  sample.epoch = 1;
  sample.traits = test::device_of(traits, kPeriod);
  PhysicsResult result;
  LoopOutcome outcome;
  Felt forces;
  Felt torques;
  const double settle = 0.1;  // s: the guard takes hold before the hand moves
  const auto steps = static_cast<int>((settle + kApproach + held_seconds()) / kPeriod);
  const auto last = static_cast<int>(0.5 * held_seconds() / kPeriod);
  double work = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double now = 1.0 + i * kPeriod;
    const double share = std::clamp((i * kPeriod - settle) / kApproach, 0.0, 1.0);
    wanted = scripted_pose(tools[0].script, share * until);
    const Pose measured = hand.measured();
    sample.pose = {measured.position - side.home.position, measured.rotation};
    const HandleOutcome held = take_handle_sample(side, sample, result, now);
    for (std::size_t row = 0; row < tools.size(); ++row) {
      session.tool_poses[row] = scripted_pose(tools[row].script, share * until);
    }
    if (i > 0) {
      session.tool_poses[0] = held.holds ? next_tool_pose(world, 0, side.coupling, held.handle)
                                         : world.tools.at<ToolPose>(0).now;
    }
    step(session.simulation, session.tool_poses);
    const std::uint32_t faults = world.clock.at<Clock>(0).faults;
    result = {world.tools.at<ToolPose>(0).now, now, faults != 0, true};
    outcome.faults |= faults;
    hand.move(held.wrench, wanted, kPeriod);
    outcome.most_gained = std::max(outcome.most_gained, hand.motor_work());
    outcome.one_sample = std::max(outcome.one_sample, std::abs(hand.motor_work() - work));
    work = hand.motor_work();
    if (i >= steps - last) {
      forces.values.push_back(hand.felt().force);
      torques.values.push_back(hand.felt().torque);
    }
  }
  outcome.force = glm::length(forces.mean());
  outcome.ripple = forces.farthest();
  outcome.torque = glm::length(torques.mean());
  outcome.turn_ripple = torques.farthest();
  return outcome;
}

class HeldSceneTest : public testing::TestWithParam<const char*> {};

TEST_P(HeldSceneTest, IsStillInEveryGrip) {
  if (std::string(GetParam()) == "two_bodies") {
    GTEST_SKIP() << "known, docs/devices.md: the bar that lies on two cubes wanders by 1 mm";
  }
  const double until = hardest(GetParam());
  for (const double grip : grips()) {
    HandTraits traits;
    traits.grip_stiffness = grip;
    const LoopOutcome outcome = hold(GetParam(), traits, until);
    SCOPED_TRACE(testing::Message() << "grip " << grip << " N/m");
    EXPECT_EQ(outcome.faults, 0U);
    EXPECT_GT(outcome.force, 0.01);
    EXPECT_LT(outcome.ripple, 0.01 * outcome.force);
    // The controller sees a sample's work when the sample is over.
    EXPECT_LE(outcome.most_gained, outcome.one_sample);
  }
}

TEST_P(HeldSceneTest, StaysStableLateAndCoarse) {
  HandTraits traits;
  traits.delay = 3;
  traits.jitter = 1;
  traits.dropped = 0.1;
  traits.encoder_step = 0.1 / 256.0;  // 8 bits over 100 mm
  traits.encoder_turn_step = 2.0 * 3.141592653589793 / 256.0;
  traits.tremor = 0.05;
  const LoopOutcome outcome = hold(GetParam(), traits, hardest(GetParam()));
  EXPECT_EQ(outcome.faults, 0U);
  // What is lost is stiffness: 0.9 b / (T / 2 + 4 ms) = 200 N/m instead of 1800. Each axis may
  // toggle by a count of the coupling, and the controller answers a count with a fiftieth of the
  // device's force either way: two of each, on three axes.
  const double count = 200.0 * traits.encoder_step;
  EXPECT_LT(outcome.ripple, std::sqrt(3.0) * (2.0 * count + 2.0 * 0.02 * traits.largest_force));
}

INSTANTIATE_TEST_SUITE_P(Shipped, HeldSceneTest,
                         testing::Values("ball_on_cube", "ball_on_cube_soft", "mallet_on_ellipsoid",
                                         "mallet_on_ellipsoid_soft", "compass_on_ellipsoid",
                                         "compass_on_ellipsoid_soft", "many_regions", "two_bodies"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace torsion
