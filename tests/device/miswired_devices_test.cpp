// Devices whose motors or encoders are the wrong way round, or that are calibrated wrongly, in
// hands from loose to firm, through their drivers: what they may do to the hand.

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtx/component_wise.hpp>
#include <gtest/gtest.h>

#include "systems/hold/handle_side.hpp"
#include "tests/device/fake_bus.hpp"
#include "tests/device/handled_device.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

using test::EmulatedDevice;
using test::EmulatedFalcon;
using test::EmulatedMoteus;
using test::EmulatedOdrive;
using test::EmulatedWheel;
using test::EmulatedWooden;
using test::FakeBus;
using test::HandledDevice;
using test::HandTraits;
using test::Miswiring;

const std::array<EmulatedDevice, 5> kDevices = {
    EmulatedFalcon{}, EmulatedWooden{}, EmulatedOdrive{}, EmulatedMoteus{}, EmulatedWheel{}};
constexpr std::array<const char*, 5> kDeviceNames = {"Falcon", "WoodenHaptics", "ODrive", "moteus",
                                                     "wheel"};
constexpr std::size_t kFalcon = 0;
constexpr std::size_t kWooden = 1;
constexpr std::size_t kWheel = 4;

/// A tool that stays where it is taken hold of.
struct StillTool {
  HandleSide side;
  HandleOutcome last;
  Pose taken;
  DeviceTraits traits;

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    auto& tool = *static_cast<StillTool*>(context);
    PhysicsResult physics;
    physics.any = true;
    physics.time = sample.time;
    if (tool.side.guard.state == GuardState::kWaiting) {
      tool.taken = {sample.pose.position, glm::dquat(1.0, 0.0, 0.0, 0.0)};
    }
    physics.tool = tool.taken;
    tool.traits = sample.traits;
    tool.last = take_handle_sample(tool.side, sample, physics, sample.time);
    return tool.last.sent;
  }
};

struct Seen {
  StillTool tool;
  double most_pushed = 0.0;    // of what its motors may be told
  double most_in_check = 0.0;  // N or N m: until its signs were known, of the largest
  double farthest = 0.0;       // m or rad: of the handle from where the hand wanted it to be
  double ripple = 0.0;  // of its largest force, peak to peak along an axis, in the last half second
  double most_at_the_end = 0.0;  // what its motors held in that time, of their largest
};

/// Of a device that turns only: rad.
double way_of(const MovingFrame& handle, const Pose& wanted, bool turns) {
  return turns ? glm::angle(glm::conjugate(wanted.rotation) * handle.pose.rotation)
               : glm::length(handle.pose.position - wanted.position);
}

/// Ten seconds: the signs are checked, the force rises, and after six the hand goes 4 mm down, or
/// 0.2 rad on.
Seen session(std::size_t kind, const HandTraits& hand, const Miswiring& wrong, std::uint32_t seed) {
  constexpr double kPart = 5e-4;  // s
  Seen seen;
  FakeBus bus(test::with_wheel_torque(), {&seen.tool, StillTool::on_sample});
  const std::size_t row = bus.plug(kDevices[kind]);
  HandledDevice handled(hand, wrong, seed);
  const bool turns = kind > kWooden;
  glm::dvec3 low(1e9);
  glm::dvec3 high(-1e9);
  for (int i = 0; i * kPart < 10.0; ++i) {
    const double now = i * kPart;
    Pose wanted;
    const double share = std::clamp(now - 6.0, 0.0, 1.0);
    wanted.position.y = turns ? 0.0 : -4e-3 * share;
    wanted.rotation = glm::angleAxis(turns ? 0.2 * share : 0.0, glm::dvec3(0.0, 1.0, 0.0));
    if (now > 0.3) {  // it was set up while nobody touched it
      handled.move(bus.device(row), wanted, kPart);
    }
    bus.run(kPart);
    const Wrench& wrench = seen.tool.last.sent;
    const VirtualCoupling& coupling = seen.tool.side.coupling;
    const glm::dvec3 sent = turns ? wrench.torque : wrench.force;
    const double most = turns ? coupling.largest_torque : coupling.largest_force;
    seen.farthest = std::max(seen.farthest, way_of(handled.handle(), wanted, turns));
    if (seen.tool.side.guard.state == GuardState::kChecking) {
      seen.most_in_check = std::max(seen.most_in_check, glm::length(sent) / most);
    }
    if (now > 9.5) {
      low = glm::min(low, sent);
      high = glm::max(high, sent);
      seen.ripple = glm::compMax(high - low) / most;
      seen.most_at_the_end = std::max(seen.most_at_the_end, test::share_pushed(bus.device(row)));
    }
  }
  seen.most_pushed = bus.most_pushed(row);
  return seen;
}

