#include "app/round_up.hpp"

#include <cmath>
#include <initializer_list>

namespace torsion::engine {

double round_up(double value) {
  if (!(value > 0.0)) {
    return 1.0;
  }
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power * (1.0 + 1e-9)) {
      return step * power;
    }
  }
  return 10.0 * power;
}

}  // namespace torsion::engine
