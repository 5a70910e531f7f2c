// A scene held by an emulated Falcon, all the way: libusb, driver, coupling, physics thread, and
// the force back at the motors.

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "app/live/device_link.hpp"
#include "app/live/live_loop.hpp"
#include "device/scripted_motion.hpp"
#include "device/usb/usb_list.hpp"
#include "tests/device/mock_usb.hpp"
#include "tests/support/paths.hpp"

namespace torsion {
namespace {

using test::EmulatedFalcon;
using test::MockDevice;

template <class F>
bool comes_true(F&& f) {
  for (int i = 0; i < 20000; ++i) {
    if (f()) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

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
    link = std::move(DeviceLink::open({"usb", {}, 0.2, {}}, home)).value();
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

void put(MockDevice& falcon, const glm::dvec3& place) {
  falcon.with<EmulatedFalcon>([&](EmulatedFalcon& one) { one.place = place; });
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
  ASSERT_TRUE(comes_true([&] { return held.link->view().outcome.holds; }));
  // Down until the body pushes back, 4 cm at most.
  double down = 0.0;
  EXPECT_TRUE(comes_true([&] {
    down = std::min(down + 1e-4, 0.04);
    put(falcon, {0.0, -down, 0.115});
    return held.link->view().outcome.wrench.force.y > 0.5;
  }));
  EXPECT_FALSE(falcon.without_force());
  falcon.unplug();
  ASSERT_TRUE(comes_true([&] { return held.link->view().sample.state == DeviceState::kAbsent; }));
  // Where it was when it went it takes hold of the tool again.
  falcon.plug();
  EXPECT_TRUE(comes_true([&] { return held.link->view().outcome.holds; }));
  EXPECT_EQ(held.link->view().losses, 1U);
}

}  // namespace
}  // namespace torsion
