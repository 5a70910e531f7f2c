// A scene held by an emulated Falcon, all the way: libusb, driver, coupling, physics thread, and
// the force back at the motors.

#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

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

/// A client of the gateway that says it is where it was, from a socket that nobody answers.
class SilentClient {
 public:
  explicit SilentClient(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    address_.sun_family = AF_UNIX;
    std::snprintf(address_.sun_path, sizeof address_.sun_path, "%s", path.c_str());
  }
  ~SilentClient() { ::close(socket_); }
  SilentClient(const SilentClient&) = delete;
  SilentClient& operator=(const SilentClient&) = delete;
  SilentClient(SilentClient&&) = delete;
  SilentClient& operator=(SilentClient&&) = delete;

  void say() {
    sample_.session = 1;
    sample_.sequence += 1;
    sample_.sensed = kTranslationAxes | kRotationAxes;
    sample_.actuated = kTranslationAxes;
    sample_.traits.period = 10e-3;
    const GatewaySampleBytes bytes = encode_gateway_sample(sample_);
    (void)::sendto(socket_, bytes.data(), bytes.size(), 0,
                   reinterpret_cast<const sockaddr*>(&address_), sizeof address_);  // NOLINT
  }

 private:
  int socket_;
  sockaddr_un address_{};
  GatewaySample sample_;
};

TEST(DeviceSessionTest, AKnobOnTheUsbTurnsWhatAGatewaysClientMoves) {
  test::MockUsb usb;
  MockDevice& knob = usb.plug(test::EmulatedOdrive{}, "cdc_acm");
  const std::string path = "/tmp/torsion_joined_" + std::to_string(::getpid()) + ".sock";
  DeviceChoice choice;
  choice.what = "gateway:" + path + "+odrive";
  choice.safety.checks_signs = false;
  auto link = DeviceLink::open(choice, Pose{});
  ASSERT_TRUE(link) << link.error().text;
  SilentClient client(path);
  const auto& sample = [&]() -> const DeviceSample& {
    client.say();
    return link.value()->view().sample;
  };
  ASSERT_TRUE(test::comes_true([&] { return sample().state == DeviceState::kLive; }));
  EXPECT_EQ(sample().sensed, kTranslationAxes | kRotationAxes | kTurnAxis);
  EXPECT_EQ(sample().actuated, kTranslationAxes | kTurnAxis);
  knob.with<test::EmulatedOdrive>([](test::EmulatedOdrive& one) { one.turns = 0.25; });
  EXPECT_TRUE(test::comes_true([&] { return sample().pose.rotation.y > 0.7; }));
  knob.unplug();
  EXPECT_TRUE(test::comes_true([&] { return sample().state != DeviceState::kLive; }));
}

}  // namespace
}  // namespace torsion::engine
