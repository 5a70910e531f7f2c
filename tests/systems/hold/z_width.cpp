#include "tests/systems/hold/z_width.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace torsion::engine::test {

bool is_stable(const WallDevice& device, double stiffness, double damping, bool is_held) {
  constexpr int kParts = 20;       // of a period
  constexpr double kPush = 1.0;    // N
  constexpr double kEnd = 4.0;     // s
  constexpr double kLook = 0.5;    // s: in the middle and at the end
  constexpr double kStill = 1e-6;  // of the depth that the push comes to
  const double dt = device.period / kParts;
  const auto late = static_cast<std::size_t>(std::lround(device.delay / dt));
  const double mass = device.mass + (is_held ? device.grip_mass : 0.0);
  const double own = device.damping + (is_held ? device.grip_damping : 0.0);
  const double grip = is_held ? device.grip_stiffness : 0.0;
  const double depth = kPush / (stiffness + grip);
  std::vector<double> ring(late + 1, 0.0);
  double x = 0.5 * depth;
  double v = 0.0;
  double before = x;
  double force = 0.0;
  double earlier = 0.0;  // m: how far it swings
  double later = 0.0;
  std::size_t at = 0;
  const auto samples = static_cast<int>(kEnd / device.period);
  for (int i = 0; i < samples; ++i) {
    const double speed = (x - before) / device.period;
    before = x;
    force = -stiffness * x - damping * speed;
    for (int part = 0; part < kParts; ++part) {
      ring[at % ring.size()] = force;
      at += 1;
      const double felt = ring[at % ring.size()];  // of `late` parts ago
      const double a = (kPush + felt - grip * x - own * v) / mass;
      x += (v + 0.5 * a * dt) * dt;  // to the second order: a first one would be early or late
      v += a * dt;
    }
    if (!(std::abs(x) < 1e3 * depth)) {
      return false;
    }
    const double time = i * device.period;
    const double swing = std::abs(x - depth);
    if (time > 0.5 * kEnd && time < 0.5 * kEnd + kLook) {
      earlier = std::max(earlier, swing);
    } else if (time > kEnd - kLook) {
      later = std::max(later, swing);
    }
  }
  return later < earlier || later < kStill * depth;  // a linear system grows or decays
}

double largest_stable_stiffness(const WallDevice& device, double damping, bool is_held) {
  constexpr double kSoftest = 0.05;  // of what is passive without virtual damping
  constexpr double kStep = 1.15;
  constexpr int kHalvings = 8;
  double low = kSoftest * passive_stiffness(device, 0.0);
  if (!is_stable(device, low, damping, is_held)) {
    return 0.0;
  }
  double high = kStep * low;
  while (is_stable(device, high, damping, is_held)) {
    low = high;
    high *= kStep;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (is_stable(device, middle, damping, is_held) ? low : high) = middle;
  }
  return low;
}

double passive_stiffness(const WallDevice& device, double damping) {
  return std::max(0.0, (device.damping - std::abs(damping)) / (0.5 * device.period + device.delay));
}

}  // namespace torsion::engine::test
