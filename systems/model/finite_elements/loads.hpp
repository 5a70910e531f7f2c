#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "systems/model/finite_elements/grid.hpp"

namespace torsion::engine {

/// Three rows for each node of a grid, one column for each unit wrench: force along, then torque
/// about, the body's axes; the first three alone where forces are all.
using WrenchColumns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, 6>;

/// What drives the smooth part of the displacement under unit wrenches at a port.
struct PortLoads {
  WrenchColumns forces;  // N, at all nodes
  WrenchColumns held;    // m, at clamped nodes: minus the half-space's displacement
};

/// Loads for one port. Where the surface curves away from the port's plane, the half-space's
/// tractions on it grow without bound towards the port: what is near is replaced by the smooth load
/// with the same force and torque, as any contact spreads it.
/// @param elasticity  as for half_space_motion
/// @param columns     3: forces, 6: torques too
PortLoads loads_of_port(const SolidGrid& grid, const Elasticity& elasticity, const Port& port,
                        double shortest_side, int columns);

/// How the material at a point follows from the nodes around it: a quadratic is fitted to their
/// displacements.
struct MotionFit {
  std::vector<std::uint32_t> nodes;
  Eigen::MatrixXd weights;  // 4 rows, one column a node: value, derivatives by x, y, z (1/m)
};

MotionFit fit_motion(const SolidGrid& grid, const glm::dvec3& point);

}  // namespace torsion::engine
