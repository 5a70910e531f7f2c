#pragma once

#include <span>

#include "ecs/components.hpp"
#include "systems/step.hpp"

namespace torsion {

/// Sums up every region of a half-space model for drawing: forces block by block, and the bonded
/// discs whose tractions have the region's couple, ring by ring. Writes RegionField.
void region_fields(StepContext& context);

/// Discs that carry given couples: those of equally wide rings of a disc of radius `radius`.
/// @param couples  (kFieldDiscs) N m, on the material, from the innermost ring outwards
/// @param turn     (kFieldDiscs) out: rad
/// Source: Reissner & Sagoci, J. Appl. Phys. 15, 1944: traction (4 G phi / pi) r / sqrt(s^2 - r^2)
/// under a disc of radius s; all discs but those that reach a ring leave it free, so the system is
/// triangular.
void discs_of_ring_couples(std::span<const double> couples, double radius, double shear_modulus,
                           std::span<double> turn);

}  // namespace torsion
