#include "systems/body_models/compliance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include "systems/body_models/contact_load.hpp"
#include "systems/body_models/footing.hpp"
#include "systems/body_models/half_space_fields.hpp"
#include "systems/body_models/layer_motion.hpp"
#include "systems/body_models/smooth_compliance.hpp"
#include "systems/contact_models/layer_coupling.hpp"
#include "systems/contact_models/layer_thickness.hpp"
#include "systems/frames.hpp"
#include "systems/patch_grid.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A region on the body.
struct Stand {
  std::uint32_t region = 0;
  std::uint32_t block = 0;  // of cells, and row of its footing
  ContactLoad load;
  Vector6 motion = Vector6::Zero();  // at the footing's centre, by this region's own load
};

/// One body at work.
struct CompliantBody {
  World& world;
  std::uint32_t row;
  PortCompliance ports;
  std::array<Stand, kMaxRegionsPerBody> stands{};
  std::size_t count = 0;
};

Footing& footing_of(const CompliantBody& body, const Stand& stand) {
  return body.world.footings.at<Footing>(stand.block);
}

Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// The smallest eigenvalue that K^(1/2) C K^(1/2) may have: -1 would leave no compliance at all,
/// and interpolation between ports could bring it below.
constexpr double kStiffest = -0.75;

/// Stiffness of a contact that sticks, about its point, along tangents and normal. Source: Johnson,
/// 1985; Reissner & Sagoci, 1944.
Vector6 contact_stiffness(double radius, const Elasticity& elasticity) {
  const double g = elasticity.shear_modulus();
  const double nu = elasticity.poisson_ratio;
  const double a = radius;
  const double drag = 8.0 * g * a / (2.0 - nu);
  const double tilt = 8.0 * g * a * a * a / (3.0 * (1.0 - nu));
  Vector6 stiffness;
  stiffness << drag, drag, 4.0 * g * a / (1.0 - nu), tilt, tilt, 16.0 / 3.0 * g * a * a * a;
  return stiffness;
}

/// From the body's axes to tangents and normal.
Matrix6 to_contact(const Footing& footing) {
  Eigen::Matrix3d rotation;
  rotation << eigen(footing.tangent_x).transpose(), eigen(footing.tangent_y).transpose(),
      eigen(footing.normal).transpose();
  Matrix6 both = Matrix6::Zero();
  both.topLeftCorner<3, 3>() = rotation;
  both.bottomRightCorner<3, 3>() = rotation;
  return both;
}

/// A symmetric compliance over the contact's own: eigenvalues and what makes them a compliance
/// again.
struct RelativeCompliance {
  Eigen::SelfAdjointEigenSolver<Matrix6> solver;
  Matrix6 back;

  RelativeCompliance(const CompliantBody& body, const Footing& footing, const Matrix6& motion) {
    const Vector6 root =
        contact_stiffness(footing.radius, body.world.bodies.at<Elasticity>(body.row)).cwiseSqrt();
    const Matrix6 axes = to_contact(footing);
    const Matrix6 scaled =
        root.asDiagonal() * (axes * motion * axes.transpose()) * root.asDiagonal();
    solver.compute(0.5 * (scaled + scaled.transpose()));
    back = axes.transpose() * root.cwiseInverse().asDiagonal() * solver.eigenvectors();
  }
  [[nodiscard]] Matrix6 at_least(double least) const {
    return back * solver.eigenvalues().cwiseMax(least).asDiagonal() * back.transpose();
  }
};

/// What a region's own wrench does to it: the part that yields goes to Newton's matrix. Where the
/// rest of the body stiffens the half-space (a layer) Newton's method would overshoot as soon as
/// the contact slips, and plain iteration converges.
void find_own_motion(const CompliantBody& body, Footing& footing) {
  const RelativeCompliance relative(body, footing, motion_between(body.ports, footing, footing));
  const double least = relative.solver.eigenvalues()[0];
  footing.share = std::min(1.0, kStiffest / std::min(least, -1e-300));
  footing.on_layer = 0;
  Eigen::Map<Matrix6>(footing.own.data()) = relative.at_least(0.0);
}

/// On a layer the ports do not count: patch has what the half-space lacks in its own tables
/// (layer_kernel.hpp), mdr is moved as one.
void find_motion_on_layer(const CompliantBody& body, const ContactEllipse& contact,
                          double thickness, bool has_tables, Footing& footing) {
  footing.share = 0.0;
  footing.on_layer = 1;
  footing.own = {};
  if (!has_tables && has_layer_kernel(body.world, body.row)) {
    const Matrix6 motion = layer_motion(body.world, body.row, contact, thickness);
    Eigen::Map<Matrix6>(footing.own.data()) =
        RelativeCompliance(body, footing, motion).at_least(kStiffest);
  }
}

