#include "render/heat_scale.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace torsion::engine {

double HeatScale::value_at(double share) const {
  const double part = 2.0 * share - 1.0;
  const double linear = square_roots ? 0.5 + 0.5 * part * std::abs(part) : share;
  return low + (high - low) * linear;
}

HeatScale heat_scale(HeatMap map, double limit) {
  if (map == HeatMap::kTwist) {
    const double degrees = limit * 180.0 / std::numbers::pi;
    return {-degrees, degrees, "twist angle [\xC2\xB0], root scale", true};
  }
  constexpr std::array<std::pair<double, const char*>, 3> kUnits = {
      {{1e6, "MPa"}, {1e3, "kPa"}, {1.0, "Pa"}}};
  for (const auto& [factor, name] : kUnits) {
    if (limit >= factor) {
      return {0.0, limit / factor, std::string("pressure [") + name + "]", false};
    }
  }
  return {0.0, limit, "pressure [Pa]", false};
}

}  // namespace torsion::engine
