#pragma once

// What a haptic device is by itself: mass, damping, dry friction and delay along each axis, found
// while nobody holds it. A small force swings it at one frequency after the other, with two sizes,
// and a soft spring holds it in place meanwhile.

#include <array>
#include <complex>
#include <cstdint>

#include "ecs/components.hpp"

namespace torsion::engine {

/// One axis: F = k x + c v + f sign(v) + m a, a time t after F was asked for. In turning: N m, rad.
struct AxisDynamics {
  bool found = false;
  double mass = 0.0;       // m: kg, kg m^2
  double damping = 0.0;    // c: N s/m, N m s/rad
  double friction = 0.0;   // f: N, N m
  double stiffness = 0.0;  // k: N/m, N m/rad
  double delay = 0.0;      // t, s: beyond the hold of one sample
  double misfit = 0.0;     // of what was measured: root of the mean square, share
};

/// Axes: three of the translation, then three of the turning.
inline constexpr std::size_t kIdentifiedAxes = 6;
inline constexpr std::size_t kIdentificationRuns = 10;  // an axis: five frequencies, two sizes

/// How an axis answered to one frequency.
struct AxisResponse {
  double rate = 0.0;           // w, rad/s
  std::complex<double> force;  // N, N m: amplitude
  std::complex<double> way;    // m, rad
};

struct Identification {
  std::array<double, 2> largest{};       // N, N m: of the swinging force and torque
  std::uint8_t axes = 0;                 // bits: that are measured and displayed
  glm::dquat frame{1.0, 0.0, 0.0, 0.0};  // that turning is looked at in, world: y is the turn axis

  // While it goes on.
  bool begun = false;
  bool strayed = false;  // it left its place: nothing is found
  Pose home;
  std::size_t axis = 0;  // kIdentifiedAxes: done
  std::size_t run = 0;
  double time = 0.0;                             // s: of this run
  std::array<double, kIdentifiedAxes> way{};     // m, rad, from home
  std::array<double, kIdentifiedAxes> speed{};   // m/s, rad/s: smoothed
  std::array<double, kIdentifiedAxes> weight{};  // N, N m: of itself, as the spring has to bear it
  // N, N m: likewise, when the axis had been swung to its end, which overcomes dry friction
  std::array<double, kIdentifiedAxes> carried{};
  AxisResponse now;
  std::array<std::array<AxisResponse, kIdentificationRuns>, kIdentifiedAxes> responses{};
};

/// @param axes     bits, of kIdentifiedAxes
/// @param largest  N and N m: that may swing it; holding it in place may take as much three times
void begin_identification(Identification& identification, std::uint8_t axes,
                          std::array<double, 2> largest, const glm::dquat& frame);

/// One sample before it begins: the handle is held where a person lets go of it, by a stiffer
/// spring, which learns what it weighs.
/// @return what its motors are to hold next, world axes
Wrench hold_still(Identification& identification, const Pose& measured, double period);

/// One sample.
/// @param measured  the handle, world axes
/// @param sent      what its motors held since the sample before, world axes
/// @param period    s
/// @return what they are to hold next; zero when it is done
Wrench take_identification_sample(Identification& identification, const Pose& measured,
                                  const Wrench& sent, double period);

[[nodiscard]] bool is_done(const Identification& identification);

/// s: how long all of it takes.
double identification_time(std::uint8_t axes);

/// Least squares of the dynamic stiffness F / x = (k - m w^2 + i w (c + 4 f / (pi V))) exp(i w t),
/// where friction is taken for the damping that takes as much energy from a swing of speed V
/// (Slotine & Li, Applied Nonlinear Control, 5.2: describing functions).
/// @param count  m, rad: of its encoders; 0: not known
AxisDynamics dynamics_of(const Identification& identification, std::size_t axis, double count);

}  // namespace torsion::engine
