#pragma once

#include <array>

#include <Eigen/Core>
#include <glm/vec3.hpp>

namespace torsion {

using ElementStiffness = Eigen::Matrix<double, 24, 24>;

/// Stiffness (N/m for a shear modulus of 1 Pa) of an eight-node hexahedron with assumed stresses:
/// 18 stress modes, linear along no two axes at once but crosswise, so that it is exact in bending
/// and has a single pressure mode, which cannot lock at nu = 0.5.
/// @param corners     m, numbered as SolidGrid::elements
/// @param bulk_modulus  over the shear modulus, finite
/// Source: Pian & Tong, "Relations between incompatible displacement model and hybrid stress
/// model", Int. J. Numer. Meth. Engng 22 (1986), the 18-parameter element.
ElementStiffness element_stiffness(const std::array<glm::dvec3, 8>& corners, double bulk_modulus);

}  // namespace torsion