/// Takes the regions of the body, lays their footings where they have moved, and moves them by
/// their own loads.
void find_stands(CompliantBody& body) {
  World& world = body.world;
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
    if (identity.body != body.row) {
      continue;
    }
    Stand& stand = body.stands[body.count++];
    stand.region = region;
    stand.block = block_of(identity);
    Footing& footing = footing_of(body, stand);
    const ContactEllipse contact = contact_ellipse(world, region);
    if (!still_fits(footing, contact)) {
      lay_footing(body.ports, contact, footing);
      footing.serial = world.clock.at<Clock>(0).step * world.footings.size() + stand.block + 1;
      const double thickness = layer_thickness(world, body.row, contact.normal, contact.center);
      if (thickness > 0.0) {
        find_motion_on_layer(body, contact, thickness, has_patch(world, identity), footing);
      } else {
        find_own_motion(body, footing);
      }
    }
    stand.load = contact_load(world, region, footing);
    PortVectors forces;
    PortVectors displacements;
    forces_at_ports(footing, stand.load.moments, forces);
    displacements_at_ports(body.ports, footing, forces, displacements);
    for (std::size_t p = 0; p < footing.count; ++p) {
      displacements[p] *= footing.share;
    }
    stand.motion = rigid_motion(footing, displacements);
    if (footing.on_layer != 0) {
      stand.motion = Eigen::Map<const Matrix6>(footing.own.data()) * stand.load.wrench;
    }
    world.regions.at<SupportField>(region) =
        bending(footing, displacements, rigid_motion(footing, displacements));
  }
}

/// The same on a layer, forces and displacements alone: there a contact moves nothing farther away
/// than some thicknesses.
Matrix6 on_layer(const CompliantBody& body, const Matrix6& half_space, const Footing& to,
                 const Footing& from, double thickness) {
  Matrix6 motion = Matrix6::Zero();
  if (has_layer_kernel(body.world, body.row)) {
    const glm::dmat3 layer =
        layer_coupling(body.world, body.row, from.normal, to.center - from.center, thickness);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        motion(row, column) = half_space(row, column) + layer[column][row];
      }
    }
  }
  return motion;
}

/// What a wrench on one region does to another one, half-space included; the same the other way
/// round, transposed.
const RegionCoupling& coupling_between(const CompliantBody& body, const Stand& to,
                                       const Stand& from) {
  const std::size_t row = std::size_t{to.block} * (to.block - 1) / 2 + from.block;
  RegionCoupling& coupling =
      body.world.couplings.at<RegionCoupling>(static_cast<std::uint32_t>(row));
  const Footing& there = footing_of(body, to);
  const Footing& here = footing_of(body, from);
  if (coupling.serial_to != there.serial || coupling.serial_from != here.serial) {
    coupling.serial_to = there.serial;
    coupling.serial_from = here.serial;
    Eigen::Map<Matrix6> motion(coupling.motion.data());
    motion = there.share * here.share * motion_between(body.ports, there, here);
    if (there.center != here.center) {
      motion += half_space_coupling({there.center, there.normal}, {here.center, here.normal},
                                    body.world.bodies.at<Elasticity>(body.row));
    }
    const double thickness = layer_thickness(body.world, body.row, here.normal, here.center);
    if (thickness > 0.0) {
      motion = on_layer(body, motion, there, here, thickness);
    }
  }
  return coupling;
}

/// Gauss' elimination with row pivots, in place: `matrix` x = `right`, x in `right`.
void solve_in_place(Eigen::Map<RowMatrix>& matrix, Eigen::Map<Eigen::VectorXd>& right) {
  const Eigen::Index n = right.size();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    matrix.col(k).tail(n - k).cwiseAbs().maxCoeff(&pivot);
    pivot += k;
    if (pivot != k) {
      matrix.row(k).swap(matrix.row(pivot));
      std::swap(right[k], right[pivot]);
    }
    for (Eigen::Index row = k + 1; row < n; ++row) {
      const double factor = matrix(row, k) / matrix(k, k);
      matrix.row(row).tail(n - k) -= factor * matrix.row(k).tail(n - k);
      right[row] -= factor * right[k];
    }
  }
  for (Eigen::Index k = n; k-- > 0;) {
    right[k] -= matrix.row(k).tail(n - k - 1).dot(right.tail(n - k - 1));
    right[k] /= matrix(k, k);
  }
}

/// The material's motion at `point` as the region's support has it.
Vector6 support_at(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation + glm::cross(support.rotation, point - support.about)),
      eigen(support.rotation);
  return motion;
}

void move_supports(const CompliantBody& body, const Eigen::Map<Eigen::VectorXd>& change) {
  for (std::size_t i = 0; i < body.count; ++i) {
    const glm::dvec3& center = footing_of(body, body.stands[i]).center;
    RegionSupport& support = body.world.regions.at<RegionSupport>(body.stands[i].region);
    const Vector6 before = support_at(support, center);
    const Vector6 step = change.segment<6>(static_cast<Eigen::Index>(6 * i));
    const Vector6 after = before + step;
    support.about = center;
    support.translation = {after[0], after[1], after[2]};
    support.rotation = {after[3], after[4], after[5]};
    support.translation_step = {step[0], step[1], step[2]};
    support.rotation_step = {step[3], step[4], step[5]};
  }
}

