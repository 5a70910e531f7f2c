#pragma once

#include <array>

#include <Eigen/Core>

#include "systems/body/compliance/supported_regions.hpp"

namespace torsion::engine {

// What Newton's step of a compliant body makes of contacts that cannot hold what it counts on them
// to hold. Motions are scaled, y = K^(1/2) du, in the body's axes.

/// Of a region whose material moves by y while its tool goes on as in this step. Beside what it
/// does where the material stays, its load changes by -K^(1/2) (y - slipped).
struct RegionSlip {
  bool any;
  Vector6 slipped;  // what friction does not hold of y
  Matrix6 change;   // of that with y; where there is any
};
using Slips = std::array<RegionSlip, kMaxRegionsPerBody>;

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
// On the stack: a step takes nothing from the heap.
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6 * kMaxRegionsPerBody, 1>;

/// Newton's equations of a body, n = 6 rows a region, were all contacts to stick: A y = b.
struct StuckEquations {
  Eigen::Map<RowMatrix>& couplings;  // I + K^(1/2) C K^(1/2): the diagonal and what is right of it
  Eigen::Map<RowMatrix>& matrix;     // A, all of it
  const Vector& right;               // b
};

/// Solves A y - K^(1/2) C K^(1/2) s(y) = b, with s what slips, from the solution without slip, by
/// Newton's method. Where it does not converge, what satisfies the equations best is taken.
/// @param jacobian  n x n, is overwritten
/// @param motion    n: y, before that of A y = b
/// @param slips     of `motion`; filled
void let_slip(const CompliantBody& body, const StiffnessRoots& roots,
              const StuckEquations& equations, Eigen::Map<RowMatrix>& jacobian, Vector& motion,
              Slips& slips);

}  // namespace torsion::engine
