// A knob that is measured through its driver: over a bus and a clock that are made up, with a shaft
// that has inertia and friction.

#include "systems/hold/device_measurement.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "systems/hold/virtual_coupling.hpp"
#include "tests/device/fake_bus.hpp"

namespace torsion::engine {
namespace {

using test::EmulatedOdrive;
using test::FakeBus;

struct Shaft {
  double inertia = 3e-4;   // kg m^2
  double damping = 2e-3;   // N m s/rad
  double friction = 1e-3;  // N m
  double speed = 0.0;      // rad/s
  double angle = 0.0;      // rad
  double sign = 1.0;       // of its motor
  double pull = 0.0;       // N m: of somebody

  void move(double torque, double dt) {
    const double pushed = sign * torque + pull - damping * speed;
    if (speed == 0.0 && std::abs(pushed) <= friction) {
      return;
    }
    const double next =
        speed + (pushed - std::copysign(friction, speed != 0.0 ? speed : pushed)) * dt / inertia;
    speed = speed * next < 0.0 ? 0.0 : next;
    angle += speed * dt;
  }
};

/// What is measured, and by whom.
struct Bench {
  DeviceMeasurement measurement;
  FakeBus bus{{}, {&measurement, on_sample}};
  std::size_t row = bus.plug(EmulatedOdrive{});
  Shaft shaft;

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    return take_measurement_sample(*static_cast<DeviceMeasurement*>(context), sample);
  }
  void run(double seconds) {
    constexpr double kPart = 1e-4;  // s
    for (const double end = bus.now() + seconds; bus.now() < end;) {
      auto& knob = bus.device<EmulatedOdrive>(row);
      shaft.move(knob.torque, kPart);
      knob.turns = shaft.angle / (2.0 * std::numbers::pi);
      bus.run(kPart);
    }
  }
};

TEST(DeviceMeasurementTest, FindsAKnobsInertiaAndDampingThroughItsDriver) {
  Bench bench;
  bench.run(1.0);
  ASSERT_EQ(bench.measurement.stage, MeasurementStage::kHold);
  EXPECT_GT(bench.bus.without_force_for(bench.row), 0.5);  // nothing before the person agrees
  bench.measurement.is_held = true;
  bench.run(5.0);
  ASSERT_EQ(bench.measurement.stage, MeasurementStage::kLetGo);
  bench.measurement.is_alone = true;
  bench.run(swinging_time(bench.measurement) + 1.0);
  ASSERT_EQ(bench.measurement.stage, MeasurementStage::kMeasured);
  const DeviceTraits traits = measured_traits(bench.measurement);
  EXPECT_NEAR(traits.inertia, 3e-4, 0.05 * 3e-4);
  EXPECT_NEAR(traits.turn_damping, 2e-3, 0.15 * 2e-3);
  EXPECT_EQ(traits.mass, 0.0);
  // The made-up bus brings an answer after 0.8 ms, and a torque when it is written.
  EXPECT_GT(traits.delay, 0.2e-3);
  EXPECT_LT(traits.delay, 1.5e-3);
  EXPECT_GT(bench.bus.without_force_for(bench.row), 0.5);
}

TEST(DeviceMeasurementTest, ARunAwayOrAStrangeHandEndsIt) {
  Bench reversed;
  reversed.shaft.sign = -1.0;
  reversed.measurement.is_held = true;
  reversed.measurement.is_alone = true;
  reversed.run(20.0);
  EXPECT_EQ(reversed.measurement.stage, MeasurementStage::kNotMeasured);
  EXPECT_EQ(reversed.measurement.guard.reason, GuardReason::kReversed);
  EXPECT_LT(std::abs(reversed.shaft.angle), 1.0);
  Bench pulled;
  pulled.measurement.is_held = true;
  pulled.measurement.is_alone = true;
  pulled.run(8.0);
  ASSERT_EQ(pulled.measurement.stage, MeasurementStage::kSwinging);
  pulled.shaft.pull = 0.5;
  pulled.run(2.0);
  EXPECT_EQ(pulled.measurement.stage, MeasurementStage::kNotMeasured);
  pulled.run(0.1);
  EXPECT_GT(pulled.bus.without_force_for(pulled.row), 0.05);
}

TEST(DeviceMeasurementTest, ADeviceThatIsPluggedInAgainBeforeItBeginsBeginsAnew) {
  Bench bench;
  bench.run(1.0);
  ASSERT_EQ(bench.measurement.stage, MeasurementStage::kHold);
  bench.bus.unplug(bench.row);
  bench.bus.run(0.5);
  EXPECT_EQ(bench.measurement.stage, MeasurementStage::kDevice);
  bench.row = bench.bus.plug(EmulatedOdrive{});
  bench.measurement.is_held = true;
  bench.run(6.0);
  EXPECT_EQ(bench.measurement.stage, MeasurementStage::kLetGo);
}

/// Answers of an axis as its dynamics say; `off` [share] turns every other one round.
void answer(Identification& identification, std::size_t axis, double mass, double damping,
            double off) {
  for (std::size_t run = 0; run < kIdentificationRuns; ++run) {
    AxisResponse& response = identification.responses[axis][run];
    const std::array<double, 5> frequencies = {4.0, 8.0, 12.0, 18.0, 26.0};  // Hz
    response.rate = 2.0 * std::numbers::pi * frequencies[run % frequencies.size()];
    const std::complex<double> stiffness(-mass * response.rate * response.rate,
                                         damping * response.rate);
    const double wrong = run % 2 == 0 ? 1.0 + off : 1.0 - off;
    response.force = run < frequencies.size() ? 0.5 : 1.0;
    response.way = response.force / (wrong * stiffness);
  }
}

// One axis without damping is what a coupling has to bear, whichever comes first; one whose answers
// are no mass' is left out.
TEST(DeviceMeasurementTest, CountsOnTheLeastOfWhatIsReliable) {
  for (const bool first : {true, false}) {
    DeviceMeasurement measurement;
    measurement.axes = 7;
    answer(measurement.identification, 0, 0.2, first ? 0.0 : 1.0, 0.0);
    answer(measurement.identification, 1, 0.15, first ? 1.0 : 0.0, 0.0);
    answer(measurement.identification, 2, 0.05, 2.0, 0.6);
    EXPECT_TRUE(is_reliable(measured_axis(measurement, 0)));
    EXPECT_FALSE(is_reliable(measured_axis(measurement, 2)));
    const DeviceTraits traits = measured_traits(measurement);
    EXPECT_NEAR(traits.mass, 0.15, 1e-6);
    EXPECT_NEAR(traits.damping, 0.0, 1e-6);
    EXPECT_EQ(traits.inertia, 0.0);
  }
}

TEST(DeviceMeasurementTest, WhatWasMeasuredSetsTheCoupling) {
  LoopOptions options;
  MeasuredTraits& knob = options.measured[static_cast<std::size_t>(DeviceKind::kOdrive)];
  knob = {0.0, 0.0, 3e-4, 2e-3, 2e-3};
  struct Last {
    DeviceSample sample;
    static Wrench on_sample(void* context, const DeviceSample& sample) {
      static_cast<Last*>(context)->sample = sample;
      return {};
    }
  } last;
  FakeBus bus(options, {&last, Last::on_sample});
  bus.plug(EmulatedOdrive{});
  bus.run(test::kStartTime);
  EXPECT_EQ(last.sample.traits.inertia, 3e-4);
  EXPECT_EQ(last.sample.traits.turn_damping, 2e-3);
  EXPECT_EQ(last.sample.traits.delay, 2e-3);
  EXPECT_EQ(choose_coupling(last.sample.traits).turn_limit, StiffnessLimit::kPassivity);
}

}  // namespace
}  // namespace torsion::engine
