#pragma once

// A cheap stand-in for the inverse of an influence table: which tractions a displacement asks for,
// by a cell and its eight neighbours.

#include "systems/half_space/influence.hpp"

namespace torsion {

/// What a displacement of a cell asks for there, at its neighbours along x and along y, and at
/// those across a corner.
struct LocalInverse {
  double here = 0.0;
  double along_x = 0.0;
  double along_y = 0.0;
  double corner = 0.0;
};

/// The middle row of the inverse of the influences within three by three cells: the sparse
/// approximate inverse (Benson and Frederickson, Utilitas Mathematica 22 (1982) 127; on Toeplitz
/// matrices, Chan and Ng, SIAM Review 38 (1996) 427). In the tables' units.
LocalInverse local_inverse(const InfluenceTables& tables, InfluenceKind kind);

/// Those of all three directions.
struct LocalInverses {
  LocalInverse x, y, z;
};

inline LocalInverses local_inverses(const InfluenceTables& tables) {
  return {local_inverse(tables, InfluenceKind::kXX), local_inverse(tables, InfluenceKind::kYY),
          local_inverse(tables, InfluenceKind::kZZ)};
}

}  // namespace torsion
