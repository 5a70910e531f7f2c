#include "systems/model/finite_elements/element.hpp"

#include <cstdint>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <glm/mat3x3.hpp>

#include "systems/model/finite_elements/grid.hpp"

namespace torsion {
namespace {

constexpr int kModes = 18;
using Modes = Eigen::Matrix<double, 6, kModes>;  // rows xx, yy, zz, xy, yz, zx
using Strains = Eigen::Matrix<double, 6, 24>;    // engineering shear strains
using Compliance = Eigen::Matrix<double, 6, 6>;

/// a b' made symmetric, as a stress.
Eigen::Matrix<double, 6, 1> dyad(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.x * b.x,
          a.y * b.y,
          a.z * b.z,
          0.5 * (a.x * b.y + a.y * b.x),
          0.5 * (a.y * b.z + a.z * b.y),
          0.5 * (a.z * b.x + a.x * b.z)};
}

/// Constant stresses, and for each of the element's axes the direct stress along it, varying with
/// the other two and their product, and the shear in the plane of the other two, varying along it.
Modes stress_modes(const glm::dmat3& axes, const glm::dvec3& local) {
  Modes modes = Modes::Zero();
  modes.leftCols<6>().setIdentity();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    const Eigen::Matrix<double, 6, 1> direct = dyad(axes[k], axes[k]);
    modes.col(6 + 4 * k) = direct * local[i];
    modes.col(7 + 4 * k) = direct * local[j];
    modes.col(8 + 4 * k) = direct * (local[i] * local[j]);
    modes.col(9 + 4 * k) = dyad(axes[i], axes[j]) * local[k];
  }
  return modes;
}

Strains strains_of_corners(const glm::dmat3& jacobian, const glm::dvec3& local) {
  const std::array<glm::dvec3, 8> slopes = corner_slopes(jacobian, local);
  Strains strains = Strains::Zero();
  for (std::uint32_t c = 0; c < 8; ++c) {
    const glm::dvec3& slope = slopes[c];
    const Eigen::Index first = 3 * Eigen::Index{c};
    strains(0, first) = slope.x;
    strains(1, first + 1) = slope.y;
    strains(2, first + 2) = slope.z;
    strains(3, first) = slope.y;
    strains(3, first + 1) = slope.x;
    strains(4, first + 1) = slope.z;
    strains(4, first + 2) = slope.y;
    strains(5, first) = slope.z;
    strains(5, first + 2) = slope.x;
  }
  return strains;
}

}  // namespace

ElementStiffness element_stiffness(const std::array<glm::dvec3, 8>& corners, double bulk_modulus) {
  Compliance compliance = Compliance::Zero();
  compliance.topLeftCorner<3, 3>().setConstant(1.0 / (9.0 * bulk_modulus) - 1.0 / 6.0);
  compliance.diagonal().head<3>().array() += 0.5;
  compliance.diagonal().tail<3>().setOnes();

  constexpr double kGauss = 0.5773502691896258;
  const glm::dmat3 axes = element_jacobian(corners, glm::dvec3(0.0));
  const double length = 1.0 / std::cbrt(glm::determinant(axes));
  Eigen::Matrix<double, kModes, kModes> flexibility = Eigen::Matrix<double, kModes, kModes>::Zero();
  Eigen::Matrix<double, kModes, 24> leverage = Eigen::Matrix<double, kModes, 24>::Zero();
  for (std::uint32_t c = 0; c < 8; ++c) {
    const glm::dvec3 local(c & 1U ? kGauss : -kGauss, c & 2U ? kGauss : -kGauss,
                           c & 4U ? kGauss : -kGauss);
    const glm::dmat3 jacobian = element_jacobian(corners, local);
    const double volume = glm::determinant(jacobian);
    const Modes modes = stress_modes(axes * length, local);
    flexibility += volume * modes.transpose() * compliance * modes;
    leverage += volume * modes.transpose() * strains_of_corners(jacobian, local);
  }
  return leverage.transpose() * flexibility.ldlt().solve(leverage);
}

}  // namespace torsion
