#include "systems/body_models/region_stands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include "systems/body_models/half_space_fields.hpp"
#include "systems/body_models/layer_motion.hpp"
#include "systems/body_models/smooth_compliance.hpp"
#include "systems/body_models/surface_bend.hpp"
#include "systems/contact_models/curved_influence.hpp"
#include "systems/contact_models/layer_coupling.hpp"
#include "systems/contact_models/layer_thickness.hpp"
#include "systems/contact_models/stuck_stiffness.hpp"
#include "systems/patch_grid.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// The smallest eigenvalue that K^(1/2) C K^(1/2) may have: -1 would leave no compliance at all,
/// and interpolation between ports could bring it below.
constexpr double kStiffest = -0.75;

/// A symmetric compliance over the contact's own: eigenvalues and what makes them a compliance
/// again.
struct RelativeCompliance {
  Eigen::SelfAdjointEigenSolver<Matrix6> solver;
  Matrix6 back;

  RelativeCompliance(const CompliantBody& body, const Stand& stand, const Matrix6& motion) {
    const StiffnessRoot root = stiffness_root(body, stand);
    const Matrix6 scaled = root.root * motion * root.root;
    solver.compute(0.5 * (scaled + scaled.transpose()));
    back = root.inverse * solver.eigenvectors();
  }
  [[nodiscard]] Matrix6 at_least(double least) const {
    return back * solver.eigenvalues().cwiseMax(least).asDiagonal() * back.transpose();
  }
};

/// How a contact model without cells is moved by the body's bend beside its half-space: as one, by
/// forces alone, m/N: the terms and moments of degree 0 of the footing's response, which has no
/// other use there. `patch` has the bend in its own tables (region_influences.hpp).
Eigen::Matrix3d motion_by_bend(const CompliantBody& body, const Stand& stand) {
  Eigen::Matrix3d motion = Eigen::Matrix3d::Zero();
  if (!stand.solved) {
    const FootingResponse& bend = body.world.footings.at<FootingResponse>(stand.block);
    for (Eigen::Index column = 0; column < 3; ++column) {
      for (Eigen::Index row = 0; row < 3; ++row) {
        motion(row, column) = bend.terms[static_cast<std::size_t>(
            (3 * column * kSupportColumn + row) * kSupportColumn)];
      }
    }
  }
  return motion;
}

/// Finds it.
void find_bend(const CompliantBody& body, const Stand& stand, const Footing& footing) {
  FootingResponse& bend = body.world.footings.at<FootingResponse>(stand.block);
  bend = FootingResponse{};
  if (!may_bend(body.world, body.row)) {
    return;
  }
  RegionFrame axes;
  axes.tangent_x = footing.tangent_x;
  axes.tangent_y = footing.tangent_y;
  axes.normal = footing.normal;
  const SurfaceBend found = find_surface_bend(body.world, body.row, footing, axes, footing.radius);
  if (found.reach == 0.0) {
    return;
  }
  const Elasticity& elasticity = body.world.bodies.at<Elasticity>(body.row);
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
  motion = (turn * motion * turn.transpose()).eval();
  for (Eigen::Index column = 0; column < 3; ++column) {
    for (Eigen::Index row = 0; row < 3; ++row) {
      bend.terms[static_cast<std::size_t>((3 * column * kSupportColumn + row) * kSupportColumn)] =
          motion(row, column);
    }
  }
}

/// What a region's own wrench does to it: the part that yields goes to Newton's matrix. Where the
/// rest of the body stiffens the half-space (a layer) Newton's method would overshoot as soon as
/// the contact slips, and plain iteration converges.
void find_own_motion(const CompliantBody& body, const Stand& stand, Footing& footing) {
  if (!stand.solved) {
    find_bend(body, stand, footing);
  }
  Matrix6 motion = motion_between(body.ports, footing, footing);
  motion.topLeftCorner<3, 3>() += motion_by_bend(body, stand);
  const RelativeCompliance relative(body, stand, motion);
  const double least = relative.solver.eigenvalues()[0];
  footing.share = std::min(1.0, kStiffest / std::min(least, -1e-300));
  footing.on_layer = 0;
  Eigen::Map<Matrix6>(footing.own.data()) = relative.at_least(0.0);
}