/// Newton's matrix I + C K, and how far each region is from where all loads move it.
void fill_equations(const CompliantBody& body, Eigen::Map<RowMatrix>& matrix,
                    Eigen::Map<Eigen::VectorXd>& change) {
  const Elasticity& elasticity = body.world.bodies.at<Elasticity>(body.row);
  for (std::size_t j = 0; j < body.count; ++j) {
    const Stand& from = body.stands[j];
    const Footing& footing = footing_of(body, from);
    const Matrix6 axes = to_contact(footing);
    const Matrix6 stiffness =
        axes.transpose() * contact_stiffness(footing.radius, elasticity).asDiagonal() * axes;
    const auto at = static_cast<Eigen::Index>(6 * j);
    matrix.block<6, 6>(at, at).setIdentity();
    if (footing.on_layer == 0) {
      matrix.block<6, 6>(at, at) += Eigen::Map<const Matrix6>(footing.own.data()) * stiffness;
    }
    change.segment<6>(at) +=
        from.motion - support_at(body.world.regions.at<RegionSupport>(from.region), footing.center);
    for (std::size_t i = 0; i < body.count; ++i) {
      if (i == j) {
        continue;
      }
      const Stand& to = body.stands[i];
      const bool ordered = to.block > from.block;
      const Eigen::Map<const Matrix6> stored(
          (ordered ? coupling_between(body, to, from) : coupling_between(body, from, to))
              .motion.data());
      const Matrix6 motion = ordered ? Matrix6(stored) : Matrix6(stored.transpose());
      const auto there = static_cast<Eigen::Index>(6 * i);
      matrix.block<6, 6>(there, at) = motion * stiffness;
      change.segment<6>(there) += motion * from.load.wrench;
    }
  }
}

void deform_body(StepContext& context, std::uint32_t row) {
  CompliantBody body{context.world, row, ports_of(context.world, row)};
  find_stands(body);
  const auto size = static_cast<Eigen::Index>(6 * body.count);
  Eigen::Map<RowMatrix> matrix(context.scratch.compliance_matrix.data(), size, size);
  Eigen::Map<Eigen::VectorXd> change(context.scratch.compliance_residuals.data(), size);
  change.setZero();
  fill_equations(body, matrix, change);
  solve_in_place(matrix, change);
  move_supports(body, change);
}

/// Adds what forces at a footing's ports do to the anchors, which are the first of the ports.
void move_anchors(const PortCompliance& body, const Footing& footing, const PortVectors& forces,
                  std::span<AnchorMotion> anchors, AnchorTurns& turns) {
  const std::size_t side = 3 * body.ports.size();
  const auto at = [&](std::size_t row, const glm::dvec3& force, std::size_t port) {
    const ComplianceValue* const values = &body.values[row * side + 3 * port];
    return values[0].value * force.x + values[1].value * force.y + values[2].value * force.z;
  };
  for (std::size_t anchor = 0; anchor < anchors.size(); ++anchor) {
    glm::dvec3 turn(0.0);
    for (std::size_t p = 0; p < footing.count; ++p) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t row = 3 * anchor + static_cast<std::size_t>(axis);
        anchors[anchor].displacement[axis] += at(row, forces[p], footing.ports[p]);
        turn[axis] += at(side + row, forces[p], footing.ports[p]);
      }
    }
    turns.turn[anchor] = glm::dot(footing.normal, turn);
  }
}

/// All regions of one body.
void move_anchors_of(World& world, std::uint32_t body) {
  const auto anchors = world.anchors.rows<AnchorMotion>(world.bodies.at<OwnedRows>(body).anchors);
  std::ranges::fill(anchors, AnchorMotion{});
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
    if (identity.body != body) {
      continue;
    }
    const Footing& footing = world.footings.at<Footing>(block_of(identity));
    PortVectors forces;
    forces_at_ports(footing, contact_load(world, region, footing).moments, forces);
    AnchorTurns& turns = world.regions.at<AnchorTurns>(region);
    turns = AnchorTurns{};
    const RegionSupport& support = world.regions.at<RegionSupport>(region);
    turns.support = glm::dot(support.rotation - support.rotation_step,
                             world.regions.at<RegionFrame>(region).normal);
    move_anchors(ports_of(world, body), footing, forces, anchors, turns);
  }
}

}  // namespace

void compliance(StepContext& context) {
  for (std::uint32_t body = 0; body < context.world.bodies.size(); ++body) {
    if (context.world.bodies.at<BodyModels>(body).body == BodyModel::kCompliance) {
      deform_body(context, body);
    }
  }
}

void anchor_motions(StepContext& context) {
  for (std::uint32_t body = 0; body < context.world.bodies.size(); ++body) {
    if (context.world.bodies.at<BodyModels>(body).body == BodyModel::kCompliance) {
      move_anchors_of(context.world, body);
    }
  }
}

}  // namespace torsion
