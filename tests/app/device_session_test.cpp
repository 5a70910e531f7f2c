// A scene held by an emulated Falcon, all the way: libusb, driver, coupling, physics thread, and
// the force back at the motors.

#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "app/live/device_link.hpp"
#include "app/live/live_loop.hpp"
#include "device/scripted_motion.hpp"
#include "device/usb/usb_list.hpp"
#include "tests/device/mock_usb.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/waiting.hpp"

namespace torsion::engine {
namespace {

using test::EmulatedFalcon;
using test::MockDevice;

/// A ball just over a cube, on the clock, held by whatever is plugged in.
struct Held {
  Session session;
  LiveLoop loop;
  std::unique_ptr<DeviceLink> link;
  std::thread physics;

  Held() {
    PrepareOptions options;
    options.contact_model = ContactModel::kMdr;
    options.body_model = BodyModel::kNone;
    const std::string scene = test::shipped_scene("ball_on_cube");
    session = std::move(open_session(scene, options, true)).value();
    const Pose home = scripted_pose(session.scene.tools[0].script, 0.0);
    DeviceChoice choice;
    choice.what = "usb";
    choice.longest_silence = test::kPatience;
    choice.safety.checks_signs = false;  // this hand goes where it wants
    link = std::move(DeviceLink::open(choice, home)).value();
    loop.wants_privileges = false;
    reserve(loop, session, session.simulation);
    loop.tools[0].from = PoseFrom::kHandle;
    loop.tools[0].slot = &link->slot();
    physics = std::thread(run_live, std::ref(loop));
  }
  ~Held() {
    loop.stop = true;
    physics.join();
  }
};

/// A hand on the emulated handle: from the middle of the workspace 4 cm down and up again, so that
/// it comes by the tool wherever that was left, until something holds.
template <class F>
bool comes_true_in_hand(MockDevice& falcon, F&& holds) {
  constexpr int kWay = 400;  // steps of 0.1 mm
  int i = 0;
  return test::comes_true([&] {
    if (holds()) {
      return true;
    }
    const int down = kWay - std::abs(i % (2 * kWay) - kWay);
    falcon.with<EmulatedFalcon>([&](EmulatedFalcon& one) {
      one.place = {0.0, -1e-4 * down, 0.115};
    });
    ++i;
    return false;
  });
}

TEST(DeviceSessionTest, AListedFalconIsUsableAndItsDriverIsNamed) {
  test::MockUsb usb;
  usb.plug(EmulatedFalcon{}, "ftdi_sio");
  const auto listed = list_usb_devices();
  ASSERT_TRUE(listed) << listed.error().text;
  ASSERT_EQ(listed.value().size(), 1U);
  EXPECT_EQ(listed.value()[0].kind, DeviceKind::kFalcon);
  EXPECT_EQ(listed.value()[0].access, DeviceTrouble::kNone);
  EXPECT_EQ(listed.value()[0].kernel_drivers, std::vector<std::string>{"ftdi_sio"});
}

TEST(DeviceSessionTest, TheMotorsFeelTheBodyAndNothingOnceItIsPulledOut) {
  test::MockUsb usb;
  MockDevice& falcon = usb.plug(EmulatedFalcon{}, "ftdi_sio");
  Held held;
  const auto& in_hand = [&](auto&& holds) {
    return comes_true_in_hand(falcon, holds);
  };
  ASSERT_TRUE(in_hand([&] { return held.link->view().outcome.holds; }));
  // The body pushes back, and it is this that the motors display.
  ASSERT_TRUE(in_hand(
      [&] { return held.link->view().outcome.wrench.force.y > 0.5 && !falcon.without_force(); }));
  falcon.unplug();
  ASSERT_TRUE(in_hand([&] {
    const DeviceView& view = held.link->view();
    return view.sample.state == DeviceState::kAbsent &&
           view.outcome.wrench.force == glm::dvec3(0.0);
  }));
  EXPECT_GE(held.link->view().losses, 1U);
  // Plugged in again it takes hold of the tool again.
  falcon.plug();
  EXPECT_TRUE(in_hand([&] { return held.link->view().outcome.holds; }));
}

}  // namespace
}  // namespace torsion::engine
