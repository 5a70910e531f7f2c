#pragma once

#include <cmath>
#include <numbers>

namespace torsion::engine {

/// Weight of one sample in the mean that gives a cosine's complex amplitude under Hann's window:
/// the window's own mean is a half, and the amplitude is twice its part at one frequency.
/// Source: Harris, On the use of windows for harmonic analysis, Proc. IEEE 66 (1978).
/// @param at      0 to 1: where in the window
/// @param period  s, of the sample; @param window  s
inline double hann_weight(double at, double period, double window) {
  return 2.0 * (1.0 - std::cos(2.0 * std::numbers::pi * at)) * period / window;
}

}  // namespace torsion::engine
