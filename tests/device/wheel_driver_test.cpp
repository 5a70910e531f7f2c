// A wheel's driver over a bus and a clock that are made up.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/device/device_client.hpp"
#include "tests/device/fake_bus.hpp"

namespace torsion::engine {
namespace {

using test::DeviceClient;
using test::EmulatedWheel;
using test::FakeBus;
using test::kStartTime;
using test::torque_of;
using test::with_wheel_torque;

double angle_of(const DeviceSample& sample) {
  return 2.0 * std::atan2(sample.pose.rotation.y, sample.pose.rotation.w);
}

TEST(WheelDriverTest, TurnsTheTurnAxisAndTakesTorqueInNewtonMetres) {
  for (const bool is_other : {false, true}) {
    SCOPED_TRACE(is_other);
    DeviceClient client;
    FakeBus bus(with_wheel_torque(), client.sink());
    EmulatedWheel wheel;
    wheel.is_other = is_other;
    wheel.turn = 0.7;
    const std::size_t row = bus.plug(wheel);
    bus.run(kStartTime);
    ASSERT_EQ(client.last.state, DeviceState::kLive);
    EXPECT_EQ(client.last.sensed, kTurnAxis);
    EXPECT_EQ(client.last.actuated, kTurnAxis);
    // To the right is clockwise from above.
    const double count = wheel.range / 65535.0;
    EXPECT_NEAR(angle_of(client.last), -0.7, count);
    EXPECT_NEAR(client.last.traits.encoder_turn_step, count, 1e-4 * count);
    const double torque_count = wheel.full_scale / (is_other ? 127.0 : 32767.0);
    EXPECT_NEAR(torque_of(bus.device<EmulatedWheel>(row)), 0.05, torque_count);
    client.wanted.torque.y = -3.0;  // more than --knob-torque allows
    bus.run(0.01);
    EXPECT_NEAR(torque_of(bus.device<EmulatedWheel>(row)), -0.2, torque_count);
    bus.device<EmulatedWheel>(row).turn = -1.2;
    bus.run(0.01);
    EXPECT_NEAR(angle_of(client.last), 1.2, count);
    EXPECT_EQ(bus.device<EmulatedWheel>(row).errors, 0U);
    bus.rest(row);
    bus.run(0.001);
    EXPECT_EQ(torque_of(bus.device<EmulatedWheel>(row)), 0.0);
    EXPECT_FALSE(bus.device<EmulatedWheel>(row).plays);
  }
}

TEST(WheelDriverTest, DisplaysNothingWhereItsFullScaleIsNotKnown) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t row = bus.plug(EmulatedWheel{});
  bus.run(kStartTime);
  // Nothing is said of where it is before it has said so.
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kNotMoved);
  EXPECT_EQ(client.last.state, DeviceState::kStarting);
  bus.device<EmulatedWheel>(row).turn = 0.3;
  bus.send(row, place_of(bus.device<EmulatedWheel>(row)));
  bus.run(0.01);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_NEAR(angle_of(client.last), -0.3, 1e-3);
  EXPECT_EQ(client.last.actuated, kNoAxes);
  EXPECT_EQ(bus.writes(row), 0U);
}

TEST(WheelDriverTest, TurnsItsTorqueRoundWhereToldSo) {
  LoopOptions options = with_wheel_torque();
  options.drivers.wheel_reversed = true;
  DeviceClient client;
  FakeBus bus(options, client.sink());
  const std::size_t row = bus.plug(EmulatedWheel{});
  bus.run(kStartTime);
  EXPECT_NEAR(torque_of(bus.device<EmulatedWheel>(row)), -0.05, 1e-4);
}

// The effect is begun again while the session lives: without a gap, and no longer.
TEST(WheelDriverTest, ItsTorqueLastsAsLongAsSomebodySpeaks) {
  DeviceClient client;
  FakeBus bus(with_wheel_torque(), client.sink());
  const std::size_t row = bus.plug(EmulatedWheel{});
  bus.run(kStartTime);
  for (int i = 0; i < 1000; ++i) {
    bus.run(1e-3);
    ASSERT_NEAR(torque_of(bus.device<EmulatedWheel>(row)), 0.05, 1e-4) << i;
  }
  EmulatedWheel left = bus.device<EmulatedWheel>(row);  // nobody speaks to this one any more
  left.now += 0.05;
  EXPECT_EQ(torque_of(left), 0.0);
}

