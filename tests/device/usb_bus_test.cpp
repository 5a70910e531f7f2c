// The whole road with libusb as it is: an emulated kernel below, the drivers above. Nothing here
// asserts how long anything takes: the emulated device files are always "ready", so that libusb
// spins.

#include "device/usb/usb_bus.hpp"

#include <chrono>
#include <mutex>
#include <random>
#include <thread>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/device/mock_usb.hpp"
#include "tests/support/waiting.hpp"

namespace torsion::engine {
namespace {

using test::EmulatedFalcon;
using test::EmulatedMoteus;
using test::EmulatedOdrive;
using test::EmulatedSpaceMouse;
using test::EmulatedWheel;
using test::EmulatedWooden;
using test::MockDevice;
using test::MockUsb;

/// What the bus says, for a test's thread to look at.
struct Client {
  std::mutex mutex;
  DeviceSample last;
  Wrench wanted{{0.0, -2.0, 0.0}, {0.0, 0.05, 0.0}};

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    auto& client = *static_cast<Client*>(context);
    const std::lock_guard lock(client.mutex);
    client.last = sample;
    return client.wanted;
  }
  DeviceSample now() {
    const std::lock_guard lock(mutex);
    return last;
  }
};

UsbBusOptions with_all_kinds() {
  UsbBusOptions options;
  options.loop.kinds = ~0U;
  options.loop.drivers.wheel_torque = EmulatedWheel{}.full_scale;
  return options;
}

class UsbBusTest : public testing::Test {
 protected:
  void start(const UsbBusOptions& options = with_all_kinds()) {
    auto started = UsbBus::start(options, {&client_, Client::on_sample});
    ASSERT_TRUE(started) << started.error().text;
    bus_ = std::move(started).value();
  }

  bool becomes(DeviceState state) {
    return test::comes_true([&] { return client_.now().state == state; });
  }
  /// Samples arrive after this moment.
  bool streams() {
    const std::uint64_t number = client_.now().number;
    return test::comes_true([&] { return client_.now().number > number + 20; });
  }
  void ends() { bus_.reset(); }

