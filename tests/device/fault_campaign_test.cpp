// Sessions in which everything goes wrong that may on a wire: what the motors are told stays within
// their limits, a device that cannot be trusted is without force within 5 ms, and after it was
// plugged in again the session goes on. Over a bus and a clock that are made up, with the guard.

#include <array>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "systems/hold/handle_side.hpp"
#include "tests/device/fake_bus.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

using test::EmulatedDevice;
using test::EmulatedFalcon;
using test::EmulatedMoteus;
using test::EmulatedOdrive;
using test::EmulatedWheel;
using test::EmulatedWooden;
using test::FakeBus;
using test::kStartTime;

constexpr double kWithin = 5e-3;  // s
constexpr double kTick = 1e-4;    // s: a transfer

/// A person who takes hold of a tool where it is, and whom it then keeps pushing: it is 3 mm and
/// 0.3 rad from where the handle was last.
struct Person {
  HandleSide side;
  DeviceSample last;

  Person() { side.safety.checks_signs = false; }

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    auto& person = *static_cast<Person*>(context);
    person.last = sample;
    PhysicsResult physics;
    physics.any = true;
    physics.time = sample.time;
    if (person.side.guard.state == GuardState::kWaiting) {
      physics.tool.position = sample.pose.position;
    } else {
      const Pose& handle = person.side.last;
      physics.tool.position = handle.position + glm::dvec3(0.0, 3e-3, 0.0);
      physics.tool.rotation = glm::angleAxis(0.3, glm::dvec3(0.0, 1.0, 0.0)) * handle.rotation;
    }
    return take_handle_sample(person.side, sample, physics, sample.time).sent;
  }
  SampleSink sink() { return {this, on_sample}; }
};

EmulatedDevice device_of(std::uint32_t kind) {
  switch (kind) {
    case 0:
      return EmulatedFalcon{};
    case 1:
      return EmulatedWooden{};
    case 2:
      return EmulatedOdrive{};
    case 3: {
      EmulatedOdrive newer;
      newer.version = {"0", "6", "9"};
      return newer;
    }
    case 4:
      return EmulatedMoteus{};
    default:
      return EmulatedWheel{};
  }
}
constexpr std::array<const char*, 6> kNames = {"Falcon",     "WoodenHaptics", "ODrive 0.5",
                                               "ODrive 0.6", "moteus",        "wheel"};

/// Of the faults of one kind of device.
struct Tally {
  int sessions = 0;
  int passing = 0;       // faults of one packet
  int lasting = 0;       // from which it has to be without force
  int replugged = 0;     // sessions that were over until then
  double slowest = 0.0;  // s: from a lasting fault until it was without force
  double most = 0.0;     // of what its motors may have
};

struct Random {
  std::mt19937 engine;

  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(engine() % end); }
};

/// One packet that is lost, doubled, cut up or turned over.
void spoil_one(FakeBus& bus, std::size_t row, Random& random) {
  switch (random.below(8)) {
    case 0:
      return bus.spoil_next_answer(row, 1, false, false);
    case 1:
      return bus.spoil_next_answer(row, 2 + random.below(6), false, false);
    case 2:
      return bus.spoil_next_answer(row, 0, true, false);
    case 3:
      return bus.spoil_next_answer(row, 0, false, true);
    case 4:
      return bus.lose_next_write(row);
    case 5:
      return bus.fail_next_read(row, UsbStatus::kStall);
    case 6:
      return bus.fail_next_read(row, UsbStatus::kOverflow);
    default:
      return bus.fail_next_read(row, UsbStatus::kBroken);
  }
}

/// Nothing comes any more, for longer than anybody waits. @return s: until it was without force
double fall_silent(FakeBus& bus, std::size_t row) {
  const bool pushed = bus.without_force_for(row) == 0.0;
  bus.silence(row, true);
  const double start = bus.now();
  while (pushed && bus.without_force_for(row) == 0.0 && bus.now() - start < 1.0) {
    bus.run(kTick);
  }
  const double lasted = bus.now() - start;
  bus.run(0.1);
  EXPECT_GT(bus.without_force_for(row), 0.0);
  bus.silence(row, false);
  return lasted;
}

class FaultCampaignTest : public testing::TestWithParam<std::uint32_t> {};

TEST_P(FaultCampaignTest, ForceStaysWithinItsLimitsAndEndsWithATrustedDevice) {
  Tally tally;
  tally.sessions = test::trials_of(2000, test::kSanitized ? 80 : 20);  // of each of six devices
  Random random{std::mt19937(GetParam() + 1)};
  for (int session = 0; session < tally.sessions; ++session) {
    Person person;
    FakeBus bus(test::with_wheel_torque(), person.sink());
    std::size_t row = bus.plug(device_of(GetParam()));
    bus.run(random.below(2) == 0 ? kStartTime : 1e-3 * random.below(100));  // in its set-up, too
    for (int fault = 0; fault < 20; ++fault) {
      const bool lasts = random.below(5) == 0;
      if (lasts) {
        tally.lasting += 1;
        tally.slowest = std::max(tally.slowest, fall_silent(bus, row));
        if (random.below(2) == 0) {
          bus.brown_out(row);
        }
      } else {
        tally.passing += 1;
        spoil_one(bus, row, random);
      }
      bus.run(1e-3 * random.below(100));
    }
    bus.make_ready(row);  // a person moves it through its range
    bus.run(3.0);
    if (person.last.state != DeviceState::kLive) {
      tally.replugged += 1;
      tally.most = std::max(tally.most, bus.most_pushed(row));
      bus.unplug(row);
      bus.run(0.01);
      row = bus.plug(device_of(GetParam()));
      bus.run(3.0);
    }
    ASSERT_EQ(person.last.state, DeviceState::kLive) << session;
    EXPECT_EQ(person.side.guard.state, GuardState::kLive) << session;
    EXPECT_EQ(bus.without_force_for(row), 0.0) << session;
    tally.most = std::max(tally.most, bus.most_pushed(row));
  }
  std::printf(
      "%-14s %5d sessions, %6d faults of a packet, %5d lasting: without force after %.1f ms at "
      "most; motors told %.2f of their largest at most; %d plugged in again\n",
      kNames[GetParam()], tally.sessions, tally.passing, tally.lasting, 1e3 * tally.slowest,
      tally.most, tally.replugged);
  EXPECT_LE(tally.slowest, kWithin + 1e-9);
  EXPECT_LE(tally.most, 1.0);
  EXPECT_GT(tally.most, 0.02);  // or it would say little
}

INSTANTIATE_TEST_SUITE_P(EachDevice, FaultCampaignTest, testing::Range(0U, 6U));

}  // namespace
}  // namespace torsion::engine
