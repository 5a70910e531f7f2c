#include "systems/body/compliance/region_stands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/body/compliance/layer_motion.hpp"
#include "systems/body/compliance/region_couplings.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/stuck_stiffness.hpp"
#include "systems/contact/support/surface_bend.hpp"
#include "systems/half_space/curved_influence.hpp"
#include "systems/half_space/layer_coupling.hpp"
#include "systems/half_space/layer_thickness.hpp"
#include "systems/math/matrix6.hpp"

namespace torsion {
namespace {

/// The smallest eigenvalue that K^(1/2) C K^(1/2) may have: -1 would leave no compliance at all,
/// and interpolation between ports could bring it below.
constexpr double kStiffest = -0.75;

/// A symmetric compliance over the contact's own: eigenvalues and what makes them a compliance
/// again.
struct RelativeCompliance {
  EigenSystem6 system;
  Matrix6 back;

  RelativeCompliance(const CompliantBody& body, const Stand& stand, const Matrix6& motion) {
    const StiffnessRoot root = stiffness_root(body, stand);
    const Matrix6 scaled = root.root * motion * root.root;
    system = eigen_system(0.5 * (scaled + scaled.transpose()));
    back = root.inverse * system.vectors;
  }
  [[nodiscard]] Matrix6 at_least(double least) const {
    return back * system.values.cwiseMax(least).asDiagonal() * back.transpose();
  }
};

/// Footing::bend.
Eigen::Matrix3d motion_by_bend(const CompliantBody& body, const Footing& footing) {
  if (!may_bend(body.model, body.row)) {
    return Eigen::Matrix3d::Zero();
  }
  RegionFrame axes;
  axes.tangent_x = footing.tangent_x;
  axes.tangent_y = footing.tangent_y;
  axes.normal = footing.normal;
  const SurfaceBend found = find_surface_bend(body.model, body.row, footing, axes, footing.radius);
  if (found.reach == 0.0) {
    return Eigen::Matrix3d::Zero();
  }
  const Elasticity& elasticity = body.model.bodies.at<Elasticity>(body.row);
  const CurvedResponse response = curved_response(found.curvature, elasticity.poisson_ratio);
  std::array<double, kCurvedKinds> mean{};  // kZZ, kXX, kXY, kYY
  for (std::size_t kind = 0; kind < kCurvedKinds; ++kind) {
    mean[kind] = curved_mean(response[kind], footing.radius, found.reach) /
                 (8.0 * std::numbers::pi * elasticity.shear_modulus());
  }
  Eigen::Matrix3d turn;
  turn << eigen(axes.tangent_x), eigen(axes.tangent_y), eigen(axes.normal);
  Eigen::Matrix3d motion;
  motion << mean[1], mean[2], 0.0, mean[2], mean[3], 0.0, 0.0, 0.0, mean[0];
  return turn * motion * turn.transpose();
}

/// What a region's own wrench does to it: the part that yields goes to Newton's matrix. Where the
/// rest of the body stiffens the half-space (a layer) Newton's method would overshoot as soon as
/// the contact slips, and plain iteration converges.
void find_own_motion(const CompliantBody& body, const Stand& stand, Footing& footing) {
  Matrix6 motion = motion_between(body.ports, footing, footing);
  Eigen::Map<Eigen::Matrix3d> bend(footing.bend.data());
  bend = stand.solved ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : motion_by_bend(body, footing);
  motion.topLeftCorner<3, 3>() += bend;
  const RelativeCompliance relative(body, stand, motion);
  const double least = relative.system.values[0];
  footing.share = std::min(1.0, kStiffest / std::min(least, -1e-300));
  footing.on_layer = 0;
  Eigen::Map<Matrix6>(footing.own.data()) = relative.at_least(0.0);
}

/// On a layer the ports do not count: patch has what the half-space lacks in its own tables
/// (layer_kernel.hpp), mdr is moved as one.
void find_motion_on_layer(const CompliantBody& body, const Stand& stand,
                          const ContactEllipse& contact, double thickness, Footing& footing) {
  footing.share = 0.0;
  footing.on_layer = 1;
  footing.own = {};
  if (!law_of(body.model, body.row).by_cells && has_layer_kernel(body.model, body.row)) {
    const Matrix6 motion = layer_motion(body.model, body.row, contact, thickness);
    Eigen::Map<Matrix6>(footing.own.data()) =
        RelativeCompliance(body, stand, motion).at_least(kStiffest);
  }
}

void lay_footings(const CompliantBody& body) {
  const Stand* first_laid = nullptr;
  ContactEllipse contact_of_first;
  for (std::size_t i = 0; i < body.count; ++i) {
    const Stand& stand = body.stands[i];
    const Footing& footing = footing_of(body, stand);
    const ContactEllipse contact = contact_ellipse(body.model, body.state, stand.region);
    if (footing.reach == 0.0) {
      forget_couplings(body.state, stand.block);
      lay_stand(body, stand, contact);
    } else if (!still_fits(footing, contact) &&
               (first_laid == nullptr || footing.serial < footing_of(body, *first_laid).serial)) {
      first_laid = &stand;
      contact_of_first = contact;
    }
  }
  if (first_laid != nullptr) {
    lay_stand(body, *first_laid, contact_of_first);
  }
}

/// The region's own motion and bending by its own load.
void move_by_own_load(const CompliantBody& body, Stand& stand) {
  const Footing& footing = footing_of(body, stand);
  SupportField& field = body.state.regions.at<SupportField>(stand.region);
  stand.load = contact_load(body.model, body.state, stand.region, footing);
  if (footing.on_layer != 0) {
    stand.motion = Eigen::Map<const Matrix6>(footing.own.data()) * stand.load.wrench;
    field = SupportField{};
    return;
  }
  PortVectors forces;
  PortVectors displacements;
  forces_at_ports(footing, stand.load.moments, forces);
  displacements_at_ports(body.ports, footing, forces, displacements);
  for (std::size_t p = 0; p < footing.count; ++p) {
    displacements[p] *= footing.share;
  }
  stand.motion = rigid_motion(footing, displacements);
  field = bending(footing, displacements, stand.motion);
  stand.motion.head<3>() +=
      Eigen::Map<const Eigen::Matrix3d>(footing.bend.data()) * stand.load.wrench.head<3>();
}

}  // namespace

Footing& footing_of(const CompliantBody& body, const Stand& stand) {
  return body.state.footings.at<Footing>(stand.block);
}

StiffnessRoot stiffness_root(const CompliantBody& body, const Stand& stand) {
  const RegionFrame& frame = body.state.regions.at<RegionFrame>(stand.region);
  const StuckStiffness stuck =
      stuck_stiffness(body.model, body.state, stand.region, footing_of(body, stand).radius);
  Vector6 root;
  root << stuck.along_tangents, stuck.along_tangents, stuck.along_normal, stuck.about_tangents.x,
      stuck.about_tangents.y, stuck.about_normal;
  root = root.cwiseSqrt().eval();
  Eigen::Matrix3d rotation;
  rotation << eigen(frame.tangent_x).transpose(), eigen(frame.tangent_y).transpose(),
      eigen(frame.normal).transpose();
  Matrix6 axes = Matrix6::Zero();
  axes.topLeftCorner<3, 3>() = rotation;
  axes.bottomRightCorner<3, 3>() = rotation;
  return {axes.transpose() * root.asDiagonal() * axes,
          axes.transpose() * root.cwiseInverse().asDiagonal() * axes};
}

void lay_stand(const CompliantBody& body, const Stand& stand, const ContactEllipse& contact) {
  const Model& model = body.model;
  State& state = body.state;
  Footing& footing = footing_of(body, stand);
  lay_footing(body.ports, contact, footing);
  footing.serial = state.clock.step * state.footings.size() + stand.block + 1;
  const double thickness = layer_thickness(model, body.row, contact.normal, contact.center);
  if (thickness > 0.0) {
    find_motion_on_layer(body, stand, contact, thickness, footing);
  } else {
    find_own_motion(body, stand, footing);
  }
}

void find_stands(CompliantBody& body) {
  const Model& model = body.model;
  State& state = body.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    if (identity.body == body.row) {
      Stand& stand = body.stands[body.count++];
      stand.region = region;
      stand.block = block_of(identity);
      stand.solved = law_of(model, body.row).by_cells;
    }
  }
  lay_footings(body);
  for (std::size_t i = 0; i < body.count; ++i) {
    move_by_own_load(body, body.stands[i]);
  }
}

}  // namespace torsion
