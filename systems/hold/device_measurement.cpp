#include "systems/hold/device_measurement.hpp"

#include <algorithm>
#include <limits>

#include "systems/hold/virtual_coupling.hpp"

namespace torsion::engine {
namespace {

constexpr double kShareToCheck = 0.1;    // of the largest force: dry friction has to be overcome
constexpr double kShareToSwing = 0.15;   // of it
constexpr double kShareAtMost = 0.65;    // of it: to swing it and to hold its weight
constexpr double kTimeToLargest = 0.01;  // s
constexpr double kUsual = 1e-3;          // s
constexpr double kLongest = 20e-3;       // s

/// Bits of the axes of an identification, of what is both measured and displayed.
std::uint8_t axes_of(std::uint8_t felt) {
  std::uint32_t axes = (felt & kTranslationAxes) != 0 ? 7U : 0U;
  axes |= (felt & kRotationAxes) != 0 ? 7U << 3U : 0U;
  axes |= (felt & kTurnAxis) != 0 ? 1U << 4U : 0U;
  return static_cast<std::uint8_t>(axes);
}

void begin(DeviceMeasurement& measurement, const DeviceSample& sample) {
  const VirtualCoupling largest = choose_coupling(sample.traits).coupling;
  const std::uint8_t felt = felt_axes(sample);
  measurement.epoch = sample.epoch;
  measurement.axes = axes_of(felt);
  measurement.traits = sample.traits;
  begin_sign_check(measurement.signs, felt,
                   {kShareToCheck * largest.largest_force, kShareToCheck * largest.largest_torque},
                   measurement.frame, sample.traits.delay);
  begin_identification(
      measurement.identification, measurement.axes,
      {kShareToSwing * largest.largest_force, kShareToSwing * largest.largest_torque},
      measurement.frame);
  measurement.guard = {};
  GuardLimits& limits = measurement.limits;
  limits.largest_force = kShareAtMost * largest.largest_force;
  limits.largest_torque = kShareAtMost * largest.largest_torque;
  limits.largest_force_rate = largest.largest_force / kTimeToLargest;
  limits.largest_torque_rate = largest.largest_torque / kTimeToLargest;
  measurement.speed = {sample.pose, glm::dvec3(0.0), 0.0};
  measurement.stage =
      measurement.axes != 0 ? MeasurementStage::kHold : MeasurementStage::kNotMeasured;
}

/// What follows from the guard's state and from what the person says.
void go_on(DeviceMeasurement& measurement) {
  const GuardState guard = measurement.guard.state;
  const bool on = guard == GuardState::kRising || guard == GuardState::kLive;
  switch (measurement.stage) {
    case MeasurementStage::kHold:
      measurement.stage =
          guard == GuardState::kWaiting ? MeasurementStage::kHold : MeasurementStage::kSigns;
      break;
    case MeasurementStage::kSigns:
      if (on) {
        measurement.stage = measurement.guard.signs == SignVerdict::kRight
                                ? MeasurementStage::kLetGo
                                : MeasurementStage::kNotMeasured;
      } else if (guard != GuardState::kChecking) {
        measurement.stage = MeasurementStage::kNotMeasured;
      }
      break;
    case MeasurementStage::kLetGo:
      measurement.stage = !on ? MeasurementStage::kNotMeasured
                          : measurement.is_alone && guard == GuardState::kLive
                              ? MeasurementStage::kSwinging
                              : MeasurementStage::kLetGo;
      break;
    case MeasurementStage::kSwinging:
      if (!on || measurement.identification.strayed) {
        measurement.stage = MeasurementStage::kNotMeasured;
      } else if (is_done(measurement.identification)) {
        measurement.stage = MeasurementStage::kMeasured;
      }
      break;
    default:
      break;
  }
}

/// Of the axes so far.
struct Least {
  double mass = std::numeric_limits<double>::infinity();
  double damping = std::numeric_limits<double>::infinity();
  bool any = false;

  void take(const AxisDynamics& found) {
    mass = std::min(mass, found.mass);
    damping = std::min(damping, found.damping);
    any = true;
  }
};

}  // namespace

Wrench take_measurement_sample(DeviceMeasurement& measurement, const DeviceSample& sample) {
  const bool live = sample.state == DeviceState::kLive;
  const double since = sample.time - measurement.last_time;
  measurement.last_time = sample.time;
  const bool went =
      measurement.stage == MeasurementStage::kHold && (!live || sample.epoch != measurement.epoch);
  if (went) {
    measurement.stage = MeasurementStage::kDevice;  // nothing was done with it yet
  }
  if (live && measurement.stage == MeasurementStage::kDevice) {
    begin(measurement, sample);
  }
  if (measurement.stage == MeasurementStage::kDevice) {
    return {};
  }
  const double period = std::clamp(since, 1e-5, kLongest);
  measure_speed(measurement.speed, sample.pose, period);
  GuardInput input;
  input.live = live && sample.epoch == measurement.epoch;
  input.held = measurement.is_held && measurement.stage != MeasurementStage::kNotMeasured &&
               measurement.stage != MeasurementStage::kMeasured;
  input.velocity = measurement.speed.velocity;
  input.turn_speed = measurement.speed.turn_speed;
  if (measurement.guard.state == GuardState::kChecking) {
    input.signs = take_sign_sample(measurement.signs, sample.pose, period);
  }
  input.probe = sign_probe(measurement.signs);
  if (measurement.stage == MeasurementStage::kSwinging) {
    input.wanted = take_identification_sample(measurement.identification, sample.pose,
                                              measurement.guard.sent, period);
  }
  if (measurement.stage == MeasurementStage::kLetGo) {
    input.wanted = hold_still(measurement.identification, sample.pose, period);
  }
  const Wrench sent = guard_output(measurement.guard, measurement.limits, input, period);
  go_on(measurement);
  return sent;
}

double swinging_time(const DeviceMeasurement& measurement) {
  return identification_time(measurement.axes);
}

AxisDynamics measured_axis(const DeviceMeasurement& measurement, std::size_t axis) {
  const DeviceTraits& said = measurement.traits;
  return dynamics_of(measurement.identification, axis,
                     axis >= 3 ? said.encoder_turn_step : said.encoder_step);
}

bool is_reliable(const AxisDynamics& found) {
  constexpr double kFarthestOff = 0.2;  // with friction of half the force it is 0.1
  return found.found && found.misfit < kFarthestOff;
}

DeviceTraits measured_traits(const DeviceMeasurement& measurement) {
  Least translation;
  Least turning;
  DeviceTraits traits;
  for (std::size_t axis = 0; axis < kIdentifiedAxes; ++axis) {
    const AxisDynamics found = measured_axis(measurement, axis);
    if (is_reliable(found)) {
      (axis >= 3 ? turning : translation).take(found);
      traits.delay = std::max(traits.delay, found.delay);
    }
  }
  constexpr std::size_t kUp = 1;
  if (is_reliable(measured_axis(measurement, kUp))) {
    traits.weight = std::max(0.0, measurement.identification.carried[kUp]);
  }
  if (translation.any) {
    traits.mass = translation.mass;
    traits.damping = translation.damping;
  }
  if (turning.any) {
    traits.inertia = turning.mass;
    traits.turn_damping = turning.damping;
  }
  return traits;
}

}  // namespace torsion::engine
