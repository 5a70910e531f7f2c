#pragma once

#include <ctime>

namespace torsion::engine {

/// s, on CLOCK_MONOTONIC, as all times of devices are.
inline double steady_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace torsion::engine
