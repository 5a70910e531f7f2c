#pragma once

#include "systems/contact/law.hpp"

namespace torsion::engine {

// The contact model `paper`: equations (1)-(14) of Luo & Xiao (IROS 2007), read as docs/models.md
// says.

/// Nonlinear point force law f = k1 x + k3 x^3 of the region's equivalent point contact, x the
/// overlap's mean depth.
struct PaperNormalLaw {
  double linear = 0.0;  // k1, N/m
  double cubic = 0.0;   // k3, N/m^3
};

/// k1 puts the flat punch of the region's radius, 2 E* a, in series with the body's beam, E A / L;
/// k3 is the odd part of an incompressible neo-Hookean column, (4/3) E A / L^3. Without a beam
/// (axial_stiffness 0) only the punch is left.
/// @param contact_modulus  E*, Pa
/// @param radius           a, m
/// @param axial_stiffness  E A / L of the main beam, N/m; 0: none
/// @param length           L, m
PaperNormalLaw paper_normal_law(double contact_modulus, double radius, double axial_stiffness,
                                double length);

/// Normal force of every region of a body with this model. Writes RegionNormal.
void paper_normal_forces(StepContext& context);

/// Friction of every region of a body with this model, cell by cell: traction, stick or slip,
/// friction force and couple, stick radius. Writes CellTraction and RegionFriction.
void paper_friction_forces(StepContext& context);

}  // namespace torsion::engine
