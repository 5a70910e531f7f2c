#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>
#include <glm/vec3.hpp>

#include "ecs/result.hpp"
#include "systems/model/finite_elements/grid.hpp"

namespace torsion::engine {

using ElementStiffness = Eigen::Matrix<double, 24, 24>;

/// Stiffness (N/m for a shear modulus of 1 Pa) of an eight-node hexahedron with assumed stresses:
/// 18 stress modes, linear along no two axes at once but crosswise, so that it is exact in bending
/// and has a single pressure mode, which cannot lock at nu = 0.5.
/// @param corners     m, numbered as SolidGrid::elements
/// @param bulk_modulus  over the shear modulus, finite
/// Source: Pian & Tong, "Relations between incompatible displacement model and hybrid stress
/// model", Int. J. Numer. Meth. Engng 22 (1986), the 18-parameter element.
ElementStiffness element_stiffness(const std::array<glm::dvec3, 8>& corners, double bulk_modulus);

/// Columns of values at the free nodes, three rows a node, in the order of a StiffnessFactor.
using NodeColumns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline Eigen::Index rows_of(std::size_t nodes) {
  return 3 * static_cast<Eigen::Index>(nodes);
}

/// A block of nodes that are eliminated together.
struct StiffnessFront {
  std::uint32_t first = 0;              // its nodes are first to first + count in the order
  std::uint32_t count = 0;              // nodes
  std::vector<std::uint32_t> boundary;  // later nodes that it is joined to, rising, in the order
  std::vector<std::uint32_t> children;  // earlier fronts whose boundary it finishes
  Eigen::MatrixXd diagonal;             // lower triangle of the factor
  Eigen::MatrixXd below;                // rows of the boundary
};

/// Cholesky factor of a grid's stiffness, clamped nodes left out.
struct StiffnessFactor {
  std::vector<std::uint32_t> order;  // of each node of the grid; kNoRow for a clamped one
  std::uint32_t free_nodes = 0;
  std::vector<StiffnessFront> fronts;  // children before parents
};

/// Factors the stiffness by fronts over a nested dissection of the lattice: each separator is one
/// of its planes, so the fronts are few and dense.
/// @param stiffness  of element `row` of the grid
/// @return an Error when the stiffness is not positive definite
/// Source: George, "Nested dissection of a regular finite element mesh", SIAM J. Numer. Anal. 10
/// (1973); Duff & Reid, "The multifrontal solution of indefinite sparse symmetric linear
/// equations", ACM TOMS 9 (1983).
Result<StiffnessFactor> factor_stiffness(
    const SolidGrid& grid, const std::function<ElementStiffness(std::size_t row)>& stiffness,
    const std::function<void(double)>& progress);

/// Replaces loads by displacements.
/// @param columns  3 factor.free_nodes rows
void solve_stiffness(const StiffnessFactor& factor, NodeColumns& columns);

}  // namespace torsion::engine
