#include "systems/model/finite_elements/loads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "systems/math/linear_algebra.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

/// The distance from a port within which the surface counts as the contact's own surroundings: wide
/// enough for the elements to resolve, and at most the size of a large contact.
constexpr double kNearOfSide = 0.15;     // of the shortest side
constexpr double kNearInElements = 1.5;  // at least
/// On surfaces across an edge, where tractions are bounded, only as far as no contact could fit in.
constexpr double kNearAcrossEdge = 0.02;  // of the shortest side

Eigen::Index row_of(std::uint32_t node) {
  return 3 * Eigen::Index{node};
}

/// Force and torque about `about` that a force at `point` is, one column for each force.
Eigen::Matrix<double, 6, 3> wrench_of_force(const glm::dvec3& point, const glm::dvec3& about) {
  const glm::dvec3 arm = point - about;
  Eigen::Matrix<double, 6, 3> wrench;
  wrench.topRows<3>().setIdentity();
  wrench.bottomRows<3>() << 0.0, -arm.z, arm.y, arm.z, 0.0, -arm.x, -arm.y, arm.x, 0.0;
  return wrench;
}

/// These radii, m.
struct Near {
  double around;
  double across_edge;
};

/// A point of a bilinear face.
struct FacePoint {
  glm::dvec3 position;              // m
  glm::dvec3 normal;                // m^2 for each unit of the face's coordinates, outward
  std::array<double, 4> weights{};  // of the corners
};

