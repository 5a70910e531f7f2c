#include "systems/hold/thermal_limit.hpp"

#include <algorithm>
#include <cmath>

namespace torsion::engine {

double allowed_now(const ThermalLimit& limit, double largest) {
  constexpr double kFree = 0.8;  // of the mean square
  if (!(limit.continuous > 0.0) || largest <= limit.continuous) {
    return largest;
  }
  const double share = limit.loss / (limit.continuous * limit.continuous);
  const double way = std::clamp((share - kFree) / (1.0 - kFree), 0.0, 1.0);
  return largest + way * (limit.continuous - largest);
}

void take_loss(ThermalLimit& limit, double sent, double period) {
  limit.loss += (sent * sent - limit.loss) * -std::expm1(-period / limit.time);
}

}  // namespace torsion::engine
