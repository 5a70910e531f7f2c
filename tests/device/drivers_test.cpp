// Each driver over a bus and a clock that are made up: its whole life (driver_faults_test.cpp: what
// may go wrong on the wire).

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/device/device_client.hpp"
#include "tests/device/fake_bus.hpp"

namespace torsion::engine {
namespace {

using test::Buffer;
using test::DeviceClient;
using test::EmulatedFalcon;
using test::EmulatedOdrive;
using test::EmulatedSpaceMouse;
using test::EmulatedWooden;
using test::FakeBus;
using test::kStartTime;

TEST(SpaceMouseDriverTest, SteersAtTheSpeedOfItsDeflection) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t row = bus.plug(EmulatedSpaceMouse{});
  bus.run(0.1);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_TRUE(client.last.steers_rate);
  EXPECT_TRUE(bus.device<EmulatedSpaceMouse>(row).light);
  // Full deflection to the right: 0.1 m/s, for as long as it is repeated.
  for (int i = 0; i < 125; ++i) {
    bus.send(row, test::space_mouse_report(1, {350, 0, 0}));
    bus.run(8e-3);
  }
  bus.send(row, test::space_mouse_report(1, {0, 0, 0}));
  bus.run(0.1);
  EXPECT_NEAR(client.last.pose.position.x, 0.1, 2e-3 * 0.1 + 1e-4);
  EXPECT_EQ(client.last.pose.position.y, 0.0);
  EXPECT_NEAR(client.last.rate, 1000.0, 50.0);
}

TEST(SpaceMouseDriverTest, ForgetsADeflectionThatNobodyRepeats) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t row = bus.plug(EmulatedSpaceMouse{});
  bus.run(0.1);
  bus.send(row, test::space_mouse_report(1, {350, 0, 0}));
  bus.run(5.0);
  EXPECT_LT(client.last.pose.position.x, 0.1 * 0.26);  // a quarter of a second at 0.1 m/s
}

TEST(SpaceMouseDriverTest, ReadsAKnownOneThatDoesNotSayWhatItIs) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  EmulatedSpaceMouse mouse;
  mouse.has_descriptor = false;
  const std::size_t row = bus.plug(mouse);
  bus.run(0.2);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  bus.send(row, test::space_mouse_report(2, {0, 0, -350}));  // raw z is down: a turn about world y
  bus.run(0.1);
  EXPECT_GT(client.last.pose.rotation.y, 0.0);
}

TEST(SpaceMouseDriverTest, ReportsOfItsBatteryAreNoGarbage) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t row = bus.plug(EmulatedSpaceMouse{});
  bus.run(0.1);
  bus.send(row, {0x17, 80, 0});
  bus.send(row, {0x1C, 1});
  bus.run(0.05);
  EXPECT_EQ(bus.loop().rows[row].report.counts.garbage, 0U);
  bus.send(row, {0x55, 1, 2, 3});
  bus.run(0.05);
  EXPECT_EQ(bus.loop().rows[row].report.counts.garbage, 1U);
}

TEST(FalconDriverTest, SaysItsPlaceAndTakesForce) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  EmulatedFalcon falcon;
  falcon.place = {0.01, -0.02, 0.12};
  const std::size_t row = bus.plug(falcon);
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  // One count of an encoder is 0.036 degrees, at most 64 um at the grip for each of three legs.
  EXPECT_NEAR(glm::length(client.last.pose.position - glm::dvec3(0.01, -0.02, 0.005)), 0.0, 1e-4);
  EXPECT_GT(client.last.rate, 900.0);
  EXPECT_EQ(client.last.sensed, kTranslationAxes);
  const auto expected =
      falcon_motors(client.last.pose.position + glm::dvec3(0.0, 0.0, 0.115), client.wanted.force);
  EXPECT_EQ(bus.device<EmulatedFalcon>(row).motors, expected);
}

TEST(FalconDriverTest, AsksForFirmwareThatItDoesNotHave) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  EmulatedFalcon falcon;
  falcon.has_firmware = false;
  bus.plug(falcon);
  bus.run(2.0);
  EXPECT_EQ(client.last.state, DeviceState::kStarting);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kNoFirmware);
}

Buffer made_up_firmware() {
  Buffer bytes(1500);  // no multiple of the 62 bytes of a piece
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
  }
  return bytes;
}