FacePoint face_point(const std::array<glm::dvec3, 4>& corners, double s, double t) {
  FacePoint point;
  point.weights = {(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t};
  point.position = glm::dvec3(0.0);
  for (std::size_t k = 0; k < 4; ++k) {
    point.position += corners[k] * point.weights[k];
  }
  const glm::dvec3 by_s = (corners[1] - corners[0]) * (1.0 - t) + (corners[2] - corners[3]) * t;
  const glm::dvec3 by_t = (corners[3] - corners[0]) * (1.0 - s) + (corners[2] - corners[1]) * s;
  point.normal = glm::cross(by_s, by_t);
  return point;
}

/// The loads that are left out around a port when its tractions act on the rest of the surface.
struct LeftOut {
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> wrench;  // about the port, for each unit wrench
  Eigen::VectorXd area;                                      // m^2, of each node
};

/// Adds minus the tractions on one face to loads and to `left_out`, without those near the port.
void add_face(const SolidGrid& grid, const std::array<std::uint32_t, 4>& face,
              const Elasticity& elasticity, const Port& port, const Near& near, PortLoads& loads,
              LeftOut& left_out) {
  std::array<glm::dvec3, 4> corners{};
  double height = 0.0;  // m, over the port's plane
  for (std::size_t k = 0; k < 4; ++k) {
    corners[k] = grid.nodes[face[k]];
    height = std::max(height, std::abs(glm::dot(corners[k] - port.position, port.normal)));
  }
  const double size =
      std::max(glm::distance(corners[0], corners[2]), glm::distance(corners[1], corners[3]));
  const double distance =
      glm::distance(0.25 * (corners[0] + corners[1] + corners[2] + corners[3]), port.position);
  const bool in_plane = height < 1e-9 * near.around;  // free of traction
  if (in_plane && distance > 1.5 * near.around + size) {
    return;
  }
  // Two points along each side of parts that are at most half as wide as they are far from the
  // port.
  const int parts = static_cast<int>(std::clamp(std::ceil(2.0 * size / distance), 1.0, 8.0));
  const auto coordinate = [&](int k) {
    constexpr double kGauss = 0.2113248654051871;
    const int part = k / 2;
    return (part + (k % 2 == 0 ? kGauss : 1.0 - kGauss)) / parts;
  };
  const double share = 0.25 / (parts * parts);
  for (int k = 0; k < 4 * parts * parts; ++k) {
    const FacePoint at =
        face_point(corners, coordinate(k % (2 * parts)), coordinate(k / (2 * parts)));
    const double reach = glm::distance(at.position, port.position);
    const double area = share * glm::length(at.normal);
    const bool around = glm::dot(at.normal, port.normal) > 0.7 * glm::length(at.normal);
    const double middle = around ? near.around : near.across_edge;
    const double kept = smooth_step(reach / middle - 0.5);
    if (around) {
      for (std::size_t c = 0; c < 4; ++c) {
        left_out.area[Eigen::Index{face[c]}] += (1.0 - kept) * area * at.weights[c];
      }
    }
    if (in_plane || kept == 0.0) {
      continue;
    }
    const Eigen::Matrix<double, 6, 3> lever = wrench_of_force(at.position, port.position);
    for (int column = 0; column < loads.forces.cols(); ++column) {
      const Eigen::Vector3d force =
          -kept * share *
          eigen(half_space_stress(port, elasticity, unit_wrench(column), at.position) * at.normal);
      for (std::size_t c = 0; c < 4; ++c) {
        loads.forces.block<3, 1>(row_of(face[c]), column) += at.weights[c] * force;
      }
      left_out.wrench.col(column) -= lever * force;
    }
  }
}

/// The stress by a field's displacement, nu < 0.5; the field need not be in equilibrium.
glm::dmat3 stress_of_motion(const Port& port, const Elasticity& elasticity, const Wrench& wrench,
                            const glm::dvec3& point) {
  const glm::dmat3 gradient = half_space_gradient(port, elasticity, wrench, point);
  const double shear = elasticity.shear_modulus();
  const double spread = 2.0 * shear * elasticity.poisson_ratio /
                        (1.0 - 2.0 * elasticity.poisson_ratio) *
                        (gradient[0][0] + gradient[1][1] + gradient[2][2]);
  return shear * (gradient + glm::transpose(gradient)) + glm::dmat3(spread);
}

/// Where a concave body rises far above the port's plane and nu < 0.5, the half-space's formulas
/// are kept finite and are no solution: their tractions on the surface are not all that is missing.
/// Elements there get minus the formulas' own stresses instead, and their faces' tractions back.
void add_overhang(const SolidGrid& grid, const std::array<std::uint32_t, 8>& element,
                  const std::array<glm::dvec3, 8>& corners, const Elasticity& elasticity,
                  const Port& port, const Near& near, PortLoads& loads, LeftOut& left_out) {
  for (const std::array<std::uint32_t, 4>& side : kElementSides) {
    // In the opposite sense: what two such elements share cancels.
    add_face(grid, {element[side[3]], element[side[2]], element[side[1]], element[side[0]]},
             elasticity, port, near, loads, left_out);
  }
  constexpr double kGauss = 0.5773502691896258;
  for (std::uint32_t k = 0; k < 8; ++k) {
    const glm::dvec3 local(k & 1U ? kGauss : -kGauss, k & 2U ? kGauss : -kGauss,
                           k & 4U ? kGauss : -kGauss);
    glm::dvec3 point(0.0);
    for (std::uint32_t c = 0; c < 8; ++c) {
      const glm::dvec3 sign(c & 1U ? 1.0 : -1.0, c & 2U ? 1.0 : -1.0, c & 4U ? 1.0 : -1.0);
      const glm::dvec3 part = 0.5 * (glm::dvec3(1.0) + sign * local);
      point += corners[c] * (part.x * part.y * part.z);
    }
    const glm::dmat3 jacobian = element_jacobian(corners, local);
    const double volume = glm::determinant(jacobian);
    const std::array<glm::dvec3, 8> slopes = corner_slopes(jacobian, local);
    for (int column = 0; column < loads.forces.cols(); ++column) {
      const glm::dmat3 stress =
          stress_of_motion(port, elasticity, unit_wrench(column), point) * volume;
      for (std::size_t c = 0; c < 8; ++c) {
        loads.forces.block<3, 1>(row_of(element[c]), column) -= eigen(stress * slopes[c]);
      }
    }
  }
}

/// Whether a corner is so steeply above the port that half_space_motion is no solution near it.
bool overhangs(const std::array<glm::dvec3, 8>& corners, const Port& port, const Near& near) {
  return std::any_of(corners.begin(), corners.end(), [&](const glm::dvec3& corner) {
    const glm::dvec3 offset = corner - port.position;
    const double distance = glm::length(offset);
    return distance > near.around && glm::dot(offset, port.normal) > 0.5 * distance;
  });
}

/// Puts the missing wrenches on the nodes around the port: forces proportional to the area left out
/// and linear in the position, which can make up any force and torque.
void add_left_out(const SolidGrid& grid, const Port& port, LeftOut left_out, PortLoads& loads) {
  if (left_out.area.maxCoeff() <= 0.0) {  // a coarse grid: the nearest node's surroundings
    for (std::size_t node = 0; node < grid.nodes.size(); ++node) {
      const double reach = glm::length((grid.nodes[node] - port.position) / (2.0 * grid.spacing));
      left_out.area[static_cast<Eigen::Index>(node)] = std::exp(-reach * reach);
    }
  }
  Matrix6 spread = Matrix6::Zero();
  for (std::size_t node = 0; node < grid.nodes.size(); ++node) {
    const double area = left_out.area[static_cast<Eigen::Index>(node)];
    if (area > 0.0) {
      const Eigen::Matrix<double, 6, 3> lever = wrench_of_force(grid.nodes[node], port.position);
      spread += area * lever * lever.transpose();
    }
  }
  const Eigen::MatrixXd amounts = least_norm_solution(spread, left_out.wrench);
  for (std::size_t node = 0; node < grid.nodes.size(); ++node) {
    const double area = left_out.area[static_cast<Eigen::Index>(node)];
    if (area > 0.0) {
      loads.forces.middleRows<3>(row_of(static_cast<std::uint32_t>(node))) +=
          area * wrench_of_force(grid.nodes[node], port.position).transpose() * amounts;
    }
  }
}

}  // namespace