/// What a count of its encoders comes to, of its largest force or torque.
double one_count(const VirtualCoupling& coupling, const DeviceTraits& traits, bool turns) {
  return turns ? coupling.turn_stiffness * traits.encoder_turn_step / coupling.largest_torque
               : coupling.stiffness * traits.encoder_step / coupling.largest_force;
}

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A hand at random, with as much more of everything as a wheel has.
HandTraits hand_of(std::size_t kind, std::mt19937& random) {
  HandTraits hand = test::random_hand(random);
  hand.tremor = 0.0;
  hand.encoder_step = 0.0;  // the device counts by itself
  hand.encoder_turn_step = 0.0;
  hand.delay = 0;
  hand.largest_force = 100.0;  // likewise its driver and its motors limit
  hand.largest_torque = 100.0;
  if (kind == kWheel) {
    constexpr double kMore = 20.0;
    hand.inertia *= kMore;
    hand.grip_turn_stiffness *= kMore;
    hand.grip_turn_damping *= kMore;
    hand.device_turn_damping *= kMore;
  }
  return hand;
}

/// One motor the other way round, or one encoder.
Miswiring reversed(std::size_t kind, std::mt19937& random) {
  Miswiring wrong;
  const std::size_t which = kind > kWooden ? 0 : random() % 3;
  const bool encoder = kind != kFalcon && random() % 2 == 0;
  (encoder ? wrong.encoders : wrong.motors)[which] = -1.0;
  return wrong;
}

/// Motors of half to twice the strength, zeros set elsewhere.
Miswiring miscalibrated(std::size_t kind, std::mt19937& random) {
  Miswiring wrong;
  wrong.strength = std::pow(2.0, between(random, -1.0, 1.0));
  const double most = kind == kFalcon ? 0.01 : 0.15;  // m, rad
  for (glm::length_t i = 0; i < 3 && kind <= kWooden; ++i) {
    wrong.home[i] = between(random, -most, most);
  }
  return wrong;
}

std::uint32_t sessions_of_each() {
  return test::all_cases() ? 400U : test::kSanitized ? 1U : 4U;
}

class MiswiredDevicesTest : public testing::TestWithParam<std::size_t> {};

TEST_P(MiswiredDevicesTest, OneThatIsReversedIsTurnedOff) {
  std::mt19937 random(static_cast<unsigned>(GetParam()) + 3);
  std::uint32_t off = 0;
  double farthest = 0.0;
  double most_in_check = 0.0;
  const std::uint32_t sessions = sessions_of_each();
  for (std::uint32_t i = 0; i < sessions; ++i) {
    const HandTraits hand = hand_of(GetParam(), random);
    const Seen seen = session(GetParam(), hand, reversed(GetParam(), random), i + 1);
    const OutputGuard& guard = seen.tool.side.guard;
    EXPECT_LE(seen.most_pushed, 1.0) << i;
    EXPECT_NE(guard.signs, SignVerdict::kRight) << i;
    if (guard.state == GuardState::kOff) {
      off += 1;
      EXPECT_EQ(seen.most_at_the_end, 0.0) << i;
      farthest = std::max(farthest, seen.farthest);
    }
    most_in_check = std::max(most_in_check, seen.most_in_check);
  }
  std::printf("%-14s reversed: %u of %u turned off; handle off its place by %.3g at most\n",
              kDeviceNames[GetParam()], off, sessions, farthest);
  EXPECT_LE(most_in_check, 0.05 + 1e-9);
  // A wheel that is as stiff and as heavy as its rim is hardly moved by 10 mN m.
  EXPECT_GE(off + 1, GetParam() == kWheel ? sessions / 2 : sessions - sessions / 8);
}

// Dry friction, which real ones have and which lets none of this happen, is left out.
TEST_P(MiswiredDevicesTest, OneThatIsRightOrOnlyCalibratedWronglyIsStill) {
  std::mt19937 random(static_cast<unsigned>(GetParam()) + 11);
  std::uint32_t live = 0;
  double ripple = 0.0;
  const std::uint32_t sessions = sessions_of_each();
  for (std::uint32_t i = 0; i < sessions; ++i) {
    const HandTraits hand = hand_of(GetParam(), random);
    const Miswiring wrong = i % 2 == 0 ? Miswiring{} : miscalibrated(GetParam(), random);
    const Seen seen = session(GetParam(), hand, wrong, i + 1);
    const double count = one_count(seen.tool.side.coupling, seen.tool.traits, GetParam() > kWooden);
    EXPECT_LE(seen.most_pushed, 1.0) << i;
    EXPECT_NE(seen.tool.side.guard.signs, SignVerdict::kReversed) << i;
    // Toggling, at most: a joint's count is some of two axes, and two may toggle.
    EXPECT_LE(seen.ripple, 2.0 * count) << i;
    live += seen.tool.side.guard.state == GuardState::kLive ? 1U : 0U;
    ripple = std::max(ripple, seen.ripple);
  }
  std::printf(
      "%-14s right or calibrated wrongly: %u of %u live, force still to %.2g of its largest\n",
      kDeviceNames[GetParam()], live, sessions, ripple);
  EXPECT_EQ(live, sessions);
}

INSTANTIATE_TEST_SUITE_P(EachDevice, MiswiredDevicesTest,
                         testing::Range(std::size_t{0}, std::size_t{5}));

}  // namespace
}  // namespace torsion::engine
