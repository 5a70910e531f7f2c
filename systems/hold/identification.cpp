#include "systems/hold/identification.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/math/frames.hpp"
#include "systems/math/hann_window.hpp"

namespace torsion::engine {
namespace {

constexpr std::array<double, 5> kFrequencies = {4.0, 8.0, 12.0, 18.0, 26.0};  // Hz: whole swings
constexpr double kSettle = 2.0;        // s: the spring learns what it has to bear
constexpr double kRunUp = 0.3;         // s: of each run
constexpr double kSwings = 1.0;        // s
constexpr double kSpringReach = 0.05;  // m: at which the spring has the swinging force
constexpr double kSpringTurn = 0.5;    // rad
constexpr double kDamperTime = 0.05;   // s: damping over stiffness of what holds it
constexpr double kLearnTime = 2.0;     // s
// Before it is swung, while a person lets go of it: it may be heavy, and nobody knows how heavy.
constexpr double kFirmly = 5.0;
constexpr double kLearnSooner = 0.3;   // s
constexpr double kLeash = 0.02;        // m: farther from its place its place follows
constexpr double kMostWeight = 3.0;    // of the swinging force
constexpr double kStrays = 0.04;       // m
constexpr double kTurnStrays = 1.0;    // rad
constexpr double kSwingMemory = 5e-3;  // s
constexpr double kLatest = 20e-3;      // s

std::size_t group_of(std::size_t axis) {
  return axis / 3;
}

bool is_asked(const Identification& identification, std::size_t axis) {
  return (identification.axes >> axis & 1U) != 0U;
}

void skip_axes(Identification& identification) {
  while (identification.axis < kIdentifiedAxes && !is_asked(identification, identification.axis)) {
    identification.axis += 1;
  }
}

double rate_of(std::size_t run) {
  return 2.0 * std::numbers::pi * kFrequencies[run % kFrequencies.size()];
}

double amplitude_of(const Identification& identification) {
  const double largest = identification.largest[group_of(identification.axis)];
  return identification.run < kFrequencies.size() ? 0.5 * largest : largest;
}

/// s: before the first run there is time to settle.
double run_up(const Identification& identification) {
  return kRunUp + (identification.run == 0 ? kSettle : 0.0);
}

std::array<double, kIdentifiedAxes> along_axes(const Identification& identification,
                                               const glm::dvec3& translation,
                                               const glm::dvec3& turn) {
  const glm::dvec3 turned = glm::conjugate(identification.frame) * turn;
  return {translation.x, translation.y, translation.z, turned.x, turned.y, turned.z};
}

void take_motion(Identification& identification, const Pose& measured, double period) {
  const auto way = along_axes(identification, measured.position - identification.home.position,
                              turn_between(identification.home.rotation, measured.rotation));
  for (std::size_t axis = 0; axis < kIdentifiedAxes; ++axis) {
    const double step = way[axis] - identification.way[axis];
    identification.speed[axis] +=
        (step - identification.speed[axis] * period) / (period + kSwingMemory);
    identification.way[axis] = way[axis];
    const double strays = group_of(axis) == 0 ? kStrays : kTurnStrays;
    identification.strayed = identification.strayed ||
                             (is_asked(identification, axis) && !(std::abs(way[axis]) < strays));
  }
}

/// Adds a sample to the amplitudes of this run, of force and way.
void take_swing(Identification& identification, const Wrench& sent, double period) {
  const double at = (identification.time - run_up(identification)) / kSwings;
  if (at <= 0.0) {
    return;
  }
  const std::size_t axis = identification.axis;
  const double rate = rate_of(identification.run);
  const double weight = hann_weight(at, period, kSwings);
  const double force = along_axes(identification, sent.force, sent.torque)[axis];
  identification.now.rate = rate;
  identification.now.way +=
      weight * identification.way[axis] * std::polar(1.0, -rate * identification.time);
  // It was held until now, from one period ago on.
  identification.now.force +=
      weight * force * std::polar(1.0, -rate * (identification.time - 0.5 * period));
}

void end_run(Identification& identification) {
  identification.responses[identification.axis][identification.run] = identification.now;
  identification.now = {};
  identification.time = 0.0;
  identification.run += 1;
  if (identification.run == kIdentificationRuns) {
    identification.carried[identification.axis] = identification.weight[identification.axis];
    identification.run = 0;
    identification.axis += 1;
    skip_axes(identification);
  }
}

/// What holds it in place along an axis: a spring and damper, and its weight.
double holding_force(Identification& identification, std::size_t axis, double period,
                     bool is_swung) {
  const bool translates = group_of(axis) == 0;
  const bool firmly = translates && !is_swung;
  const double largest = identification.largest[group_of(axis)];
  const double stiffness =
      (firmly ? kFirmly : 1.0) * largest / (translates ? kSpringReach : kSpringTurn);
  const double pull = -stiffness * identification.way[axis];
  const double learnt = pull * period / (firmly ? kLearnSooner : kLearnTime);
  identification.weight[axis] = std::clamp(identification.weight[axis] + learnt,
                                           -kMostWeight * largest, kMostWeight * largest);
  return identification.weight[axis] + pull - stiffness * kDamperTime * identification.speed[axis];
}

std::array<double, kIdentifiedAxes> holding_forces(Identification& identification, double period,
                                                   bool is_swung) {
  std::array<double, kIdentifiedAxes> forces{};
  for (std::size_t axis = 0; axis < kIdentifiedAxes; ++axis) {
    forces[axis] = is_asked(identification, axis)
                       ? holding_force(identification, axis, period, is_swung)
                       : 0.0;
  }
  return forces;
}

Wrench wrench_of(const Identification& identification,
                 const std::array<double, kIdentifiedAxes>& forces) {
  return {{forces[0], forces[1], forces[2]},
          identification.frame * glm::dvec3(forces[3], forces[4], forces[5])};
}

/// A response that counts, and how much.
struct Weighed {
  double rate = 0.0;
  std::complex<double> stiffness;  // F / x
  double speed = 0.0;              // V
  double weight = 0.0;
};

/// What two unknowns of a + b u come to, none of them below `floor`.
struct FittedLine {
  double a = 0.0;
  double b = 0.0;
};

struct LineSums {
  double s = 0.0;
  double u = 0.0;
  double uu = 0.0;
  double y = 0.0;
  double uy = 0.0;