  MockUsb usb_;
  Client client_;
  std::unique_ptr<UsbBus> bus_;
};

test::EmulatedDevice device_of(int kind) {
  switch (kind) {
    case 0:
      return EmulatedSpaceMouse{};
    case 1:
      return EmulatedFalcon{};
    case 2:
      return EmulatedWooden{};
    case 3:
      return EmulatedOdrive{};
    case 4:
      return EmulatedMoteus{};
    default: {
      EmulatedWheel wheel;
      wheel.is_other = kind == 6;
      return wheel;
    }
  }
}

class UsbLifeTest : public UsbBusTest, public testing::WithParamInterface<int> {};

TEST_P(UsbLifeTest, OpensStreamsAndSurvivesWhatComesOverTheWire) {
  const char* const drivers[] = {"usbhid",  "ftdi_sio", "usbhid", "cdc_acm",
                                 "cdc_acm", "usbhid",   "usbhid"};
  MockDevice& device = usb_.plug(device_of(GetParam()), drivers[GetParam()]);
  start();
  ASSERT_TRUE(becomes(DeviceState::kLive));
  EXPECT_FALSE(device.kernel_has_it());
  ASSERT_TRUE(streams());
  device.fail_next_read(-EPIPE);
  EXPECT_TRUE(test::comes_true([&] { return device.clears() > 0; }));
  device.fail_next_read(-EOVERFLOW);
  EXPECT_TRUE(streams());
  device.fail_next_read(-EPROTO);
  EXPECT_TRUE(streams());
  device.send({0x01});
  device.send({0x01, 0x60, 0x3C, 0x41});
  device.send({0xFF, 0x00, 0x13, 0x37, 0x0A, 0x41, 0x3E, 0x00, 0x00});
  EXPECT_TRUE(streams());
  EXPECT_EQ(client_.now().state, DeviceState::kLive);
  // Out and in again, twice.
  for (int round = 0; round < 2; ++round) {
    device.unplug();
    ASSERT_TRUE(becomes(DeviceState::kAbsent));
    device.plug();
    ASSERT_TRUE(becomes(DeviceState::kLive));
    ASSERT_TRUE(streams());
  }
  ends();
  EXPECT_TRUE(device.without_force());
  EXPECT_TRUE(device.kernel_has_it());
}

INSTANTIATE_TEST_SUITE_P(EachDevice, UsbLifeTest, testing::Range(0, 7));

TEST_F(UsbBusTest, StartsAndEndsWithNothingPluggedIn) {
  start();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(client_.now().state, DeviceState::kAbsent);
}

TEST_F(UsbBusTest, LoadsAFalconsFirmware) {
  test::Buffer firmware(1300);
  for (std::size_t i = 0; i < firmware.size(); ++i) {
    firmware[i] = static_cast<std::uint8_t>(i * 13);
  }
  EmulatedFalcon falcon;
  falcon.has_firmware = false;
  falcon.firmware_size = firmware.size();
  MockDevice& device = usb_.plug(falcon);
  UsbBusOptions options;
  options.loop.drivers.falcon_firmware = firmware;
  start(options);
  ASSERT_TRUE(becomes(DeviceState::kLive));
  EXPECT_EQ(device.with<EmulatedFalcon>([](const EmulatedFalcon& one) { return one.firmware; }),
            firmware);
}

TEST_F(UsbBusTest, SaysThatAnotherProgramHasItAndTakesItWhenThatEnds) {
  MockDevice& device = usb_.plug(EmulatedFalcon{});
  device.refuse_claims(EBUSY);
  start();
  ASSERT_TRUE(
      test::comes_true([&] { return client_.now().trouble == DeviceTrouble::kHeldElsewhere; }));
  device.refuse_claims(0);
  EXPECT_TRUE(becomes(DeviceState::kLive));
}

TEST_F(UsbBusTest, AFalconAndAKnobAreOneDevice) {
  MockDevice& falcon = usb_.plug(EmulatedFalcon{}, "ftdi_sio");
  start();
  ASSERT_TRUE(becomes(DeviceState::kLive));
  MockDevice& knob = usb_.plug(EmulatedOdrive{}, "cdc_acm");
  ASSERT_TRUE(test::comes_true([&] {
    const DeviceSample sample = client_.now();
    return sample.state == DeviceState::kLive && sample.actuated == (kTranslationAxes | kTurnAxis);
  }));
  EXPECT_TRUE(test::comes_true([&] { return !falcon.without_force() && !knob.without_force(); }));
  knob.unplug();
  EXPECT_TRUE(test::comes_true([&] { return client_.now().actuated == kTranslationAxes; }));
  ends();
  EXPECT_TRUE(falcon.without_force());
}

TEST_F(UsbBusTest, AForceThatADeviceDoesNotTakeIsCalledBack) {
  MockDevice& falcon = usb_.plug(EmulatedFalcon{});
  start();
  ASSERT_TRUE(test::comes_true([&] { return !falcon.without_force(); }));
  falcon.hang_writes(true);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  // What it hears of next is no force of a tenth of a second ago: by now it is to let go.
  falcon.with<EmulatedFalcon>([](EmulatedFalcon& one) {
    one.heard.clear();
    one.keeps_what_it_heard = true;
  });
  falcon.hang_writes(false);
  ASSERT_TRUE(test::comes_true([&] {
    return falcon.with<EmulatedFalcon>([](EmulatedFalcon& one) { return !one.heard.empty(); });
  }));
  const auto first = falcon.with<EmulatedFalcon>([](EmulatedFalcon& one) { return one.heard[0]; });
  EXPECT_EQ(first, (std::array<std::int16_t, 3>{}));
  EXPECT_TRUE(test::comes_true([&] { return !falcon.without_force(); }));  // and it goes on
}

TEST_F(UsbBusTest, IgnoresWhatIsNoDeviceOfOurs) {
  usb_.plug(EmulatedOdrive{});
  UsbBusOptions options;
  options.loop.kinds = 1U << static_cast<std::uint32_t>(DeviceKind::kFalcon);
  start(options);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(client_.now().state, DeviceState::kAbsent);
}

TEST_F(UsbBusTest, IsPulledOutAtRandomMoments) {
  // TORSION_UNPLUGS=1000 for the whole of it; the same with a clock that is made up runs always.
  const char* const wanted = std::getenv("TORSION_UNPLUGS");
  const int times = wanted != nullptr ? std::atoi(wanted) : 25;
  MockDevice& device = usb_.plug(EmulatedFalcon{}, "ftdi_sio");
  start();
  std::mt19937 random(11);
  std::uniform_int_distribution<int> moment(0, 30);
  for (int i = 0; i < times; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(moment(random)));
    device.unplug();
    ASSERT_TRUE(becomes(DeviceState::kAbsent)) << i;
    device.plug();
  }
  EXPECT_TRUE(becomes(DeviceState::kLive));
  ends();
  EXPECT_TRUE(device.without_force());
}

}  // namespace
}  // namespace torsion::engine
