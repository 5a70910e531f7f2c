// The window with an emulated Falcon, all the way from the kernel's side of USB to the picture.
// ctest runs it under Xvfb.

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "app/view/viewer.hpp"
#include "render/image_io.hpp"
#include "tests/app/program.hpp"
#include "tests/app/window_pictures.hpp"
#include "tests/device/mock_usb.hpp"
#include "tests/support/waiting.hpp"

namespace torsion::engine {
namespace {

using test::EmulatedFalcon;
using test::MockDevice;
using test::MockUsb;

constexpr int kWay = 200;  // steps of the hand

struct Shown {
  ViewerOutcome outcome;
  Image last;
};

/// A window on a ball over a cube for some seconds, held by what is plugged in.
Shown show_for(double seconds, const test::Folder& folder) {
  ViewerOptions options;
  options.scene = test::scene("ball_on_cube");
  options.prepare.contact_model = ContactModel::kMdr;
  options.prepare.body_model = BodyModel::kNone;
  options.device.what = "usb";
  options.device.longest_silence = seconds;  // other tests share the machine
  options.seconds = seconds;
  options.screenshot = folder / "last.png";
  Viewer viewer(options);
  Result<ViewerOutcome> outcome = viewer.run();
  EXPECT_TRUE(outcome) << outcome.error().text;
  Shown shown;
  if (outcome) {
    shown.outcome = std::move(outcome).value();
    shown.last = read_png(folder / "last.png").value();
  }
  return shown;
}

void put(MockDevice& falcon, double y) {
  falcon.with<EmulatedFalcon>([&](EmulatedFalcon& one) { one.place = {0.0, y, 0.115}; });
}

// The bus is one for the whole process: libusb looks for devices only when it is first used.
class WindowDeviceTest : public ::testing::Test {
 protected:
  static MockUsb& usb() {
    static MockUsb bus;
    return bus;
  }
};

TEST_F(WindowDeviceTest, AFalconPressesTheToolAndItsLossIsSaidInRed) {
  const test::Folder folder;
  MockDevice& falcon = usb().plug(EmulatedFalcon{}, "ftdi_sio");
  // Down to the body and into it and up again, 0.2 mm at a time, so that it comes by the tool
  // whenever the window is open.
  std::atomic<bool> over = false;
  std::thread hand([&] {
    for (int i = 0; !over; ++i) {
      put(falcon, -2e-4 * (kWay - std::abs(i % (2 * kWay) - kWay)));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  const Shown held = show_for(6.0, folder);
  over = true;
  hand.join();
  ASSERT_TRUE(held.outcome.device.has_value());
  EXPECT_TRUE(held.outcome.device->outcome.holds);
  EXPECT_GT(held.outcome.device->sample.rate, 100.0);
  EXPECT_GT(held.outcome.statistics.peak_force, 0.5);
  EXPECT_FALSE(test::has_red_banner(held.last));

  put(falcon, 0.0);
  std::thread thief([&] {
    // Once the session drives it: it may take long to open on a machine that runs other tests.
    const auto packets = [&] {
      return falcon.with<EmulatedFalcon>([](EmulatedFalcon& one) { return one.packets; });
    };
    const std::uint64_t before = packets();
    EXPECT_TRUE(test::comes_true([&] { return packets() > before + 200; }));
    falcon.unplug();
  });
  const Shown robbed = show_for(6.0, folder);
  thief.join();
  ASSERT_TRUE(robbed.outcome.device.has_value());
  EXPECT_GE(robbed.outcome.device->losses, 1U);
  EXPECT_EQ(robbed.outcome.device->sample.state, DeviceState::kAbsent);
  EXPECT_TRUE(test::has_red_banner(robbed.last));
  EXPECT_GT(robbed.outcome.statistics.steps, 1000U);  // the session went on
}

}  // namespace
}  // namespace torsion::engine
