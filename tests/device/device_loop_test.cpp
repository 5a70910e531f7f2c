// Several devices as one, and devices that are pulled out.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/device/device_client.hpp"
#include "tests/device/fake_bus.hpp"

namespace torsion::engine {
namespace {

using test::DeviceClient;
using test::EmulatedFalcon;
using test::EmulatedOdrive;
using test::EmulatedSpaceMouse;
using test::EmulatedWooden;
using test::FakeBus;
using test::kStartTime;

constexpr double kLetGo = 2e-3;  // s: the longest that a force may outlive what it counted on

TEST(DeviceLoopTest, AFalconMovesAndAKnobTwists) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  EmulatedFalcon falcon;
  falcon.place = {0.02, 0.0, 0.115};
  EmulatedOdrive knob;
  knob.turns = -0.125;
  const std::size_t first = bus.plug(falcon);
  const std::size_t second = bus.plug(knob);
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(client.last.sensed, kTranslationAxes | kTurnAxis);
  EXPECT_EQ(client.last.actuated, kTranslationAxes | kTurnAxis);
  EXPECT_NEAR(client.last.pose.position.x, 0.02, 1e-4);
  EXPECT_LT(client.last.pose.rotation.y, -0.38);  // sin(45 degrees / 2), less
  EXPECT_EQ(bus.without_force_for(first), 0.0);
  EXPECT_NEAR(bus.device<EmulatedOdrive>(second).torque, 0.05, 1e-6);
}

TEST(DeviceLoopTest, ASpaceMouseMovesAndAWheelTurns) {
  DeviceClient client;
  FakeBus bus(test::with_wheel_torque(), client.sink());
  const std::size_t mouse = bus.plug(EmulatedSpaceMouse{});
  test::EmulatedWheel wheel;
  wheel.turn = -0.5;
  const std::size_t second = bus.plug(wheel);
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(client.last.sensed, kTranslationAxes | kRotationAxes | kTurnAxis);
  EXPECT_EQ(client.last.actuated, kTurnAxis);
  for (int i = 0; i < 10; ++i) {
    bus.send(mouse, test::space_mouse_report(1, {350, 0, 0}));
    bus.run(8e-3);
  }
  EXPECT_GT(client.last.pose.position.x, 1e-3);
  EXPECT_NEAR(client.last.pose.rotation.y, std::sin(0.25), 1e-4);
  EXPECT_NEAR(torque_of(bus.device<test::EmulatedWheel>(second)), 0.05, 1e-4);
}

TEST(DeviceLoopTest, AFalconMovesAndASpaceMouseTurns) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  bus.plug(EmulatedFalcon{});
  const std::size_t mouse = bus.plug(EmulatedSpaceMouse{});
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_FALSE(client.last.steers_rate);  // its place is the Falcon's
  for (int i = 0; i < 10; ++i) {
    bus.send(mouse, test::space_mouse_report(1, {350, 0, 0}));
    bus.send(mouse, test::space_mouse_report(2, {350, 0, 0}));
    bus.run(8e-3);
  }
  EXPECT_NEAR(client.last.pose.position.x, 0.0, 1e-4);
  EXPECT_GT(client.last.pose.rotation.x, 0.0);
}

// Stability asks for the period that there is, not for the one that a driver means to keep.
TEST(DeviceLoopTest, ThePeriodIsTheMeasuredOneWhereThatIsLonger) {
  EXPECT_EQ(period_of(1e-3, 0.0), 1e-3);
  EXPECT_EQ(period_of(1e-3, 1250.0), 1e-3);
  EXPECT_EQ(period_of(1e-3, 990.0), 1e-3);
  EXPECT_EQ(period_of(1e-3, 125.0), 8e-3);
  EXPECT_EQ(period_of(1e-3, 1.0), 20e-3);
  DeviceClient client;
  FakeBus bus({}, client.sink());
  bus.plug(EmulatedFalcon{});
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(client.last.traits.period, period_of(1e-3, client.last.rate));
}

TEST(DeviceLoopTest, TwoButtonsOfAFalconTurnTheTool) {
  DeviceClient client;
  LoopOptions options;
  options.turn_buttons = {1U << 1, 1U << 2, 0.5};
  FakeBus bus(options, client.sink());
  const std::size_t falcon = bus.plug(EmulatedFalcon{});
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_TRUE(client.last.buttons_turn);
  EXPECT_EQ(client.last.sensed, kTranslationAxes);
  EXPECT_EQ(client.last.pose.rotation.y, 0.0);
  const auto turned = [&] {
    return 2.0 * std::atan2(client.last.pose.rotation.y, client.last.pose.rotation.w);
  };
  // 0.4 s at 0.5 rad/s, within a packet at each end.
  constexpr double kPackets = 2 * 0.5 * 2e-3;  // rad
  bus.device<EmulatedFalcon>(falcon).buttons = 1U << 1;
  bus.run(0.4);
  EXPECT_NEAR(turned(), 0.2, kPackets);
  bus.device<EmulatedFalcon>(falcon).buttons = 1U << 2;
  bus.run(0.6);
  EXPECT_NEAR(turned(), -0.1, 2.0 * kPackets);
  // Both at once hold it, and so does none.
  bus.device<EmulatedFalcon>(falcon).buttons = 0b110;
  bus.run(0.1);
  const double before = turned();
  bus.run(0.2);
  EXPECT_EQ(turned(), before);
}

