#pragma once

#include <cmath>

#include <Eigen/Dense>

namespace torsion::engine::reference {

/// A plane of an elastic layer that a wave cos k x with k = 1 loads, as rows by the coefficients
/// (A, B, C, D) of Airy's function phi = [(A + B z) cosh z + (C + D z) sinh z] cos x. Displacements
/// times 2 G: -grad phi + (1 - nu) (psi_z, psi_x), psi_xz = laplacian phi (Mindlin and Cheng's
/// form); stresses sigma_zz = -phi, sigma_xz = slope.
struct AiryRows {
  Eigen::RowVector4d phi, slope, sideways, normal;
};

/// @param z  from the base, over the wave number
inline AiryRows airy_rows(double poisson_ratio, double z) {
  const double c = std::cosh(z);
  const double s = std::sinh(z);
  AiryRows rows;
  rows.phi << c, z * c, s, z * s;
  rows.slope << s, c + z * s, c, s + z * c;
  const Eigen::RowVector4d psi(0.0, 2.0 * c, 0.0, 2.0 * s);
  const Eigen::RowVector4d psi_slope(0.0, 2.0 * s, 0.0, 2.0 * c);
  rows.sideways = rows.phi + (1.0 - poisson_ratio) * psi_slope;
  rows.normal = -rows.slope + (1.0 - poisson_ratio) * psi;
  return rows;
}

}  // namespace torsion::engine::reference
