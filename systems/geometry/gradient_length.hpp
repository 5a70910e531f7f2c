#pragma once

#include "systems/math/smooth_step.hpp"

namespace torsion {

/// How far a distance's gradient is a normal: 1 where its length is. Beside the edges of a mesh the
/// distances of a field are between those to both faces, and so is their gradient, which is shorter
/// for that: 0 from .96 of a normal's length.
inline double normal_share(double length_squared) {
  constexpr double kBetweenFaces = 0.93;
  constexpr double kOnFace = 0.99;
  return smooth_step((length_squared - kBetweenFaces) / (kOnFace - kBetweenFaces));
}

}  // namespace torsion