/// On a layer the ports do not count: patch has what the half-space lacks in its own tables
/// (layer_kernel.hpp), mdr is moved as one.
void find_motion_on_layer(const CompliantBody& body, const Stand& stand,
                          const ContactEllipse& contact, double thickness, bool has_tables,
                          Footing& footing) {
  footing.share = 0.0;
  footing.on_layer = 1;
  footing.own = {};
  if (!has_tables && has_layer_kernel(body.world, body.row)) {
    const Matrix6 motion = layer_motion(body.world, body.row, contact, thickness);
    Eigen::Map<Matrix6>(footing.own.data()) =
        RelativeCompliance(body, stand, motion).at_least(kStiffest);
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

/// Row of the coupling between two blocks' regions.
std::uint32_t coupling_row(std::uint32_t one, std::uint32_t other) {
  const std::uint32_t high = std::max(one, other);
  return high * (high - 1) / 2 + std::min(one, other);
}

/// A new region knows nothing of what the last one with its footing did to others.
void forget_couplings(World& world, std::uint32_t block) {
  for (std::uint32_t other = 0; other < world.footings.size(); ++other) {
    if (other != block) {
      world.couplings.at<RegionCoupling>(coupling_row(block, other)) = RegionCoupling{};
    }
  }
}

void lay(const CompliantBody& body, const Stand& stand, const ContactEllipse& contact) {
  World& world = body.world;
  Footing& footing = footing_of(body, stand);
  lay_footing(body.ports, contact, footing);
  footing.serial = world.clock.at<Clock>(0).step * world.footings.size() + stand.block + 1;
  const double thickness = layer_thickness(world, body.row, contact.normal, contact.center);
  if (thickness > 0.0) {
    const RegionIdentity& identity = world.regions.at<RegionIdentity>(stand.region);
    find_motion_on_layer(body, stand, contact, thickness, has_patch(world, identity), footing);
  } else {
    find_own_motion(body, stand, footing);
  }
}

void lay_footings(const CompliantBody& body) {
  const Stand* first_laid = nullptr;
  ContactEllipse contact_of_first;
  for (std::size_t i = 0; i < body.count; ++i) {
    const Stand& stand = body.stands[i];
    const Footing& footing = footing_of(body, stand);
    const ContactEllipse contact = contact_ellipse(body.world, stand.region);
    if (footing.reach == 0.0) {
      forget_couplings(body.world, stand.block);
      lay(body, stand, contact);
    } else if (!still_fits(footing, contact) &&
               (first_laid == nullptr || footing.serial < footing_of(body, *first_laid).serial)) {
      first_laid = &stand;
      contact_of_first = contact;
    }
  }
  if (first_laid != nullptr) {
    lay(body, *first_laid, contact_of_first);
  }
}

/// The region's own motion and bending by its own load.
void move_by_own_load(const CompliantBody& body, Stand& stand) {
  const Footing& footing = footing_of(body, stand);
  SupportField& field = body.world.regions.at<SupportField>(stand.region);
  stand.load = contact_load(body.world, stand.region, footing);
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
  stand.motion.head<3>() += motion_by_bend(body, stand) * stand.load.wrench.head<3>();
}

bool is_found(const RegionCoupling& coupling, const Footing& to, const Footing& from) {
  return coupling.serial_to == to.serial && coupling.serial_from == from.serial;
}

/// Where the one is seen from the other. Point loads in each other's place would move each other
/// without bound, and regions that part or meet may have their middles anywhere: mdr's are discs,
/// so they lie as far apart as their rims at least. Those of patch are what their cells are, and
/// the middle of one may lie within the disc of another: as far as the larger one's rim at least,
/// where two regions do less to each other than each does to itself. With q = (1 - nu^2) / (pi E)
/// point loads at distance d sink by q / d, discs by (pi / 2) q / a.
glm::dvec3 apart(const Footing& there, const Footing& here, ContactModel model) {
  const glm::dvec3 way = there.center - here.center;
  const double distance = glm::length(way);
  const double least = model == ContactModel::kPatch ? std::max(there.radius, here.radius)
                                                     : there.radius + here.radius;
  return distance < least ? here.center + way * (least / distance) : there.center;
}

/// What a wrench on `here` does to `there`.
Matrix6 motion_of(const CompliantBody& body, const Footing& there, const Footing& here) {
  Matrix6 motion = there.share * here.share * motion_between(body.ports, there, here);
  if (there.center != here.center) {
    const ContactModel model = body.world.bodies.at<BodyModels>(body.row).contact;
    motion +=
        half_space_coupling({apart(there, here, model), there.normal}, {here.center, here.normal},
                            body.world.bodies.at<Elasticity>(body.row));
  }
  const double thickness = layer_thickness(body.world, body.row, here.normal, here.center);
  if (thickness > 0.0) {
    motion = on_layer(body, motion, there, here, thickness);
  }
  return motion;
}

void find_coupling(const CompliantBody& body, const Footing& there, const Footing& here,
                   RegionCoupling& coupling) {
  coupling.serial_to = there.serial;
  coupling.serial_from = here.serial;
  Eigen::Map<Matrix6>(coupling.motion.data()) = motion_of(body, there, here);
}

/// @param found_before  take those that were, or those that never were
/// @return how many more may be found
std::size_t find_some_couplings(const CompliantBody& body, bool found_before, std::size_t most) {
  for (std::size_t i = 0; i < body.count; ++i) {
    for (std::size_t j = 0; j < i && most > 0; ++j) {
      const bool ordered = body.stands[i].block > body.stands[j].block;
      const Stand& to = body.stands[ordered ? i : j];
      const Stand& from = body.stands[ordered ? j : i];
      RegionCoupling& coupling = coupling_between(body, to, from);
      const Footing& there = footing_of(body, to);
      const Footing& here = footing_of(body, from);
      if ((coupling.serial_to != 0) == found_before && !is_found(coupling, there, here)) {
        find_coupling(body, there, here, coupling);
        --most;
      }
    }
  }
  return most;
}

/// What a wrench on one of two regions that were one does to the other.
struct ToEachOther {
  Matrix6 motion;
  Matrix6 known;  // of that, what it did as the one region's own load
};

ToEachOther to_each_other(const CompliantBody& body, const Footing& there, const Footing& here) {
  ToEachOther both{motion_of(body, there, here), Matrix6::Zero()};
  if (here.on_layer == 0) {
    both.known = there.share * here.share * motion_between(body.ports, there, here);
  }
  return both;
}

Stand solved_stand(const World& world, std::uint32_t region) {
  Stand stand;
  stand.region = region;
  stand.block = block_of(world.regions.at<RegionIdentity>(region));
  stand.solved = true;
  return stand;
}

/// A disc as large as the grid around a new region's contact points.
ContactEllipse disc_of_grid(const RegionFrame& frame) {
  const double radius = std::sqrt(frame.half_size.x * frame.half_size.y);
  return {frame.origin, radius * frame.tangent_x, radius * frame.tangent_y, frame.normal, radius};
}

/// Of a region's load a part has become another region's.
/// @param motion  what it moves here, 6 x 6
/// @param known   of that, what it has moved before
/// @param place   m, body: of the motion
void move_by_part(const Matrix6& motion, const Matrix6& known, const Vector6& load,
                  const glm::dvec3& place, RegionSupport& support) {
  const Vector6 by_others = motion * load;
  const Vector6 more = by_others - known * load;
  const glm::dvec3 rotation(by_others[3], by_others[4], by_others[5]);
  const glm::dvec3 more_rotation(more[3], more[4], more[5]);
  const glm::dvec3 arm = support.about - place;
  support.translation += glm::dvec3(more[0], more[1], more[2]) + glm::cross(more_rotation, arm);
  support.rotation += more_rotation;
  support.translation_by_others +=
      glm::dvec3(by_others[0], by_others[1], by_others[2]) + glm::cross(rotation, arm);
  support.rotation_by_others += rotation;
}

}  // namespace

Footing& footing_of(const CompliantBody& body, const Stand& stand) {
  return body.world.footings.at<Footing>(stand.block);
}

StiffnessRoot stiffness_root(const CompliantBody& body, const Stand& stand) {
  const RegionFrame& frame = body.world.regions.at<RegionFrame>(stand.region);
  const StuckStiffness stuck =
      stuck_stiffness(body.world, stand.region, footing_of(body, stand).radius);
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

void find_stands(CompliantBody& body) {
  World& world = body.world;
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
    if (identity.body == body.row) {
      Stand& stand = body.stands[body.count++];
      stand.region = region;
      stand.block = block_of(identity);
      stand.solved = has_patch(world, identity);
    }
  }
  lay_footings(body);
  for (std::size_t i = 0; i < body.count; ++i) {
    move_by_own_load(body, body.stands[i]);
  }
}

void begin_support(World& world, std::uint32_t region) {
  const std::uint32_t row = world.regions.at<RegionIdentity>(region).body;
  RegionSupport& support = world.regions.at<RegionSupport>(region);
  support = RegionSupport{};
  if (world.bodies.at<BodyModels>(row).body != BodyModel::kCompliance) {
    return;
  }
  const CompliantBody body{world, row, ports_of(world, row)};
  Footing there;
  Vector6 motion = Vector6::Zero();
  for (std::uint32_t other = 0; other < world.regions.size(); ++other) {
    const RegionIdentity& identity = world.regions.at<RegionIdentity>(other);
    const Footing& here = world.footings.at<Footing>(block_of(identity));
    if (identity.body != row || other == region || here.reach == 0.0) {
      continue;
    }
    if (there.reach == 0.0) {
      lay_footing(body.ports, disc_of_grid(world.regions.at<RegionFrame>(region)), there);
      there.share = 1.0;
    }
    motion += motion_of(body, there, here) * contact_load(world, other, here).wrench;
  }
  support.about = world.regions.at<RegionFrame>(region).origin;
  support.translation = {motion[0], motion[1], motion[2]};
  support.rotation = {motion[3], motion[4], motion[5]};
  support.translation_by_others = support.translation;
  support.rotation_by_others = support.rotation;
}

void begin_split_support(World& world, std::uint32_t from, std::uint32_t region) {
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(from);
  RegionSupport& old = world.regions.at<RegionSupport>(from);
  RegionSupport& fresh = world.regions.at<RegionSupport>(region);
  fresh = old;
  if (has_patch(world, identity) ||
      world.bodies.at<BodyModels>(identity.body).body != BodyModel::kCompliance) {
    return;
  }
  const Footing& here = world.footings.at<Footing>(block_of(identity));
  if (here.reach == 0.0) {
    return;
  }
  const CompliantBody body{world, identity.body, ports_of(world, identity.body)};
  Footing there;
  lay_footing(body.ports, disc_of_grid(world.regions.at<RegionFrame>(region)), there);
  there.share = here.share;
  const ToEachOther both = to_each_other(body, there, here);
  const double relative = there.radius / here.radius;
  const double share = std::min(relative * relative, 0.5);
  Vector6 taken = Vector6::Zero();
  const Vector6 load = contact_load(world, from, here).wrench;
  taken.head<3>() = share * load.head<3>();
  Vector6 left = load - taken;
  const glm::dvec3 arm = there.center - here.center;
  left.tail<3>() -= eigen(arm).cross(Eigen::Vector3d(taken.head<3>()));
  move_by_part(both.motion, both.known, left, there.center, fresh);
  move_by_part(both.motion.transpose(), both.known.transpose(), taken, here.center, old);
}

void split_support(World& world, std::uint32_t from, std::uint32_t region) {
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(from);
  if (world.bodies.at<BodyModels>(identity.body).body != BodyModel::kCompliance) {
    return;
  }
  const Footing& here = world.footings.at<Footing>(block_of(identity));
  if (here.reach == 0.0) {
    return;
  }
  const CompliantBody body{world, identity.body, ports_of(world, identity.body)};
  const Stand stand = solved_stand(world, region);
  forget_couplings(world, stand.block);
  lay(body, stand, contact_ellipse(world, region));
  const Footing& there = footing_of(body, stand);
  const ToEachOther both = to_each_other(body, there, here);
  RegionSupport& old = world.regions.at<RegionSupport>(from);
  RegionSupport& fresh = world.regions.at<RegionSupport>(region);
  fresh = old;
  move_by_part(both.motion, both.known, contact_load(world, from, here).wrench, there.center,
               fresh);
  move_by_part(both.motion.transpose(), both.known.transpose(),
               contact_load(world, region, there).wrench, here.center, old);
  RegionReaction& reaction = world.regions.at<RegionReaction>(from);
  if (reaction.active != 0) {
    // They have answered to the whole load, and it is still there.
    Eigen::Map<Vector6>(reaction.wrench.data()) -= contact_load(world, region, here).wrench;
  }
}

void join_support(World& world, std::uint32_t ended, std::uint32_t heir) {
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(heir);
  if (world.bodies.at<BodyModels>(identity.body).body != BodyModel::kCompliance) {
    return;
  }
  const Footing& here = world.footings.at<Footing>(block_of(identity));
  const Footing& there =
      world.footings.at<Footing>(block_of(world.regions.at<RegionIdentity>(ended)));
  if (here.reach == 0.0 || there.reach == 0.0) {
    return;
  }
  const CompliantBody body{world, identity.body, ports_of(world, identity.body)};
  const ToEachOther both = to_each_other(body, here, there);
  RegionSupport& support = world.regions.at<RegionSupport>(heir);
  move_by_part(both.motion, both.known, -contact_load(world, ended, there).wrench, here.center,
               support);
  world.regions.at<RegionReaction>(heir) = RegionReaction{};
}

void find_couplings(const CompliantBody& body) {
  find_some_couplings(body, true, find_some_couplings(body, false, kCouplingsAStep));
}

RegionCoupling& coupling_between(const CompliantBody& body, const Stand& to, const Stand& from) {
  return body.world.couplings.at<RegionCoupling>(coupling_row(to.block, from.block));
}

}  // namespace torsion