  void add(double weight, double at, double value) {
    s += weight;
    u += weight * at;
    uu += weight * at * at;
    y += weight * value;
    uy += weight * at * value;
  }
  [[nodiscard]] FittedLine line() const {
    const double determinant = s * uu - u * u;
    if (!(determinant > 1e-12 * s * uu)) {
      return {s > 0.0 ? y / s : 0.0, 0.0};
    }
    return {(uu * y - u * uy) / determinant, (s * uy - u * y) / determinant};
  }
  /// Neither below zero: energy is only taken.
  [[nodiscard]] FittedLine rising_line() const {
    const FittedLine free = line();
    if (free.a >= 0.0 && free.b >= 0.0) {
      return free;
    }
    return free.a < 0.0 ? FittedLine{0.0, std::max(0.0, uu > 0.0 ? uy / uu : 0.0)}
                        : FittedLine{std::max(0.0, s > 0.0 ? y / s : 0.0), 0.0};
  }
};

template <std::size_t N>
AxisDynamics fit_with_delay(const std::array<Weighed, N>& responses, double delay) {
  LineSums in_phase;   // k - m w^2
  LineSums out_phase;  // c + 4 f / (pi V)
  for (const Weighed& one : responses) {
    const std::complex<double> z = one.stiffness * std::polar(1.0, -one.rate * delay);
    const double relative = one.weight / std::norm(one.stiffness);
    in_phase.add(relative, -one.rate * one.rate, z.real());
    out_phase.add(relative * one.rate * one.rate, 4.0 / (std::numbers::pi * one.speed),
                  z.imag() / one.rate);
  }
  const FittedLine stiff = in_phase.line();
  const FittedLine loss = out_phase.rising_line();
  AxisDynamics fit{true, stiff.b, loss.a, loss.b, stiff.a, delay, 0.0};
  double square = 0.0;
  double all = 0.0;
  for (const Weighed& one : responses) {
    const std::complex<double> model(
        fit.stiffness - fit.mass * one.rate * one.rate,
        one.rate * (fit.damping + fit.friction * 4.0 / (std::numbers::pi * one.speed)));
    const std::complex<double> z = one.stiffness * std::polar(1.0, -one.rate * delay);
    square += one.weight * std::norm(z - model) / std::norm(z);
    all += one.weight;
  }
  fit.misfit = std::sqrt(square / all);
  return fit;
}

}  // namespace

void begin_identification(Identification& identification, std::uint8_t axes,
                          std::array<double, 2> largest, const glm::dquat& frame) {
  identification = {};
  identification.axes = axes;
  identification.largest = largest;
  identification.frame = frame;
  skip_axes(identification);
}

Wrench hold_still(Identification& identification, const Pose& measured, double period) {
  if (!identification.begun) {
    identification.begun = true;
    identification.home = measured;
  }
  const glm::dvec3 off = measured.position - identification.home.position;
  const double far = glm::length(off);
  if (far > kLeash) {
    identification.home.position += off * (1.0 - kLeash / far);
  }
  identification.home.rotation = measured.rotation;
  take_motion(identification, measured, period);
  identification.strayed = false;
  return wrench_of(identification, holding_forces(identification, period, false));
}

Wrench take_identification_sample(Identification& identification, const Pose& measured,
                                  const Wrench& sent, double period) {
  if (!identification.begun) {
    identification.begun = true;
    identification.home = measured;
  }
  take_motion(identification, measured, period);
  if (is_done(identification)) {
    return {};
  }
  identification.time += period;
  take_swing(identification, sent, period);
  if (identification.time >= run_up(identification) + kSwings) {
    end_run(identification);
  }
  auto forces = holding_forces(identification, period, true);
  if (identification.axis < kIdentifiedAxes) {
    const double swinging =
        identification.run == 0 ? identification.time - kSettle : identification.time;
    if (swinging > 0.0) {
      const double rises = std::min(1.0, swinging / (0.5 * kRunUp));
      forces[identification.axis] += rises * amplitude_of(identification) *
                                     std::cos(rate_of(identification.run) * identification.time);
    }
  }
  return wrench_of(identification, forces);
}

bool is_done(const Identification& identification) {
  return identification.strayed || identification.axis == kIdentifiedAxes;
}

double identification_time(std::uint8_t axes) {
  double time = 0.0;
  for (std::size_t axis = 0; axis < kIdentifiedAxes; ++axis) {
    time += (axes >> axis & 1U) != 0U
                ? kSettle + static_cast<double>(kIdentificationRuns) * (kRunUp + kSwings)
                : 0.0;
  }
  return time;
}

AxisDynamics dynamics_of(const Identification& identification, std::size_t axis, double count) {
  constexpr double kOwnError = 0.02;  // share: of what is swung at all
  constexpr std::size_t kFewest = 6;
  std::array<Weighed, kIdentificationRuns> responses{};
  std::size_t good = 0;
  for (std::size_t run = 0; run < kIdentificationRuns; ++run) {
    const AxisResponse& response = identification.responses[axis][run];
    const double size = std::abs(response.way);
    Weighed& one = responses[run];
    one = {rate_of(run), {1.0, 0.0}, 1.0, 0.0};
    if (size > count && size > 0.0 && std::abs(response.force) > 0.0) {
      // Rounding to counts is an error of a twelfth of their square, spread over a run's samples.
      const double share = 0.1 * count / size;
      one.stiffness = response.force / response.way;
      one.speed = response.rate * size;
      one.weight = 1.0 / (kOwnError * kOwnError + share * share);
      good += 1;
    }
  }
  if (good < kFewest) {
    return {};
  }
  AxisDynamics best = fit_with_delay(responses, 0.0);
  constexpr double kStep = 2e-5;  // s
  for (double delay = kStep; delay < kLatest; delay += kStep) {
    const AxisDynamics fit = fit_with_delay(responses, delay);
    best = fit.misfit < best.misfit ? fit : best;
  }
  best.found = best.mass > 0.0;
  return best;
}

}  // namespace torsion::engine