// A wheel that stands still is silent; it is asked whether it is there, or would be let go of.
TEST(WheelDriverTest, TellsAWheelThatStandsStillFromOneThatIsGone) {
  DeviceClient client;
  FakeBus bus(with_wheel_torque(), client.sink());
  const std::size_t row = bus.plug(EmulatedWheel{});
  bus.run(2.0);
  EXPECT_EQ(bus.without_force_for(row), 0.0);
  EXPECT_EQ(client.last.epoch, 1U);
  EXPECT_GT(bus.device<EmulatedWheel>(row).pings, 100U);
  EXPECT_GT(client.last.rate, 700.0);
  bus.silence(row, true);
  bus.run(5e-3);
  EXPECT_EQ(torque_of(bus.device<EmulatedWheel>(row)), 0.0);
}

TEST(WheelDriverTest, AMotorThatWasSwitchedOffStaysOff) {
  for (const bool power : {false, true}) {
    DeviceClient client;
    FakeBus bus(with_wheel_torque(), client.sink());
    const std::size_t row = bus.plug(EmulatedWheel{});
    bus.run(kStartTime);
    ASSERT_EQ(client.last.state, DeviceState::kLive);
    EmulatedWheel& wheel = bus.device<EmulatedWheel>(row);
    power ? wheel.powered = false : wheel.enabled = false;
    bus.run(5e-3);
    EXPECT_EQ(client.last.trouble, DeviceTrouble::kMotorError);
    EXPECT_EQ(client.last.motor_errors, power ? kWheelWithoutPower : kWheelSwitchedOff);
    wheel.powered = true;
    wheel.enabled = true;
    bus.run(2.0);
    EXPECT_NE(client.last.state, DeviceState::kLive);
    EXPECT_EQ(torque_of(wheel), 0.0);
  }
}

// One that reports 250 times a second while it turns is not taken for one of 1 kHz because the
// driver goes on by itself in between.
TEST(WheelDriverTest, MeasuresHowOftenItReports) {
  DeviceClient client;
  FakeBus bus(with_wheel_torque(), client.sink());
  const std::size_t row = bus.plug(EmulatedWheel{});
  bus.run(kStartTime);
  for (int i = 0; i < 500; ++i) {
    bus.run(4e-3);
    bus.device<EmulatedWheel>(row).turn = 0.5 * std::sin(0.02 * i);
    bus.send(row, place_of(bus.device<EmulatedWheel>(row)));
  }
  EXPECT_NEAR(client.last.rate, 250.0, 25.0);
  // A hand that turns it a count at a time says nothing about its rate.
  DeviceClient slow;
  FakeBus other(with_wheel_torque(), slow.sink());
  const std::size_t place = other.plug(EmulatedWheel{});
  other.run(kStartTime);
  for (int i = 0; i < 500; ++i) {
    other.run(4e-3);
    other.device<EmulatedWheel>(place).turn += EmulatedWheel{}.range / 65534.0;
    other.send(place, place_of(other.device<EmulatedWheel>(place)));
  }
  EXPECT_GT(slow.last.rate, 700.0);
}

TEST(WheelDriverTest, ATimesOutOfItsPacketsEndsTheForce) {
  DeviceClient client;
  FakeBus bus(with_wheel_torque(), client.sink());
  const std::size_t row = bus.plug(EmulatedWheel{});
  bus.run(kStartTime);
  const std::uint64_t number = client.last.number;
  bus.halt_writes(row);
  bus.silence(row, true);
  bus.run(0.06);
  EXPECT_EQ(torque_of(bus.device<EmulatedWheel>(row)), 0.0);
  EXPECT_LT(client.last.number - number, 10U);
  bus.silence(row, false);
  bus.run(2.0);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(bus.without_force_for(row), 0.0);
}

}  // namespace
}  // namespace torsion::engine
