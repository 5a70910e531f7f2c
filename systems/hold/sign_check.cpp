#include "systems/hold/sign_check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <glm/matrix.hpp>

#include "systems/math/frames.hpp"
#include "systems/math/hann_window.hpp"

namespace torsion::engine {
namespace {

// Hz, of the three axes of a group. Whole numbers, so that none is seen in the window of another;
// above what a hand does on purpose, below where a device of 100 Hz or a tenth of a millimetre's
// count sees nothing.
constexpr std::array<double, 3> kFirstRates = {8.0, 10.0, 12.0};
constexpr std::array<double, 3> kSecond = {15.0, 18.0, 21.0};
constexpr std::array<double, 2> kUndriven = {6.0, 23.0};
constexpr double kRise = 0.1;      // s: by then hand and device have forgotten the beginning
constexpr double kWindow = 1.0;    // s
constexpr double kFall = 0.03;     // s
constexpr double kClear = 2.0;     // times the hand's own motion
constexpr double kSureSign = 2.0;  // times what the sum of mass and damping is uncertain by
constexpr double kPhase =
    0.1;  // share of the stiffness that an unknown delay may turn into damping
constexpr std::uint8_t kMostWindows = 4;  // then it is not seen
constexpr std::uint8_t kDone = 2;

double turn_rate(double frequency) {
  return 2.0 * std::numbers::pi * frequency;
}

/// Whether axis `axis` (of three) of the group is checked.
bool is_checked(const SignCheck& check, std::size_t axis) {
  if (check.group == 0) {
    return (check.checks & kTranslationAxes) != 0;
  }
  return (check.checks & kRotationAxes) != 0 || ((check.checks & kTurnAxis) != 0 && axis == 1);
}

std::size_t checked_axes(const SignCheck& check) {
  std::size_t count = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    count += is_checked(check, axis) ? 1U : 0U;
  }
  return count;
}

/// Of one frequency of one axis: all together never come to more than `largest`.
double amplitude(const SignCheck& check) {
  const std::size_t axes = check.group < kDone ? checked_axes(check) : 0;
  return axes > 0 ? 0.5 * check.largest[check.group] / std::sqrt(static_cast<double>(axes)) : 0.0;
}

void skip_empty_groups(SignCheck& check) {
  while (check.group < kDone && checked_axes(check) == 0) {
    check.group += 1;
  }
}

/// How an axis answered: its bit in what resolved and what was reversed.
struct AxisAnswer {
  bool resolved = false;
  bool reversed = false;
};

AxisAnswer answer_of(const SignCheck& check, std::size_t axis) {
  const std::complex<double> x1 = check.first[axis][axis];
  const std::complex<double> x2 = check.second[axis];
  const double noise1 = std::abs(check.noise[axis][0]);
  const double noise2 = std::abs(check.noise[axis][1]);
  if (!(std::abs(x1) > kClear * noise1) || !(std::abs(x2) > kClear * noise2)) {
    return {};
  }
  const double w1 = turn_rate(kFirstRates[axis]);
  const double w2 = turn_rate(kSecond[axis]);
  const double force = check.windows * amplitude(check);
  const std::complex<double> d1 = force / x1;
  const std::complex<double> d2 = force / x2;
  const double mass = (d1.real() - d2.real()) / (w2 * w2 - w1 * w1);
  const double damping = 0.5 * (d1.imag() / w1 + d2.imag() / w2);
  const double sum = damping * std::sqrt(w1 * w2) + mass * w1 * w2;  // N/m
  const double uncertain = std::abs(d1) * noise1 / std::abs(x1) +
                           std::abs(d2) * noise2 / std::abs(x2) +
                           kPhase * std::max(std::abs(d1), std::abs(d2));
  return {std::abs(sum) > kSureSign * uncertain, sum < -kSureSign * uncertain};
}

/// m: how much all axes answered to the force along one.
double column_size(const SignCheck& check, std::size_t by) {
  double square = 0.0;
  for (std::size_t of = 0; of < 3; ++of) {
    square += std::norm(check.first[of][by]);
  }
  return std::sqrt(square);
}

/// Whether the answers along all three axes together, each column turned by its phase, turn round
/// what the forces were.
bool turns_inside_out(const SignCheck& check, const std::array<std::complex<double>, 3>& phases) {
  constexpr double kShare = 0.05;  // of what axes of their own would have
  glm::dmat3 turned(0.0);
  double size = 1.0;
  for (std::size_t by = 0; by < 3; ++by) {
    for (std::size_t of = 0; of < 3; ++of) {
      turned[static_cast<glm::length_t>(by)][static_cast<glm::length_t>(of)] =
          (check.first[of][by] * phases[by]).real();
    }
    size *= column_size(check, by);
  }
  return glm::determinant(turned) < -kShare * size;
}

/// Whether an odd number of a mechanism's motors is reversed, though no axis alone has to show it.
/// The mobility of a passive hand has a positive definite real part, turned here by a third of a
/// right angle to where neither mass nor damping is far from it.
bool is_inside_out(const SignCheck& check) {
  constexpr double kSpring = 0.2;  // an axis that goes back so much by itself is a spring's
  // From a place to its speed, and on by a third.
  const std::complex<double> phase =
      std::polar(1.0, std::numbers::pi / 2.0 + std::numbers::pi / 6.0);
  double noise = 0.0;
  for (std::size_t of = 0; of < 3; ++of) {
    noise += std::norm(check.noise[of][0]);
  }
  for (std::size_t by = 0; by < 3; ++by) {
    const double size = column_size(check, by);
    const double own = (check.first[by][by] * phase).real();
    if (!(size > kClear * std::sqrt(noise)) || own < -kSpring * size) {
      return false;
    }
  }
  return turns_inside_out(check, {phase, phase, phase});
}

/// Likewise in a hand of springs, where each axis answers the right way by itself: its answer says
/// how late the hand is at its frequency. With that taken out of each column, the answers are the
/// forces as the motors turn them, whose determinant is positive where all of them are right.
bool is_inside_out_in_phase(const SignCheck& check) {
  std::array<std::complex<double>, 3> phases;
  for (std::size_t by = 0; by < 3; ++by) {
    phases[by] = std::polar(1.0, -std::arg(check.first[by][by]));
  }
  return turns_inside_out(check, phases);
}

/// Whether an axis did not answer because the hand moved too much; a handle that nothing moves
/// would not answer another time either.
bool was_moved(const SignCheck& check, std::uint32_t resolved) {
  constexpr double kStandsStill = 1e-9;  // m, rad
  bool moved = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool open = is_checked(check, axis) && (resolved >> axis & 1U) == 0U;
    moved = moved || (open && std::abs(check.noise[axis][0]) > kStandsStill);
  }
  return moved;
}

