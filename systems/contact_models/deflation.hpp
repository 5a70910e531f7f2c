#pragma once

// Conjugate gradients for tractions on a body that gives way as a whole by more than its contact
// does: the slow directions are taken out of them. Source: Saad, Yeung, Erhel and Guyomarc'h, SIAM
// J. Sci. Comput. 21 (2000) 1909.

#include <array>

#include "systems/contact_models/patch_solver.hpp"
#include "systems/contact_models/traction_passes.hpp"

namespace torsion {

/// The directions are what the body's motions along the surface (sliding along x and y, turning)
/// ask of the cells that stick. Each step of the cells is made conjugate to them, and they go their
/// own ways, so that the body is in balance with whatever the steps come to: otherwise the friction
/// of a few cells that come to slip throws the end of a slender body aside by a thousand times what
/// they displace themselves, and no step is short enough.
struct Deflation {
  std::size_t directions = 0;  // in PatchWork::pulls_x, pulls_y; conjugate, of curvature 1 Pa m
  std::array<SweepChange, 3> sizes;  // of each
};

/// Needs the cells' ways (find_ways). The steps' columns are zero after it.
Deflation find_deflation(const PatchProblem& problem, const TractionColumns& cells,
                         PatchWork& work);

/// step -= what of it is not conjugate to the directions.
void make_conjugate(const Deflation& deflation, const TractionColumns& cells,
                    const PatchWork& work);

/// Goes to the energy's least along the directions.
/// @return at most so much is changed
SweepChange balance(const Deflation& deflation, const TractionColumns& cells,
                    const PatchWork& work);

}  // namespace torsion