TEST(FalconDriverTest, WritesTheFirmwareByteForByteAndGoesOn) {
  const Buffer firmware = made_up_firmware();
  DeviceClient client;
  LoopOptions options;
  options.drivers.falcon_firmware = firmware;
  FakeBus bus(options, client.sink());
  EmulatedFalcon falcon;
  falcon.has_firmware = false;
  falcon.firmware_size = firmware.size();
  const std::size_t row = bus.plug(falcon);
  bus.run(2.0);
  EXPECT_EQ(bus.device<EmulatedFalcon>(row).firmware, firmware);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
}

TEST(FalconDriverTest, SaysItIsReadyOnceInEachTry) {
  const Buffer firmware = made_up_firmware();
  DeviceClient client;
  LoopOptions options;
  options.drivers.falcon_firmware = firmware;
  FakeBus bus(options, client.sink());
  EmulatedFalcon falcon;
  falcon.has_firmware = false;
  falcon.loses_ready = 1;
  falcon.firmware_size = firmware.size();
  const std::size_t row = bus.plug(falcon);
  bus.run(4.0);
  EXPECT_EQ(bus.device<EmulatedFalcon>(row).firmware, firmware);  // no byte of "ready" in it
  EXPECT_EQ(client.last.state, DeviceState::kLive);
}

TEST(FalconDriverTest, GivesUpOnFirmwareThatComesBackWrong) {
  const Buffer firmware = made_up_firmware();
  DeviceClient client;
  LoopOptions options;
  options.drivers.falcon_firmware = firmware;
  FakeBus bus(options, client.sink());
  EmulatedFalcon falcon;
  falcon.has_firmware = false;
  falcon.echoes_wrongly = true;
  falcon.firmware_size = firmware.size();
  bus.plug(falcon);
  bus.run(60.0);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kBadFirmware);
}

TEST(FalconDriverTest, HasNoForceBeforeItsZerosAreFound) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  EmulatedFalcon falcon;
  falcon.homed = false;
  const std::size_t row = bus.plug(falcon);
  bus.run(kStartTime);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kNotHomed);
  EXPECT_GT(bus.without_force_for(row), 0.9 * kStartTime);
  EXPECT_GT(bus.writes(row), 400U);  // it is fed all the same
  bus.device<EmulatedFalcon>(row).homed = true;
  bus.run(0.1);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(bus.without_force_for(row), 0.0);
}

TEST(WoodenDriverTest, PushesInTheWorldsAxes) {
  DeviceClient client;
  client.wanted = {{0.0, 1.0, 0.0}, glm::dvec3(0.0)};  // up
  FakeBus bus({}, client.sink());
  const std::size_t row = bus.plug(EmulatedWooden{});
  bus.run(kStartTime);
  bus.device<EmulatedWooden>(row).encoders = {0, 300, 5700, 0, 0, 0};
  bus.run(0.1);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(client.last.sensed, kTranslationAxes);
  EXPECT_GT(client.last.rate, 900.0);
  const WoodenGeometry geometry = wooden_haptics_2015();
  const glm::dvec3 angles = wooden_body_angles(geometry, {{0, 300, 5700, 0, 0, 0}, 0});
  // Of the base: z is up.
  EXPECT_EQ(bus.device<EmulatedWooden>(row).currents,
            wooden_currents(geometry, angles, {0.0, 0.0, 1.0}));
  EXPECT_NEAR(client.last.pose.position.y, wooden_position(geometry, angles).z, 1e-12);
  EXPECT_EQ(client.last.pose.rotation, glm::dquat(1.0, 0.0, 0.0, 0.0));  // it has no wrist
}

TEST(WoodenDriverTest, HasNoForceBeforeItIsCalibrated) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  EmulatedWooden wooden;
  wooden.encoders = {10, 20, 30, 40, 50, 60};
  wooden.says_pressed = false;
  const std::size_t row = bus.plug(wooden);
  bus.run(kStartTime);
  EXPECT_EQ(client.last.state, DeviceState::kStarting);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kNotHomed);
  EXPECT_GT(bus.without_force_for(row), 0.9 * kStartTime);
  EXPECT_GT(bus.writes(row), 90U);  // it is asked all the same
  bus.device<EmulatedWooden>(row).says_pressed = true;
  bus.device<EmulatedWooden>(row).loses = 3;
  bus.run(0.2);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(bus.device<EmulatedWooden>(row).calibrations, 1U);
  EXPECT_EQ(bus.device<EmulatedWooden>(row).encoders, wooden_haptics_2015().home);
  EXPECT_EQ(bus.without_force_for(row), 0.0);
}

