#pragma once

#include "ecs/components.hpp"

namespace torsion::engine {

// Sums and multiples of wrenches about the same point.

inline Wrench operator+(const Wrench& a, const Wrench& b) {
  return {a.force + b.force, a.torque + b.torque};
}
inline Wrench operator-(const Wrench& a, const Wrench& b) {
  return {a.force - b.force, a.torque - b.torque};
}
inline Wrench operator*(const Wrench& a, double share) {
  return {a.force * share, a.torque * share};
}

}  // namespace torsion::engine
