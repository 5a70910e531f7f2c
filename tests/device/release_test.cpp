// A program that is killed while its device pushes: the process beside it lets go. The program is
// this one again, with a word on its command line, and the emulated kernel is in the test's
// process, which lives on.

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device/usb/release_process.hpp"
#include "device/usb/usb_bus.hpp"
#include "tests/device/mock_usb.hpp"
#include "tests/support/waiting.hpp"

namespace torsion::engine {
namespace {

using test::EmulatedFalcon;
using test::EmulatedMoteus;
using test::EmulatedOdrive;
using test::EmulatedWheel;
using test::EmulatedWooden;
using test::MockDevice;
using test::MockUsb;

constexpr const char* kHoldsDevices = "--holds-devices";

/// SIGUSR1: the program hangs in the middle of a sample, or goes on. umockdev cannot bear a client
/// that is killed within an ioctl, where libusb is most of the time; a program that hangs is within
/// none.
std::atomic<bool> hangs = false;

/// Pushes for as long as it lives.
[[noreturn]] void hold_devices() {
  ::signal(SIGUSR1, [](int) { hangs = !hangs; });  // NOLINT(cert-err33-c)
  UsbBusOptions options;
  options.loop.kinds = ~0U;
  options.loop.drivers.wheel_torque = EmulatedWheel{}.full_scale;
  const auto push = [](void*, const DeviceSample&) {
    while (hangs) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return Wrench{{0.0, -2.0, 0.0}, {0.0, 0.05, 0.0}};
  };
  const auto bus = UsbBus::start(options, {nullptr, push});
  std::this_thread::sleep_for(std::chrono::seconds(60));
  std::_Exit(bus ? 0 : 1);
}

pid_t start_program() {
  std::string self = "/proc/self/exe";
  std::string word = kHoldsDevices;
  std::array<char*, 3> arguments{self.data(), word.data(), nullptr};
  pid_t program = 0;
  EXPECT_EQ(::posix_spawn(&program, self.c_str(), nullptr, nullptr, arguments.data(), environ), 0);
  return program;
}

using Time = std::chrono::steady_clock::time_point;

double seconds_until_without_force(MockDevice& device, Time start) {
  if (!test::comes_true([&] { return device.without_force(); })) {
    return 1e9;
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The program hangs at a moment at which the device holds what it was told last. On a busy machine
/// it may just have let go, as the device seemed to be silent: then it goes on and is caught again.
bool hangs_while_it_pushes(MockDevice& device, pid_t program) {
  for (int i = 0; i < 50; ++i) {
    if (!test::comes_true([&] { return !device.without_force(); })) {
      return false;
    }
    ::kill(program, SIGUSR1);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (!device.without_force()) {
      return true;
    }
    ::kill(program, SIGUSR1);
  }
  return false;
}

class KilledProgramTest : public testing::TestWithParam<int> {};

TEST_P(KilledProgramTest, LeavesNoForceBehind) {
  MockUsb usb;
  test::EmulatedDevice device = EmulatedFalcon{};
  GetParam() == 1 ? device = EmulatedWooden{} : device;
  GetParam() == 2 ? device = EmulatedOdrive{} : device;
  GetParam() == 3 ? device = EmulatedMoteus{} : device;
  if (GetParam() == 4) {
    EmulatedWheel wheel;
    wheel.plays_for_ever = true;
    device = wheel;
  }
  MockDevice& plugged = usb.plug(device);
  // Within 20 ms; a machine that is busy with something else may be late once or twice.
  double quickest = 1e9;
  for (const int signal : {SIGKILL, SIGSEGV, SIGKILL}) {
    if (GetParam() == 1) {  // somebody presses its calibration button for each program
      plugged.with<EmulatedWooden>([](EmulatedWooden& one) { one.says_pressed = true; });
    }
    const pid_t program = start_program();
    ASSERT_TRUE(hangs_while_it_pushes(plugged, program));
    ::kill(program, signal);
    const auto killed_at = std::chrono::steady_clock::now();
    ::waitpid(program, nullptr, 0);
    plugged.close_files();
    quickest = std::min(quickest, seconds_until_without_force(plugged, killed_at));
    // The other process gives the interface back and ends.
    ASSERT_TRUE(test::comes_true([&] { return plugged.kernel_has_it(); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  RecordProperty("milliseconds", std::to_string(1e3 * quickest));
  EXPECT_LT(quickest, 20e-3);
}

TEST(ReleaseTest, TheProgramGoesOnWithoutIt) {
  const auto release = ReleaseProcess::start();
  ASSERT_TRUE(release);
  ::kill(release->process(), SIGKILL);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  UsbRequests last;
  write_usb(last, 0x02, std::array<std::uint8_t, 1>{0});
  release->look_after(0, identity_of(EmulatedFalcon{}), last);  // no SIGPIPE
  release->forget(0);
}

INSTANTIATE_TEST_SUITE_P(EachDevice, KilledProgramTest, testing::Range(0, 5));

}  // namespace
}  // namespace torsion::engine

int main(int count, char** words) {
  if (count == 2 && std::string(words[1]) == torsion::engine::kHoldsDevices) {
    torsion::engine::hold_devices();
  }
  testing::InitGoogleTest(&count, words);
  return RUN_ALL_TESTS();
}
