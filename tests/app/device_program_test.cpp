// The built program with a device on an emulated kernel (see tests/device/mock_usb.hpp), as a
// person runs it: what it says of a device that it may not open, or that somebody else has, and a
// session that a device holds.

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "device/usb/usb_bus.hpp"
#include "tests/app/program.hpp"
#include "tests/device/mock_usb.hpp"
#include "tests/support/waiting.hpp"

namespace torsion::engine {
namespace {

using test::comes_true;
using test::EmulatedFalcon;
using test::EmulatedOdrive;
using test::MockDevice;
using test::Process;
using test::Ran;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The program's words as an ordinary user would run them: root, as whom tests may run, opens what
/// nobody may open unless it goes without that capability.
std::vector<std::string> as_ordinary_user(const std::vector<std::string>& words) {
  std::vector<std::string> all = test::torsion(words);
  if (::geteuid() == 0) {
    const std::vector<std::string> without = {"setpriv", "--bounding-set",
                                              "-dac_override,-dac_read_search", "--"};
    all.insert(all.begin(), without.begin(), without.end());
  }
  return all;
}

/// A hand that goes down from the tool and up again, 4 cm, and stays where it is pushed back.
/// Nobody knows when the session takes hold, for which the handle has to be near the tool, nor how
/// busy the machine is: it goes by the packets that come.
struct Press {
  double way = 0.0;           // m: down and up again
  std::uint64_t moved = 0;    // packets by then
  std::uint64_t without = 0;  // packets when there was no force last

  /// True once the motors have held more than a rest of the coupling for long.
  bool pushes_back(EmulatedFalcon& falcon) {
    constexpr double kWay = 0.04;      // m
    constexpr int kHalfANewton = 100;  // of the motors' values: about 240 to a newton
    const bool pushed = std::ranges::any_of(
        falcon.motors, [](std::int16_t motor) { return std::abs(motor) > kHalfANewton; });
    if (!pushed) {
      without = falcon.packets;
      if (falcon.packets > moved + 5) {
        way = std::fmod(way + 1e-4, 2.0 * kWay);
        moved = falcon.packets;
        falcon.place = {0.0, std::abs(kWay - way) - kWay, 0.115};
      }
    }
    return falcon.packets > without + 500;
  }
};

class DeviceProgramTest : public testing::Test {
 protected:
  // The programs that a test starts see the emulated bus as this process does.
  void SetUp() override { ::setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1); }
  void TearDown() override { ::unsetenv("LD_PRELOAD"); }

