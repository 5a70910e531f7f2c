// An arm with weight: what a measurement finds of it, and that a session then carries it. A mass at
// the end of a WoodenHaptics, through its driver, over a bus and a clock that are made up.

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/hold/device_measurement.hpp"
#include "systems/hold/handle_side.hpp"
#include "tests/device/fake_bus.hpp"
#include "tests/device/wooden_arm.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

using test::EmulatedWooden;
using test::FakeBus;
using test::WoodenArm;

constexpr double kGravity = 9.81;  // m/s^2

/// A mass at its handle, with dry friction in any direction.
struct HeavyArm {
  WoodenArm arm;
  double mass = 0.2;      // kg
  double damping = 0.5;   // N s/m
  double friction = 0.0;  // N
  bool is_held = false;   // by a hand, where the arm was at first
  glm::dvec3 first = place_of(arm);
  glm::dvec3 velocity{0.0};

  explicit HeavyArm(double kilograms) : mass(kilograms) {}

  void move(EmulatedWooden& device, double dt) {
    glm::dvec3 force = push_of(arm, device) - damping * velocity;
    force.z -= mass * kGravity;
    if (is_held) {
      force += 200.0 * (first - place_of(arm)) - 6.0 * velocity;
    }
    const double speed = glm::length(velocity);
    const glm::dvec3 way = speed > 1e-9 ? velocity : force;
    const bool stands = speed <= 1e-9 && glm::length(force) <= friction;
    if (stands || glm::length(way) == 0.0) {
      velocity = glm::dvec3(0.0);
    } else {
      const glm::dvec3 next = velocity + (force - friction * glm::normalize(way)) * dt / mass;
      velocity = speed > 1e-9 && glm::dot(next, velocity) < 0.0 ? glm::dvec3(0.0) : next;
    }
    move_by(arm, device, velocity * dt);
  }
};

void run(FakeBus& bus, std::size_t row, HeavyArm& arm, double seconds) {
  constexpr double kPart = 1e-4;  // s
  for (const double end = bus.now() + seconds; bus.now() < end;) {
    auto& device = bus.device<EmulatedWooden>(row);
    if (device.calibrations > 0) {
      arm.move(device, kPart);
    }
    bus.run(kPart);
  }
}

DeviceMeasurement measure(HeavyArm arm) {
  DeviceMeasurement measurement;
  const auto on_sample = [](void* context, const DeviceSample& sample) {
    return take_measurement_sample(*static_cast<DeviceMeasurement*>(context), sample);
  };
  FakeBus bus({}, {&measurement, on_sample});
  const std::size_t row = bus.plug(EmulatedWooden{});
  arm.is_held = true;
  run(bus, row, arm, 1.0);
  EXPECT_EQ(measurement.stage, MeasurementStage::kHold);
  measurement.is_held = true;
  run(bus, row, arm, 6.0);
  EXPECT_EQ(measurement.stage, MeasurementStage::kLetGo);
  arm.is_held = false;
  run(bus, row, arm, 2.0);
  measurement.is_alone = true;
  run(bus, row, arm, swinging_time(measurement) + 1.0);
  return measurement;
}

// What nobody could measure as it fell before it was swung. Swings overcome dry friction, so that
// what is left of the weight and of it is what a spring of 15 N/m that learns in 2 s has not learnt
// in 13 s, a count of that spring, and half a milliampere of two motors at the end of the arm. With
// more weight the motors reach their largest current in a swing.
TEST(CarriedArmTest, AMeasurementFindsWhatItWeighs) {
  const WoodenGeometry geometry = wooden_haptics_2015();
  const double rounding = 15.0 * 64e-6 + 1e-3 * geometry.torque_constant.z * geometry.body.z /
                                             (geometry.capstan.z * geometry.length_c);  // N
  const auto masses = test::kSanitized ? std::vector{0.12} : std::vector{0.05, 0.12, 0.17};
  for (const double mass : masses) {
    for (const double friction : test::kSanitized ? std::vector{0.2} : std::vector{0.0, 0.2}) {
      SCOPED_TRACE(testing::Message() << mass << " kg, " << friction << " N");
      HeavyArm arm(mass);
      arm.friction = friction;
      const DeviceMeasurement measurement = measure(arm);
      EXPECT_EQ(measurement.stage, MeasurementStage::kMeasured);
      const DeviceTraits traits = measured_traits(measurement);
      const double left = (mass * kGravity + friction) * std::exp(-13.0 / 2.0);
      EXPECT_NEAR(traits.weight, mass * kGravity, left + rounding);
      EXPECT_NEAR(traits.mass, mass, 0.1 * mass);  // as IdentificationTest has it
    }
  }
}

TEST(CarriedArmTest, OneTooHeavyForItsMotorsIsNotMeasured) {
  const DeviceMeasurement measurement = measure(HeavyArm(0.35));
  EXPECT_EQ(measurement.stage, MeasurementStage::kNotMeasured);
  EXPECT_EQ(measurement.guard.sent.force, glm::dvec3(0.0));
}

/// A session in which the tool goes wherever the handle takes it.
struct FreeTool {
  HandleSide side;
  HandleOutcome last;

  FreeTool() { side.safety.checks_signs = false; }

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    auto& held = *static_cast<FreeTool*>(context);
    PhysicsResult physics;
    physics.any = true;
    physics.time = sample.time;
    physics.tool = held.side.guard.state == GuardState::kWaiting ? sample.pose : held.side.last;
    held.last = take_handle_sample(held.side, sample, physics, sample.time);
    return held.last.sent;
  }
};

/// m: how far the arm is from where the hand let go of it, two seconds later.
double fall(const HeavyArm& heavy, double weight, FreeTool& held) {
  LoopOptions options;
  options.measured[static_cast<std::size_t>(DeviceKind::kWoodenHaptics)].weight = weight;
  FakeBus bus(options, {&held, FreeTool::on_sample});
  HeavyArm arm = heavy;
  const std::size_t row = bus.plug(EmulatedWooden{});
  arm.is_held = true;
  run(bus, row, arm, 3.0);
  EXPECT_EQ(held.side.guard.state, GuardState::kLive);
  arm.is_held = false;
  double farthest = 0.0;
  for (int i = 0; i < 20; ++i) {
    run(bus, row, arm, 0.1);
    farthest = std::max(farthest, glm::length(place_of(arm.arm) - arm.first));
    if (farthest > 0.1) {
      break;
    }
  }
  return farthest;
}

TEST(CarriedArmTest, ASessionCarriesWhatWasMeasured) {
  HeavyArm arm(0.15);
  arm.friction = 0.1;
  const double weight = measured_traits(measure(arm)).weight;
  FreeTool without;
  EXPECT_GT(fall(arm, 0.0, without), 0.1);
  FreeTool with;
  EXPECT_LT(fall(arm, weight, with), 0.01);
  EXPECT_NEAR(with.last.sent.force.y - with.last.wrench.force.y, weight, 1e-9);
  // What the person feels of the tool, and the books of its energy, are without it.
  EXPECT_NEAR(with.last.wrench.force.y, 0.0, 0.2);
}

}  // namespace
}  // namespace torsion::engine