/// The window is over. @return whether the verdict is that an axis is reversed
bool take_window(SignCheck& check, const Pose& measured) {
  check.windows += 1;
  const std::uint32_t shift = 3U * check.group;
  const std::uint8_t before = check.reversed;
  std::uint32_t resolved = 0;
  std::uint32_t reversed = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisAnswer answer = is_checked(check, axis) ? answer_of(check, axis) : AxisAnswer{};
    resolved |= answer.resolved ? 1U << axis : 0U;
    reversed |= answer.reversed ? 1U << axis : 0U;
  }
  const bool all_right = resolved == 7U && reversed == 0U;
  if (checked_axes(check) == 3 && reversed == 0U &&
      (is_inside_out(check) || (all_right && is_inside_out_in_phase(check)))) {
    reversed = 7U;
  }
  check.resolved &= static_cast<std::uint8_t>(~(7U << shift));
  check.resolved |= static_cast<std::uint8_t>((resolved & ~reversed) << shift);
  check.reversed = static_cast<std::uint8_t>(reversed << shift);
  const bool twice = (check.reversed & before) != 0;
  const bool again = check.windows < kMostWindows && (reversed != 0U || was_moved(check, resolved));
  if (!twice && !again) {
    check.group += 1;
    begin_group_anew(check);
    skip_empty_groups(check);
  }
  check.start = measured;
  check.time = 0.0;
  return twice;
}

