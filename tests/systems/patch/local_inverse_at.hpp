#pragma once

#include <cstdlib>

#include "systems/half_space/influence.hpp"

namespace torsion::engine::test {

/// The traction that the local inverse gives for a displacement of a cell at one that is (x, y)
/// cells away.
inline double local_inverse_at(const LocalInverse& inverse, int x, int y) {
  const double rows[2][2] = {{inverse.here, inverse.along_y}, {inverse.along_x, inverse.corner}};
  return std::abs(x) <= 1 && std::abs(y) <= 1 ? rows[std::abs(x)][std::abs(y)] : 0.0;
}

}  // namespace torsion::engine::test