TEST(DeviceLoopTest, ButtonsTurnNothingBesideADeviceThatTurns) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t falcon = bus.plug(EmulatedFalcon{});
  bus.plug(EmulatedOdrive{});
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  bus.device<EmulatedFalcon>(falcon).buttons = 1U << 0;
  bus.run(0.2);
  EXPECT_FALSE(client.last.buttons_turn);
  EXPECT_EQ(client.last.pose.rotation.y, 0.0);
}

TEST(DeviceLoopTest, TwoFalconsDisplayATorqueAcrossTheirLine) {
  DeviceClient client;
  client.wanted = {{0.0, 0.0, 0.0}, {0.0, 0.2, 0.0}};
  FakeBus bus({}, client.sink());
  const std::size_t left = bus.plug(EmulatedFalcon{});
  const std::size_t right = bus.plug(EmulatedFalcon{});
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(client.last.actuated, kTranslationAxes | kRotationAxes);
  // 0.2 m apart: 1 N each, opposite, along z.
  const glm::dvec3 place = client.last.pose.position + glm::dvec3(0.0, 0.0, 0.115);
  EXPECT_EQ(bus.device<EmulatedFalcon>(left).motors, falcon_motors(place, {0.0, 0.0, 1.0}));
  EXPECT_EQ(bus.device<EmulatedFalcon>(right).motors, falcon_motors(place, {0.0, 0.0, -1.0}));
}

TEST(DeviceLoopTest, PullingOneOutLetsGoOfTheOthersForce) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t first = bus.plug(EmulatedFalcon{});
  const std::size_t second = bus.plug(EmulatedFalcon{});
  bus.run(kStartTime);
  ASSERT_EQ(bus.without_force_for(second), 0.0);
  const std::uint32_t epoch = client.last.epoch;
  client.wanted = {};  // as a guard does that sees another epoch
  bus.unplug(first);
  bus.run(kLetGo);
  EXPECT_GT(bus.without_force_for(second), 0.0);
  EXPECT_NE(client.last.epoch, epoch);
  EXPECT_EQ(client.last.sensed, kTranslationAxes);  // it goes on by itself
  bus.plug(EmulatedFalcon{});
  bus.run(kStartTime);
  EXPECT_EQ(client.last.actuated, kTranslationAxes | kRotationAxes);
}

TEST(DeviceLoopTest, OneThatIsHeldElsewhereDoesNotKeepTheOthersFromWorking) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  bus.plug(EmulatedFalcon{});
  const std::size_t mouse = bus.plug(EmulatedSpaceMouse{});
  bus.claims(mouse, UsbStatus::kBusy);
  bus.run(kStartTime);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kHeldElsewhere);  // but it is said
}

TEST(DeviceLoopTest, AThousandTimesPulledOutAtRandomMoments) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> moment(0.0, 0.06);
  DeviceClient client;
  FakeBus bus({}, client.sink());
  std::size_t falcon = bus.plug(EmulatedFalcon{});
  std::size_t other = bus.plug(EmulatedOdrive{});
  int live = 0;
  for (int i = 0; i < 1000; ++i) {
    bus.run(moment(random));
    const bool was_live = client.last.state == DeviceState::kLive;
    live += was_live ? 1 : 0;
    const std::uint32_t epoch = client.last.epoch;
    const bool knob = random() % 2 == 0;
    (knob ? bus.unplug(other) : bus.unplug(falcon));
    // What is left may go on, but from another epoch: whoever holds it begins with no force.
    client.wanted = {};
    bus.run(kLetGo);
    if (was_live) {
      ASSERT_GT(bus.without_force_for(knob ? falcon : other), 0.0) << i;
      ASSERT_NE(client.last.epoch, epoch) << i;
    }
    client.wanted = {{0.0, -2.0, 0.0}, {0.0, 0.05, 0.0}};
    bus.run(moment(random));
    if (knob) {
      other = bus.plug(EmulatedOdrive{});
    } else {
      falcon = bus.plug(EmulatedFalcon{});
    }
  }
  EXPECT_GT(live, 500);  // or it would say little
  bus.run(1.0);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(bus.without_force_for(falcon), 0.0);
}

TEST(DeviceLoopTest, NoDeviceIsAskedForMoreThanItsOwnLimit) {
  DeviceClient client;
  // 16 N and 1.6 N m are what the two can do together: both at once would ask one for 16 N.
  client.wanted = {{0.0, 0.0, 16.0}, {0.0, 1.6, 0.0}};
  FakeBus bus({}, client.sink());
  const std::size_t left = bus.plug(EmulatedFalcon{});
  const std::size_t right = bus.plug(EmulatedFalcon{});
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  const glm::dvec3 place(0.0, 0.0, 0.115);
  const auto most = falcon_motors(place, {0.0, 0.0, 8.0});
  for (const std::size_t row : {left, right}) {
    for (std::size_t motor = 0; motor < 3; ++motor) {
      EXPECT_LE(std::abs(int{bus.device<EmulatedFalcon>(row).motors[motor]}),
                std::abs(int{most[motor]}) + 1);
    }
  }
}

}  // namespace
}  // namespace torsion::engine
