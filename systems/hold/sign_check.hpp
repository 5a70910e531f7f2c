#pragma once

// Whether a device pushes the way it is told and measures the way it goes, before it gets a force
// that depends on where it is. With a sign the wrong way round every spring would drive the handle
// away from where it pulls to.

#include <array>
#include <complex>
#include <cstdint>

#include "ecs/components.hpp"
#include "ecs/device_sample.hpp"

namespace torsion::engine {

enum class SignVerdict : std::uint8_t {
  kRunning,
  kRight,
  kReversed,    // of at least one axis
  kUnresolved,  // nothing that it displays moved it by more than a hand moves by itself
};

/// Axes of a check: three of the translation, then three of the turning.
inline constexpr std::size_t kSignAxes = 6;

/// Small forces of two frequencies along each axis, and what of the handle's motion has these
/// frequencies. It is the dynamic stiffness D(w) = F / x = k + i w c - w^2 m of hand and device
/// that decides: whatever the grip, its m and its c are positive where the signs are right, and
/// both negative where one is reversed (a stiff spring does not look like a mass that goes the
/// wrong way, which at one frequency it would). Along axes that are coupled by a mechanism of
/// several motors the determinant of the mobility, too, is positive where all its motors are right.
struct SignCheck {
  std::array<double, 2> largest{};      // N, N m: of the force and of the torque that it may use
  std::uint8_t checks = 0;              // of DeviceAxes: what is measured and displayed
  glm::dquat axes{1.0, 0.0, 0.0, 0.0};  // that turning is checked about, world: y is the turn axis
  double delay = 0.0;                   // s: from a place measured to its force held, but the hold

  // While it goes on.
  Pose start;
  double time = 0.0;          // s: of the group of three axes that is checked now
  std::uint8_t group = 0;     // 0: translation, 1: turning, 2: done
  std::uint8_t windows = 0;   // of this group that are in the sums below
  std::uint8_t resolved = 0;  // bits: axes that answered
  std::uint8_t reversed = 0;  // bits: axes that went the wrong way
  std::array<std::array<std::complex<double>, 3>, 3> first{};  // [of axis][by axis]: m, rad
  std::array<std::complex<double>, 3> second{};                // its own other frequency
  std::array<std::array<std::complex<double>, 2>, 3> noise{};  // where nothing is driven
};

/// Of DeviceAxes: what a device both measures and displays.
std::uint8_t felt_axes(const DeviceSample& sample);

/// @param checks   felt_axes() of the device
/// @param largest  N and N m: that the check may use, a twentieth of the device's
void begin_sign_check(SignCheck& check, std::uint8_t checks, std::array<double, 2> largest,
                      const glm::dquat& axes, double delay);

/// It was interrupted: the group that was looked at begins anew, what is done stays done.
void begin_group_anew(SignCheck& check);

/// One sample.
/// @param measured  the handle, world axes
/// @param period    s
SignVerdict take_sign_sample(SignCheck& check, const Pose& measured, double period);

/// What to display until the next sample, world axes; zero where nothing is checked any more.
Wrench sign_probe(const SignCheck& check);

/// For a person: the name of an axis, whose bit may be in `reversed`.
const char* sign_axis_name(std::size_t axis);

}  // namespace torsion::engine
