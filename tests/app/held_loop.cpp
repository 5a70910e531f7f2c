#include "tests/app/held_loop.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/session.hpp"
#include "device/scripted_motion.hpp"
#include "systems/hold/handle_side.hpp"
#include "systems/hold/tool_hold.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine::test {
namespace {

constexpr double kPeriod = 1e-3;   // s
constexpr double kApproach = 0.5;  // s: for the part of the animation that is taken

Session open(const HeldScene& scene, double rate = 1.0 / kPeriod) {
  PrepareOptions options;
  options.rate = rate;
  options.contact_model = scene.contact_model;
  options.body_model = scene.body_model;
  const bool is_path = scene.name.find('.') != std::string::npos;
  auto opened =
      open_session(is_path ? source_folder() + "/scenes/" + scene.name : shipped_scene(scene.name),
                   options, true);
  EXPECT_TRUE(opened) << opened.error().text;
  return std::move(opened).value();
}

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

}  // namespace

double hardest(const HeldScene& scene) {
  constexpr double kRate = 100.0;  // Hz: only to find the moment
  Session session = open(scene, kRate);
  const auto steps = steps_in(session, session.scene.duration);
  double most = 0.0;
  double time = 0.0;
  for (std::uint64_t i = 0; i < steps; ++i) {
    set_scripted_poses(session);
    step(session.simulation, session.tool_poses);
    const double force =
        glm::length(session.simulation.world.state.tools.at<ToolWrench>(0).total.force);
    if (force > most) {
      most = force;
      time = static_cast<double>(i) / kRate;
    }
  }
  return time;
}

LoopOutcome hold(const HeldScene& scene, const HandTraits& traits, double until, double seconds,
                 const std::function<void(const World&)>& after_step) {
  Session session = open(scene);
  const auto& tools = session.scene.tools;
  World& world = session.simulation.world;
  Pose wanted = scripted_pose(tools[0].script, 0.0);
  EmulatedHand hand(traits, wanted);
  HandleSide side;
  side.home = wanted;
  side.limits.first_rise = side.limits.rise;  // what comes after the first second is looked at
  DeviceSample sample;
  sample.state = DeviceState::kLive;
  sample.epoch = 1;
  sample.sensed = kTranslationAxes | kRotationAxes;
  sample.traits = device_of(traits, kPeriod);
  PhysicsResult result;
  LoopOutcome outcome;
  Felt forces;
  Felt torques;
  const double settle = 0.1;  // s: the guard takes hold before the hand moves
  const auto steps = static_cast<int>((settle + kApproach + seconds) / kPeriod);
  const auto last = static_cast<int>(0.5 * seconds / kPeriod);
  double work = 0.0;
  double work_at_rest = 0.0;
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
      session.tool_poses[0] =
          held.holds ? next_tool_pose(world.model, world.state, 0, side.coupling, held.handle)
                     : world.state.tools.at<ToolPose>(0).now;
    }
    step(session.simulation, session.tool_poses);
    if (after_step) {
      after_step(world);
    }
    const std::uint32_t faults = world.state.clock.faults;
    result = {world.state.tools.at<ToolPose>(0).now, now, faults != 0, true};
    outcome.faults |= faults;
    hand.move(held.wrench, wanted, kPeriod);
    outcome.most_gained = std::max(outcome.most_gained, hand.motor_work());
    outcome.one_sample = std::max(outcome.one_sample, std::abs(hand.motor_work() - work));
    work = hand.motor_work();
    work_at_rest = i < steps - last ? work : work_at_rest;
    if (i >= steps - last) {
      outcome.gained_at_rest = std::max(outcome.gained_at_rest, work - work_at_rest);
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

}  // namespace torsion::engine::test