PortLoads loads_of_port(const SolidGrid& grid, const Elasticity& elasticity, const Port& port,
                        double shortest_side, int columns) {
  const auto nodes = static_cast<Eigen::Index>(grid.nodes.size());
  const Near near{
      std::max(kNearOfSide * shortest_side,
               kNearInElements * std::max({grid.spacing.x, grid.spacing.y, grid.spacing.z})),
      kNearAcrossEdge * shortest_side};
  PortLoads loads{WrenchColumns::Zero(3 * nodes, columns), WrenchColumns::Zero(3 * nodes, columns)};
  LeftOut left_out{Eigen::MatrixXd::Identity(6, columns), Eigen::VectorXd::Zero(nodes)};
  for (const std::array<std::uint32_t, 4>& face : grid.faces) {
    add_face(grid, face, elasticity, port, near, loads, left_out);
  }
  if (elasticity.poisson_ratio < 0.5) {
    for (std::size_t e = 0; e < grid.elements.size(); ++e) {
      const std::array<glm::dvec3, 8> corners = element_corners(grid, e);
      if (overhangs(corners, port, near)) {
        add_overhang(grid, grid.elements[e], corners, elasticity, port, near, loads, left_out);
      }
    }
  }
  add_left_out(grid, port, std::move(left_out), loads);
  for (std::uint32_t node = 0; node < grid.nodes.size(); ++node) {
    if (grid.clamped[node] == 0) {
      continue;
    }
    glm::dvec3 point = grid.nodes[node];
    if (glm::distance(point, port.position) < near.across_edge) {
      point = port.position - port.normal * near.across_edge;
    }
    for (int column = 0; column < columns; ++column) {
      loads.held.block<3, 1>(row_of(node), column) =
          -eigen(half_space_motion(port, elasticity, unit_wrench(column), point).displacement);
    }
  }
  return loads;
}

MotionFit fit_motion(const SolidGrid& grid, const glm::dvec3& point) {
  constexpr double kReach = 2.3;       // spacings
  constexpr std::size_t kFewest = 27;  // nodes: a quadratic has ten coefficients
  std::vector<double> reach(grid.nodes.size());
  std::transform(grid.nodes.begin(), grid.nodes.end(), reach.begin(), [&](const glm::dvec3& node) {
    return glm::length((node - point) / grid.spacing);
  });
  std::vector<std::uint32_t> rows(grid.nodes.size());
  std::iota(rows.begin(), rows.end(), 0U);
  // All nodes that can be needed, if there are enough of them: then there is little to sort.
  const auto far = std::stable_partition(
      rows.begin(), rows.end(), [&](std::uint32_t row) { return reach[row] <= 2.0 * kReach; });
  if (static_cast<std::size_t>(far - rows.begin()) >= kFewest) {
    rows.erase(far, rows.end());
  }
  std::sort(rows.begin(), rows.end(), [&](std::uint32_t a, std::uint32_t b) {
    return reach[a] != reach[b] ? reach[a] < reach[b] : a < b;
  });
  MotionFit fit;
  for (const std::uint32_t row : rows) {
    if (fit.nodes.size() >= kFewest && reach[row] > kReach) {
      break;
    }
    fit.nodes.push_back(row);
  }
  const auto count = static_cast<Eigen::Index>(fit.nodes.size());
  Eigen::MatrixXd terms(count, 10);
  Eigen::VectorXd trust(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::uint32_t node = fit.nodes[static_cast<std::size_t>(k)];
    const glm::dvec3 at = (grid.nodes[node] - point) / grid.spacing;
    trust[k] = std::exp(-0.5 * reach[node] * reach[node] / (1.5 * 1.5));
    terms.row(k) << 1.0, at.x, at.y, at.z, at.x * at.x, at.y * at.y, at.z * at.z, at.x * at.y,
        at.y * at.z, at.z * at.x;
    terms.row(k) *= trust[k];
  }
  const Eigen::MatrixXd inverse = pseudo_inverse(terms);
  fit.weights = inverse.topRows<4>() * trust.asDiagonal();
  for (int axis = 0; axis < 3; ++axis) {
    fit.weights.row(1 + axis) /= grid.spacing[axis];
  }
  return fit;
}

}  // namespace torsion::engine
