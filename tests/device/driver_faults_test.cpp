// Each driver over a bus and a clock that are made up: what may go wrong on the wire.

#include <optional>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/device/device_client.hpp"
#include "tests/device/fake_bus.hpp"

namespace torsion::engine {
namespace {

using test::Buffer;
using test::DeviceClient;
using test::EmulatedFalcon;
using test::EmulatedMoteus;
using test::EmulatedOdrive;
using test::EmulatedSpaceMouse;
using test::EmulatedWheel;
using test::EmulatedWooden;
using test::FakeBus;
using test::kStartTime;

/// What may come over the wire instead of a packet.
struct WireFault {
  const char* name;
  std::optional<UsbStatus> status;
  Buffer packet;
};

class WireFaultTest : public testing::TestWithParam<WireFault> {};

TEST_P(WireFaultTest, LetsGoOrKeepsTheLastPoseAndIsLiveAgain) {
  for (const int kind : {0, 1, 2, 3, 4, 5}) {
    DeviceClient client;
    FakeBus bus(test::with_wheel_torque(), client.sink());
    test::EmulatedDevice device;
    kind == 1 ? device = EmulatedFalcon{} : kind == 2 ? device = EmulatedWooden{} : device;
    kind == 3 ? device = EmulatedOdrive{} : device;
    kind == 4 ? device = EmulatedMoteus{} : device;
    kind == 5 ? device = EmulatedWheel{} : device;
    const std::size_t row = bus.plug(device);
    bus.run(kStartTime);
    SCOPED_TRACE(testing::Message() << GetParam().name << ", kind " << kind);
    ASSERT_EQ(client.last.state, DeviceState::kLive);
    const Pose before = client.last.pose;
    for (int i = 0; i < 50; ++i) {
      if (GetParam().status) {
        bus.fail_next_read(row, *GetParam().status);
      } else {
        bus.send(row, GetParam().packet);
      }
      bus.run(3.3e-3);
    }
    EXPECT_NEAR(glm::length(client.last.pose.position - before.position), 0.0, 1e-12);
    bus.run(1.0);
    EXPECT_EQ(client.last.state, DeviceState::kLive);
    if (kind != 0) {
      EXPECT_GT(client.last.rate, kind == 5 ? 700.0 : 900.0);  // a wheel at rest
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, WireFaultTest,
    testing::Values(WireFault{"stall", UsbStatus::kStall, {}},
                    WireFault{"overflow", UsbStatus::kOverflow, {}},
                    WireFault{"failed", UsbStatus::kBroken, {}},
                    WireFault{"nothing", std::nullopt, {0x01, 0x60}},
                    WireFault{"short", std::nullopt, {0x01, 0x60, '<', 'A', 'B'}},
                    WireFault{"garbage", std::nullopt, {0xFF, 0x00, 0x13, 0x37, 0x0A, 0x41, '>'}}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(DriverFaultsTest, AStallLetsGoOfTheForceAtOnce) {
  for (const bool falcon : {true, false}) {
    DeviceClient client;
    FakeBus bus(test::with_wheel_torque(), client.sink());
    const std::size_t row = falcon ? bus.plug(EmulatedFalcon{}) : bus.plug(EmulatedOdrive{});
    bus.run(kStartTime);
    ASSERT_EQ(bus.without_force_for(row), 0.0);
    bus.silence(row, true);
    bus.run(1e-3);  // the last answer
    ASSERT_EQ(bus.without_force_for(row), 0.0);
    bus.fail_next_read(row, UsbStatus::kStall);
    bus.send(row, {});
    bus.run(1e-3);
    EXPECT_GT(bus.without_force_for(row), 0.0);
  }
}

TEST(DriverFaultsTest, AnEndpointOutThatStallsIsClearedAndLetsTheForceGo) {
  for (const bool falcon : {true, false}) {
    DeviceClient client;
    FakeBus bus(test::with_wheel_torque(), client.sink());
    const std::size_t row = falcon ? bus.plug(EmulatedFalcon{}) : bus.plug(EmulatedOdrive{});
    bus.run(kStartTime);
    ASSERT_EQ(client.last.state, DeviceState::kLive);
    ASSERT_EQ(bus.without_force_for(row), 0.0);
    bus.halt_writes(row);
    bus.silence(row, true);
    bus.run(0.05);
    EXPECT_GT(bus.without_force_for(row), 0.0) << falcon;
    bus.silence(row, false);
    bus.run(3.0);
    EXPECT_EQ(client.last.state, DeviceState::kLive) << falcon;
  }
}

TEST(DriverFaultsTest, ASilentDeviceIsToldToLetGoAndComesBack) {
  for (const int kind : {1, 2, 3, 4, 5}) {
    DeviceClient client;
    FakeBus bus(test::with_wheel_torque(), client.sink());
    const std::size_t row = kind == 1   ? bus.plug(EmulatedFalcon{})
                            : kind == 2 ? bus.plug(EmulatedWooden{})
                            : kind == 3 ? bus.plug(EmulatedOdrive{})
                            : kind == 4 ? bus.plug(EmulatedMoteus{})
                                        : bus.plug(EmulatedWheel{});
    bus.run(kStartTime);
    SCOPED_TRACE(kind);
    ASSERT_EQ(client.last.state, DeviceState::kLive);
    bus.silence(row, true);
    bus.run(0.01);
    EXPECT_GT(bus.without_force_for(row), 0.0);
    bus.run(1.0);
    EXPECT_EQ(client.last.state, DeviceState::kStarting);
    bus.silence(row, false);
    bus.run(2.5);
    EXPECT_EQ(client.last.state, DeviceState::kLive);
  }
}

TEST(DriverFaultsTest, SaysWhoKeepsItFromTheDeviceAndTriesAgain) {
  for (const UsbStatus status : {UsbStatus::kBusy, UsbStatus::kNoAccess}) {
    for (const int kind : {0, 1, 2, 3, 4, 5}) {
      DeviceClient client;
      FakeBus bus(test::with_wheel_torque(), client.sink());
      const std::size_t row = kind == 0   ? bus.plug(EmulatedSpaceMouse{})
                              : kind == 1 ? bus.plug(EmulatedFalcon{})
                              : kind == 2 ? bus.plug(EmulatedWooden{})
                              : kind == 3 ? bus.plug(EmulatedOdrive{})
                              : kind == 4 ? bus.plug(EmulatedMoteus{})
                                          : bus.plug(EmulatedWheel{});
      bus.claims(row, status);
      bus.run(1.0);
      SCOPED_TRACE(kind);
      EXPECT_EQ(client.last.state, DeviceState::kStarting);
      EXPECT_EQ(client.last.trouble, status == UsbStatus::kBusy ? DeviceTrouble::kHeldElsewhere
                                                                : DeviceTrouble::kNoAccess);
      bus.claims(row, UsbStatus::kCompleted);
      bus.run(1.0);
      EXPECT_EQ(client.last.state, DeviceState::kLive);
      EXPECT_EQ(client.last.trouble, DeviceTrouble::kNone);
    }
  }
}

}  // namespace
}  // namespace torsion::engine