SignVerdict verdict_at_the_end(const SignCheck& check) {
  std::uint32_t wanted = (check.checks & kTranslationAxes) != 0 ? 7U : 0U;
  wanted |= (check.checks & kRotationAxes) != 0 ? 7U << 3U : 0U;
  wanted |= (check.checks & kTurnAxis) != 0 ? 1U << 4U : 0U;
  return (check.resolved & wanted) == wanted ? SignVerdict::kRight : SignVerdict::kUnresolved;
}

}  // namespace

std::uint8_t felt_axes(const DeviceSample& sample) {
  std::uint32_t axes = sample.sensed & sample.actuated & (kTranslationAxes | kRotationAxes);
  const bool turns = (sample.sensed & (kTurnAxis | kRotationAxes)) != 0;
  if ((axes & kRotationAxes) == 0 && turns && (sample.actuated & kTurnAxis) != 0) {
    axes |= kTurnAxis;
  }
  return static_cast<std::uint8_t>(axes);
}

void begin_sign_check(SignCheck& check, std::uint8_t checks, std::array<double, 2> largest,
                      const glm::dquat& axes, double delay) {
  check = {};
  check.checks = checks;
  check.largest = largest;
  check.axes = axes;
  check.delay = delay;
  skip_empty_groups(check);
}

void begin_group_anew(SignCheck& check) {
  check.time = 0.0;
  check.windows = 0;
  check.reversed = 0;
  check.first = {};
  check.second = {};
  check.noise = {};
}

SignVerdict take_sign_sample(SignCheck& check, const Pose& measured, double period) {
  if (check.group >= kDone) {
    return verdict_at_the_end(check);
  }
  if (check.time == 0.0) {
    check.start = measured;
  }
  check.time += period;
  const double at = (check.time - kRise) / kWindow;
  if (at >= 1.0) {
    const bool reversed = take_window(check, measured);
    return reversed              ? SignVerdict::kReversed
           : check.group < kDone ? SignVerdict::kRunning
                                 : verdict_at_the_end(check);
  }
  if (at <= 0.0) {
    return SignVerdict::kRunning;
  }
  const glm::dvec3 way =
      check.group == 0
          ? measured.position - check.start.position
          : glm::conjugate(check.axes) * turn_between(check.start.rotation, measured.rotation);
  const double weight = hann_weight(at, period, kWindow);
  const double then = check.time - 0.5 * period - check.delay;  // s: of the force that counts
  const auto wave = [&](double frequency) {
    return weight * std::polar(1.0, -turn_rate(frequency) * then);
  };
  for (std::size_t by = 0; by < 3; ++by) {
    const std::complex<double> first = wave(kFirstRates[by]);
    for (std::size_t of = 0; of < 3; ++of) {
      check.first[of][by] += first * way[static_cast<glm::length_t>(of)];
    }
    check.second[by] += wave(kSecond[by]) * way[static_cast<glm::length_t>(by)];
  }
  for (std::size_t i = 0; i < kUndriven.size(); ++i) {
    const std::complex<double> undriven = wave(kUndriven[i]);
    for (std::size_t of = 0; of < 3; ++of) {
      check.noise[of][i] += undriven * way[static_cast<glm::length_t>(of)];
    }
  }
  return SignVerdict::kRunning;
}

Wrench sign_probe(const SignCheck& check) {
  if (check.group >= kDone) {
    return {};
  }
  const double share =
      std::clamp(std::min(check.time / kRise, (kRise + kWindow - check.time) / kFall), 0.0, 1.0);
  const double size = share * amplitude(check);
  glm::dvec3 probe(0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (is_checked(check, axis)) {
      probe[static_cast<glm::length_t>(axis)] =
          size * (std::cos(turn_rate(kFirstRates[axis]) * check.time) +
                  std::cos(turn_rate(kSecond[axis]) * check.time));
    }
  }
  return check.group == 0 ? Wrench{probe, glm::dvec3(0.0)}
                          : Wrench{glm::dvec3(0.0), check.axes * probe};
}

const char* sign_axis_name(std::size_t axis) {
  constexpr std::array<const char*, kSignAxes> kNames = {
      "x", "y", "z", "turning about x", "turning about y", "turning about z"};
  return kNames[axis];
}

}  // namespace torsion::engine
