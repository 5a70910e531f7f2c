#pragma once

#include <algorithm>
#include <cmath>

namespace torsion::engine {

/// sRGB's curve and back (IEC 61966-2-1), 0 to 1; what is outside is put at the nearer end.
inline double srgb_encoded(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}
inline double srgb_decoded(double encoded) {
  const double c = std::clamp(encoded, 0.0, 1.0);
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

}  // namespace torsion::engine