  test::MockUsb usb_;
};

TEST_F(DeviceProgramTest, SaysWhatIsUsableAndWhichDriverGivesItUpForAWhile) {
  usb_.plug(EmulatedOdrive{}, "cdc_acm");
  const Ran ran = test::run_torsion({"devices"});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_TRUE(has(ran.out, "ODrive knob (1209:0d32, bus 1 address 2): usable\n")) << ran.out;
  EXPECT_TRUE(has(ran.out, "the kernel's cdc_acm has it, and gets it back afterwards")) << ran.out;
  EXPECT_FALSE(has(ran.out, "missing")) << ran.out;
}

// Its id is nobody's that is known: what the kernel has read of it tells.
TEST_F(DeviceProgramTest, FindsAWheelByItsReportDescriptor) {
  test::EmulatedWheel wheel;
  wheel.is_other = true;
  usb_.plug(wheel, "usbhid");
  const Ran ran = test::run_torsion({"devices"});
  EXPECT_TRUE(has(ran.out, "force-feedback wheel (346e:0004, bus 1 address 2): usable\n"))
      << ran.out;
  EXPECT_TRUE(has(ran.out, "--wheel-torque")) << ran.out;
}

TEST_F(DeviceProgramTest, SaysHowToBeAllowedToOpenADevice) {
  usb_.plug(EmulatedOdrive{}, "").close_node();
  const Ran ran = Process(as_ordinary_user({"devices"})).wait();
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_TRUE(has(ran.out, "NOT usable")) << ran.out;
  EXPECT_TRUE(has(ran.out, "this user may not open it")) << ran.out;
  EXPECT_TRUE(has(ran.out, R"(ATTR{idVendor}=="1209", ATTR{idProduct}=="0d32", TAG+="uaccess")"))
      << ran.out;
  EXPECT_TRUE(has(ran.out, "sudo install -m 644 device/60-torsion.rules /etc/udev/rules.d/"))
      << ran.out;
}

TEST_F(DeviceProgramTest, MeasuresNothingWithoutConsentOrWhatDoesNotMove) {
  MockDevice& knob = usb_.plug(EmulatedOdrive{}, "cdc_acm");
  const std::vector<std::string> measure = {"devices", "--measure", "--device", "usb:odrive"};
  const Ran asked = test::run_torsion(measure);  // its input has ended
  EXPECT_EQ(asked.exit_code, 1);
  EXPECT_TRUE(has(asked.err, "--yes")) << asked.err;
  EXPECT_TRUE(knob.without_force());
  std::vector<std::string> agreed = measure;
  agreed.emplace_back("--yes");
  const Ran stuck = test::run_torsion(agreed);
  EXPECT_EQ(stuck.exit_code, 1);
  EXPECT_TRUE(has(stuck.err, "it did not move when it was pushed")) << stuck.err;
  EXPECT_TRUE(knob.without_force());
  EXPECT_EQ(test::run_torsion({"devices", "--measure"}).exit_code, 2);
  EXPECT_EQ(test::run_torsion({"devices", "--measure", "--device", "usb"}).exit_code, 1);
}

TEST_F(DeviceProgramTest, NamesTheProgramThatHoldsADevice) {
  usb_.plug(EmulatedOdrive{}, "cdc_acm");
  DeviceState state = DeviceState::kAbsent;
  std::mutex mutex;
  struct Held {
    DeviceState& state;
    std::mutex& mutex;
  } held{state, mutex};
  UsbBusOptions options;
  auto bus = UsbBus::start(options, {&held, [](void* context, const DeviceSample& sample) {
                                       auto& [last, lock] = *static_cast<Held*>(context);
                                       const std::lock_guard guard(lock);
                                       last = sample.state;
                                       return Wrench{};
                                     }});
  ASSERT_TRUE(bus) << bus.error().text;
  ASSERT_TRUE(comes_true([&] {
    const std::lock_guard guard(mutex);
    return state == DeviceState::kLive;
  }));
  const Ran ran = test::run_torsion({"devices"});
  EXPECT_TRUE(has(ran.out, "NOT usable")) << ran.out;
  EXPECT_TRUE(has(ran.out, "another program holds it: ")) << ran.out;
  EXPECT_TRUE(has(ran.out, fmt::format("(process {})", ::getpid()))) << ran.out;
  bus.value().reset();
  const Ran after = test::run_torsion({"devices", "--json"});
  const auto listed = nlohmann::json::parse(after.out).at("devices").at(0);
  EXPECT_TRUE(listed.at("usable")) << after.out;
  EXPECT_EQ(listed.at("holder"), "") << after.out;
}

TEST_F(DeviceProgramTest, ASessionFeelsTheBodyAndLetsGoWhenItIsInterrupted) {
  MockDevice& falcon = usb_.plug(EmulatedFalcon{}, "ftdi_sio");
  // This hand goes where it wants, whatever the force, and as fast as the emulated bus lets it: a
  // check of signs would see nothing, and then turn it off as one that runs away.
  Process session(test::torsion({"simulate", test::scene("ball_on_cube"), "--contact-model", "mdr",
                                 "--body-model", "none", "--realtime", "--seconds", "1000",
                                 "--device", "usb", "--no-sign-check", "--json"}));
  Press hand;
  EXPECT_TRUE(comes_true([&] {
    return falcon.with<EmulatedFalcon>([&](EmulatedFalcon& one) { return hand.pushes_back(one); });
  }));
  session.send(SIGINT);
  const Ran ran = session.wait();
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_TRUE(falcon.without_force());
  EXPECT_TRUE(falcon.kernel_has_it());
  const auto summary = nlohmann::json::parse(ran.out);
  EXPECT_GT(summary.at("contact_steps"), 0);
  EXPECT_GT(summary.at("device").at("samples"), 0);
  EXPECT_TRUE(has(summary.at("device").at("state"), "torque is not displayed")) << ran.out;
}

}  // namespace
}  // namespace torsion::engine