TEST(WoodenDriverTest, HasNoForceWhileItsButtonIsPressed) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t row = bus.plug(EmulatedWooden{});
  bus.run(kStartTime);
  const std::uint32_t epoch = client.last.epoch;
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  bus.device<EmulatedWooden>(row).button = true;
  bus.run(0.2);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kNotHomed);
  EXPECT_GT(bus.without_force_for(row), 0.19);
  bus.device<EmulatedWooden>(row).button = false;
  bus.run(0.2);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_NE(client.last.epoch, epoch);  // its pose has jumped
}

TEST(OdriveDriverTest, TurnsTheTwistAxisAndTakesTorqueUpToItsLimit) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  EmulatedOdrive knob;
  knob.turns = 0.25;
  const std::size_t row = bus.plug(knob);
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_TRUE(bus.device<EmulatedOdrive>(row).closed_loop);
  EXPECT_TRUE(bus.device<EmulatedOdrive>(row).watched);
  EXPECT_EQ(bus.device<EmulatedOdrive>(row).errors, 0U);
  EXPECT_FALSE(bus.device<EmulatedOdrive>(row).armed_with_torque);
  EXPECT_NEAR(client.last.pose.rotation.y, std::sin(std::numbers::pi / 4.0), 1e-6);
  EXPECT_NEAR(bus.device<EmulatedOdrive>(row).torque, 0.05, 1e-6);
  client.wanted.torque.y = -3.0;
  bus.run(0.01);
  EXPECT_NEAR(bus.device<EmulatedOdrive>(row).torque, -0.2, 1e-6);
  bus.rest(row);
  bus.run(0.01);
  EXPECT_EQ(bus.device<EmulatedOdrive>(row).torque, 0.0);
  EXPECT_FALSE(bus.device<EmulatedOdrive>(row).closed_loop);
}

TEST(OdriveDriverTest, IsToldNothingWhereItsFirmwareReadsTheLinesOtherwise) {
  // 0.5.3, 0.7, and an old one that reads no such property.
  for (const auto& version :
       {std::array<const char*, 3>{"0", "5", "3"}, std::array<const char*, 3>{"0", "7", "1"},
        std::array<const char*, 3>{"0d", "4d", "12d"}}) {
    DeviceClient client;
    FakeBus bus({}, client.sink());
    EmulatedOdrive knob;
    knob.version = version;
    const std::size_t row = bus.plug(knob);
    bus.run(kStartTime);
    EXPECT_EQ(client.last.state, DeviceState::kStarting) << version[1];
    EXPECT_EQ(client.last.trouble, DeviceTrouble::kWrongFirmware);
    EXPECT_FALSE(bus.device<EmulatedOdrive>(row).watched);
    EXPECT_FALSE(bus.device<EmulatedOdrive>(row).closed_loop);
    EXPECT_LE(bus.writes(row), 3U);  // questions
  }
}

TEST(OdriveDriverTest, AnErrorOfItsAxisEndsTheTorqueUntilItIsPluggedInAgain) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t row = bus.plug(EmulatedOdrive{});
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  bus.device<EmulatedOdrive>(row).errors = 0x40;
  bus.device<EmulatedOdrive>(row).closed_loop = false;
  bus.run(0.03);  // it is asked every 20 steps
  EXPECT_EQ(client.last.state, DeviceState::kStarting);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kMotorError);
  EXPECT_EQ(client.last.motor_errors, 0x40U);
  EXPECT_GT(bus.without_force_for(row), 0.0);
  bus.run(5.0);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kMotorError);
  EXPECT_EQ(bus.device<EmulatedOdrive>(row).errors, 0x40U);  // nobody has cleared it
  EXPECT_FALSE(bus.device<EmulatedOdrive>(row).closed_loop);
  EXPECT_GT(bus.without_force_for(row), 5.0);
  bus.unplug(row);
  bus.run(0.01);
  bus.plug(EmulatedOdrive{});
  bus.run(kStartTime);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
}

