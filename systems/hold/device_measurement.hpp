#pragma once

// The course of a measurement of a device by itself: its signs are checked while the person holds
// it loosely, then the person lets go and it is swung. The guard stands between all of it and the
// motors.

#include "ecs/device_sample.hpp"
#include "systems/hold/hand_speed.hpp"
#include "systems/hold/identification.hpp"
#include "systems/hold/output_guard.hpp"

namespace torsion::engine {

enum class MeasurementStage : std::uint8_t {
  kDevice,    // waits until it is live
  kHold,      // waits until the person holds it and says so
  kSigns,     // are looked at
  kLetGo,     // waits until the person has let go of it
  kSwinging,  // is measured
  kMeasured,
  kNotMeasured,  // OutputGuard::reason says why, or it strayed
};

struct DeviceMeasurement {
  MeasurementStage stage = MeasurementStage::kDevice;
  bool is_held = false;  // the person says so
  bool is_alone = false;
  std::uint8_t axes = 0;                 // bits, of kIdentifiedAxes
  glm::dquat frame{1.0, 0.0, 0.0, 0.0};  // world: y is the turn axis
  std::uint32_t epoch = 0;
  SignCheck signs;
  OutputGuard guard;
  GuardLimits limits;
  HandSpeed speed;
  Identification identification;
  double last_time = 0.0;  // s
  DeviceTraits traits;     // as the device says them
};

/// One sample of the device.
/// @return what its motors are to hold next, world axes
Wrench take_measurement_sample(DeviceMeasurement& measurement, const DeviceSample& sample);

/// s: from the start of the swinging to its end.
double swinging_time(const DeviceMeasurement& measurement);

/// What was found along one axis. @param axis  of kIdentifiedAxes
AxisDynamics measured_axis(const DeviceMeasurement& measurement, std::size_t axis);

/// Whether an axis was found, and the fit is near enough to what was measured to count on it.
bool is_reliable(const AxisDynamics& found);

/// Of its axes that are reliable, the smallest mass and damping and the longest delay: what a
/// coupling that is stable along all of them may count on. In turning likewise. Zero where none is,
/// and a damping of zero where one axis has none. Its weight is what its motors held it up with.
DeviceTraits measured_traits(const DeviceMeasurement& measurement);

}  // namespace torsion::engine
