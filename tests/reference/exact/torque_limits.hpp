#pragma once

#include <array>
#include <numbers>
#include <string_view>

namespace torsion::engine::reference {

/// The pressures over a disc that contact models in use assume.
enum class PressureShape {
  kWinkler,    // p0 (1 - r^2/a^2): independent springs, hydroelastic (pressure-field) contact of a
               // sphere
  kHertz,      // p0 sqrt(1 - r^2/a^2): a sphere on an elastic half-space
  kUniform,    // F / (pi a^2)
  kFlatPunch,  // F / (2 pi a sqrt(a^2 - r^2)): a rigid flat end on an elastic half-space
};

struct TorqueLimit {
  PressureShape shape;
  std::string_view name;
  double
      factor;  // largest friction torque of a spinning disc, over mu F a: 2 pi int p r^2 dr / (F a)
};

/// Ascending; neighbours differ by 10 to 18 %. Exact, by integration of each pressure.
inline constexpr std::array<TorqueLimit, 4> kTorqueLimits = {{
    {PressureShape::kWinkler, "Winkler", 8.0 / 15.0},
    {PressureShape::kHertz, "Hertz", 3.0 * std::numbers::pi / 16.0},
    {PressureShape::kUniform, "uniform", 2.0 / 3.0},
    {PressureShape::kFlatPunch, "flat punch", std::numbers::pi / 4.0},
}};

constexpr double torque_limit_factor(PressureShape shape) {
  for (const TorqueLimit& limit : kTorqueLimits) {
    if (limit.shape == shape) {
      return limit.factor;
    }
  }
  return 0.0;
}

}  // namespace torsion::engine::reference