TEST(OdriveDriverTest, OneThatWasNotFedInTimeIsSetUpAnew) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t row = bus.plug(EmulatedOdrive{});
  bus.run(kStartTime);
  const std::uint32_t epoch = client.last.epoch;
  bus.device<EmulatedOdrive>(row).errors = kOdriveWatchdog;
  bus.device<EmulatedOdrive>(row).closed_loop = false;
  bus.run(0.03);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kMotorError);
  bus.run(1.0);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kNone);
  EXPECT_NE(client.last.epoch, epoch);  // from no force
  EXPECT_TRUE(bus.device<EmulatedOdrive>(row).closed_loop);
}

TEST(OdriveDriverTest, SaysThatItIsNotCalibratedAndWhenItLeftItsControlWithoutAnError) {
  for (const bool calibrated : {true, false}) {
    DeviceClient client;
    FakeBus bus({}, client.sink());
    EmulatedOdrive knob;
    knob.calibrated = calibrated;
    const std::size_t row = bus.plug(knob);
    bus.run(kStartTime);
    EXPECT_EQ(client.last.state == DeviceState::kLive, calibrated);
    bus.device<EmulatedOdrive>(row).closed_loop = false;
    bus.run(0.03);
    EXPECT_EQ(client.last.trouble, DeviceTrouble::kMotorError);
    EXPECT_EQ(client.last.motor_errors, calibrated ? 0U : 1U);
  }
}

EmulatedOdrive odrive_pro() {
  EmulatedOdrive knob;
  knob.version = {"0", "6", "9"};
  return knob;
}

TEST(OdriveDriverTest, SpeaksToFirmware6AsWell) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  EmulatedOdrive knob = odrive_pro();
  knob.turns = 0.25;
  const std::size_t row = bus.plug(knob);
  bus.run(kStartTime);
  ASSERT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_TRUE(bus.device<EmulatedOdrive>(row).watched);
  EXPECT_FALSE(bus.device<EmulatedOdrive>(row).armed_with_torque);
  EXPECT_NEAR(client.last.pose.rotation.y, std::sin(std::numbers::pi / 4.0), 1e-6);
  const std::uint64_t before = client.last.number;
  bus.run(1.0);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kNone);
  EXPECT_NEAR(bus.device<EmulatedOdrive>(row).torque, 0.05, 1e-6);
  EXPECT_GT(client.last.number - before, 1000U);  // though one step in fifty asks how it is
  EXPECT_EQ(bus.loop().rows[row].report.counts.garbage, 0U);
  bus.rest(row);
  bus.run(0.01);
  EXPECT_EQ(bus.device<EmulatedOdrive>(row).torque, 0.0);
  EXPECT_FALSE(bus.device<EmulatedOdrive>(row).closed_loop);
}

TEST(OdriveDriverTest, SaysWhyOneWithFirmware6Disarmed) {
  DeviceClient client;
  FakeBus bus({}, client.sink());
  const std::size_t row = bus.plug(odrive_pro());
  bus.run(kStartTime);
  bus.device<EmulatedOdrive>(row).errors = 0x2000;
  bus.device<EmulatedOdrive>(row).closed_loop = false;
  bus.run(0.07);  // it is asked every 50 steps
  EXPECT_EQ(client.last.trouble, DeviceTrouble::kMotorError);
  EXPECT_EQ(client.last.motor_errors, 0x2000U);
  EXPECT_EQ(client.last.motor, MotorKind::kOdrive6);
  EXPECT_GT(bus.without_force_for(row), 0.0);
  bus.run(5.0);
  EXPECT_FALSE(bus.device<EmulatedOdrive>(row).closed_loop);
  // Only its watchdog: this machine was busy, and it is set up anew.
  bus.unplug(row);
  bus.run(0.01);
  const std::size_t again = bus.plug(odrive_pro());
  bus.run(kStartTime);
  bus.device<EmulatedOdrive>(again).errors = kOdrive6Watchdog;
  bus.device<EmulatedOdrive>(again).closed_loop = false;
  bus.run(1.0);
  EXPECT_EQ(client.last.state, DeviceState::kLive);
}

}  // namespace
}  // namespace torsion::engine
