// A moteus' driver over a bus and a clock that are made up.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/device/device_client.hpp"
#include "tests/device/fake_bus.hpp"

namespace torsion::engine {
namespace {

using test::DeviceClient;
using test::EmulatedMoteus;
using test::FakeBus;
using test::kStartTime;

TEST(MoteusDriverTest, TurnsTheTwistAxisAndTakesTorqueUpToItsLimit) {
  for (const bool on : {false, true}) {  // its bus, before anybody has asked
    DeviceClient client;
    FakeBus bus({}, client.sink());
    EmulatedMoteus knob;
    knob.turns = 2.25;
    knob.bus_is_on = on;
    knob.mode = 1;  // what another program left: a fault, until it is stopped
    knob.fault = 39;
    const std::size_t row = bus.plug(knob);
    bus.run(kStartTime);
    ASSERT_EQ(client.last.state, DeviceState::kLive);
    EXPECT_EQ(client.last.sensed, kTurnAxis);
    EXPECT_NEAR(client.last.pose.rotation.y, std::sin(std::numbers::pi / 4.0), 1e-6);
    EXPECT_NEAR(bus.device<EmulatedMoteus>(row).torque, 0.05, 1e-6);
    EXPECT_NEAR(bus.device<EmulatedMoteus>(row).watchdog, 0.05, 1e-6);
    EXPECT_FALSE(bus.device<EmulatedMoteus>(row).is_stiff);
    EXPECT_EQ(bus.device<EmulatedMoteus>(row).errors, 0U);
    EXPECT_GT(client.last.rate, 900.0);
    client.wanted.torque.y = -3.0;
    bus.run(0.01);
    EXPECT_NEAR(bus.device<EmulatedMoteus>(row).torque, -0.2, 1e-6);
    bus.rest(row);
    bus.run(0.01);
    EXPECT_EQ(bus.device<EmulatedMoteus>(row).torque, 0.0);
    EXPECT_EQ(bus.device<EmulatedMoteus>(row).mode, 0);
  }
}

TEST(MoteusDriverTest, IsToldNothingWhereItsRegistersAreOthers) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  EmulatedMoteus knob;
  knob.register_map = 4;
  knob.mode = 10;
  knob.torque = 0.0;
  const std::size_t row = bus.plug(knob);
  bus.run(kStartTime);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kWrongFirmware);
  EXPECT_EQ(bus.device<EmulatedMoteus>(row).mode, 10);
  EXPECT_EQ(bus.writes(row), 1U);
}

TEST(MoteusDriverTest, AFaultEndsTheTorqueAndATimeOutIsSetUpAnew) {
  for (const bool fault : {true, false}) {
    DeviceClient client;
    FakeBus bus({}, client.sink());
    const std::size_t row = bus.plug(EmulatedMoteus{});
    bus.run(kStartTime);
    ASSERT_EQ(client.last.state, DeviceState::kLive);
    EmulatedMoteus& knob = bus.device<EmulatedMoteus>(row);
    knob.mode = fault ? 1 : 11;
    knob.fault = fault ? 38 : 0;
    knob.torque = 0.0;
    bus.run(5e-3);
    EXPECT_EQ(client.last.trouble, DeviceTrouble::kMotorError);
    EXPECT_EQ(client.last.motor_errors, fault ? 38U : kMoteusUnfed);
    bus.run(2.0);
    EXPECT_EQ(client.last.state, fault ? DeviceState::kStarting : DeviceState::kLive);
    EXPECT_EQ(bus.without_force_for(row) > 1.9, fault);
  }
}

}  // namespace
}  // namespace torsion::engine
