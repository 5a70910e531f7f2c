#include "systems/body/compliance/supported_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/contact/law.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/stick_slip.hpp"
#include "systems/contact/support/support_fit.hpp"
#include "systems/half_space/curved_influence.hpp"
#include "systems/half_space/fields.hpp"
#include "systems/half_space/layer.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
namespace {

/// The smallest allowed eigenvalue of K^(1/2) C K^(1/2). At -1 no compliance would be left;
/// interpolation between ports could go below that.
constexpr double kStiffestContact = -0.75;

/// A symmetric compliance over the contact's own: its eigenvalues, and the factors that make it a
/// compliance again.
struct RelativeCompliance {
  EigenSystem6 system;
  Matrix6 back;

  RelativeCompliance(const CompliantBody& body, const SupportedRegion& supported,
                     const Matrix6& motion) {
    const StiffnessRoot root = stiffness_root(body, supported);
    const Matrix6 scaled = root.root * motion * root.root;
    system = eigen_system(0.5 * (scaled + scaled.transpose()));
    back = root.inverse * system.vectors;
  }
  [[nodiscard]] Matrix6 at_least(double least) const {
    return back * system.values.cwiseMax(least).asDiagonal() * back.transpose();
  }
};

/// SupportFit::bend.
Eigen::Matrix3d motion_by_bend(const CompliantBody& body, const SupportFit& support_fit) {
  if (!may_bend(body.model, body.row)) {
    return Eigen::Matrix3d::Zero();
  }
  RegionFrame axes;
  axes.tangent_x = support_fit.tangent_x;
  axes.tangent_y = support_fit.tangent_y;
  axes.normal = support_fit.normal;
  const SurfaceBend found =
      find_surface_bend(body.model, body.row, support_fit, axes, support_fit.radius);
  if (found.reach == 0.0) {
    return Eigen::Matrix3d::Zero();
  }
  const Elasticity& elasticity = body.model.bodies.at<Elasticity>(body.row);
  const CurvedResponse response = curved_response(found.curvature, elasticity.poisson_ratio);
  std::array<double, kCurvedKinds> mean{};  // kZZ, kXX, kXY, kYY
  for (std::size_t kind = 0; kind < kCurvedKinds; ++kind) {
    mean[kind] = curved_mean(response[kind], support_fit.radius, found.reach) /
                 (8.0 * std::numbers::pi * elasticity.shear_modulus());
  }
  Eigen::Matrix3d turn;
  turn << eigen(axes.tangent_x), eigen(axes.tangent_y), eigen(axes.normal);
  Eigen::Matrix3d motion;
  motion << mean[1], mean[2], 0.0, mean[2], mean[3], 0.0, 0.0, 0.0, mean[0];
  return turn * motion * turn.transpose();
}

/// Motion of a region by its own wrench. The part that adds compliance goes to Newton's matrix.
/// Where the rest of the body stiffens the half-space (a layer), Newton's method would overshoot as
/// soon as the contact slips, and plain iteration converges.
void find_own_motion(const CompliantBody& body, const SupportedRegion& supported,
                     SupportFit& support_fit) {
  Matrix6 motion = motion_between(body.ports, support_fit, support_fit);
  Eigen::Map<Eigen::Matrix3d> bend(support_fit.bend.data());
  bend = supported.solved ? Eigen::Matrix3d(Eigen::Matrix3d::Zero())
                          : motion_by_bend(body, support_fit);
  motion.topLeftCorner<3, 3>() += bend;
  const RelativeCompliance relative(body, supported, motion);
  const double least = relative.system.values[0];
  support_fit.share = std::min(1.0, kStiffestContact / std::min(least, -1e-300));
  support_fit.on_layer = 0;
  Eigen::Map<Matrix6>(support_fit.own.data()) = relative.at_least(0.0);
}

/// On a layer the ports are not used: patch's own tables contain the difference from the half-space
/// (half_space/layer.hpp), mdr is moved as a whole.
void find_motion_on_layer(const CompliantBody& body, const SupportedRegion& supported,
                          const ContactEllipse& contact, double thickness,
                          SupportFit& support_fit) {
  support_fit.share = 0.0;
  support_fit.on_layer = 1;
  support_fit.own = {};
  if (!law_of(body.model, body.row).by_cells && !layer_kernel(body.model, body.row).empty()) {
    const Matrix6 motion = layer_motion(body.model, body.row, contact, thickness);
    Eigen::Map<Matrix6>(support_fit.own.data()) =
        RelativeCompliance(body, supported, motion).at_least(kStiffestContact);
  }
}

void fit_supports(const CompliantBody& body) {
  const SupportedRegion* first_laid = nullptr;
  ContactEllipse contact_of_first;
  for (std::size_t i = 0; i < body.count; ++i) {
    const SupportedRegion& supported = body.regions[i];
    const SupportFit& support_fit = support_fit_of(body, supported);
    const ContactEllipse contact = contact_ellipse(body.model, body.state, supported.region);
    if (support_fit.reach == 0.0 || (support_fit.serial & kForFirstStep) != 0) {
      forget_couplings(body.state, supported.block);
      fit_region_support(body, supported, contact);
    } else if (!still_fits(support_fit, contact) &&
               (first_laid == nullptr ||
                support_fit.serial < support_fit_of(body, *first_laid).serial)) {
      first_laid = &supported;
      contact_of_first = contact;
    }
  }
  if (first_laid != nullptr) {
    fit_region_support(body, *first_laid, contact_of_first);
  }
}

/// The region's own motion and bending by its own load.
void move_by_own_load(const CompliantBody& body, SupportedRegion& supported) {
  const SupportFit& support_fit = support_fit_of(body, supported);
  SupportField& field = body.state.regions.at<SupportField>(supported.region);
  supported.load = contact_load(body.model, body.state, supported.region, support_fit);
  if (support_fit.on_layer != 0) {
    supported.motion = Eigen::Map<const Matrix6>(support_fit.own.data()) * supported.load.wrench;
    field = SupportField{};
    return;
  }
  PortVectors forces;
  PortVectors displacements;
  forces_at_ports(support_fit, supported.load.moments, forces);
  displacements_at_ports(body.ports, support_fit, forces, displacements);
  for (std::size_t p = 0; p < support_fit.count; ++p) {
    displacements[p] *= support_fit.share;
  }
  supported.motion = rigid_motion(support_fit, displacements);
  field = bending(support_fit, displacements, supported.motion);
  supported.motion.head<3>() +=
      Eigen::Map<const Eigen::Matrix3d>(support_fit.bend.data()) * supported.load.wrench.head<3>();
}

}  // namespace

SupportFit& support_fit_of(const CompliantBody& body, const SupportedRegion& supported) {
  return body.state.support_fits.at<SupportFit>(supported.block);
}

SupportedRegion supported_region(const Model& model, const State& state, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  SupportedRegion supported;
  supported.region = region;
  supported.block = block_of(identity);
  supported.solved = law_of(model, identity.body).by_cells;
  return supported;
}

StiffnessRoot stiffness_root(const CompliantBody& body, const SupportedRegion& supported) {
  const RegionFrame& frame = body.state.regions.at<RegionFrame>(supported.region);
  const StuckStiffness stuck = stuck_stiffness(body.model, body.state, supported.region,
                                               support_fit_of(body, supported).radius);
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
          axes.transpose() * root.cwiseInverse().asDiagonal() * axes, root, axes};
}

void fit_region_support(const CompliantBody& body, const SupportedRegion& supported,
                        const ContactEllipse& contact) {
  const Model& model = body.model;
  State& state = body.state;
  SupportFit& support_fit = support_fit_of(body, supported);
  fit_support(body.ports, contact, support_fit);
  support_fit.serial = state.clock.step * state.support_fits.size() + supported.block + 1;
  const double thickness = layer_thickness(model, body.row, contact.normal, contact.center);
  if (thickness > 0.0) {
    find_motion_on_layer(body, supported, contact, thickness, support_fit);
  } else {
    find_own_motion(body, supported, support_fit);
  }
}

void find_supported_regions(CompliantBody& body) {
  const Model& model = body.model;
  State& state = body.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    if (identity.body == body.row) {
      body.regions[body.count++] = supported_region(model, state, region);
    }
  }
  fit_supports(body);
  for (std::size_t i = 0; i < body.count; ++i) {
    move_by_own_load(body, body.regions[i]);
  }
}

namespace {

/// The same on a layer, for forces and displacements alone: there a contact moves nothing that is
/// farther away than a few thicknesses.
Matrix6 on_layer(const CompliantBody& body, const Matrix6& half_space, const SupportFit& to,
                 const SupportFit& from, double thickness) {
  Matrix6 motion = Matrix6::Zero();
  if (!layer_kernel(body.model, body.row).empty()) {
    const glm::dmat3 layer =
        layer_coupling(body.model, body.row, from.normal, to.center - from.center, thickness);
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

bool is_found(const RegionCoupling& coupling, const SupportFit& to, const SupportFit& from) {
  return coupling.serial_to == to.serial && coupling.serial_from == from.serial;
}

/// The place of one region relative to the other. Point loads at the same place would move each
/// other without bound, and the middles of regions that part or meet may be anywhere. Regions of
/// mdr are discs, so they are at least as far apart as their rims. Those of patch have the shape of
/// their cells, and the middle of one may lie within the disc of the other: they are at least as
/// far apart as the larger one's rim, where two regions move each other less than each moves
/// itself. With q = (1 - nu^2) / (pi E), point loads at distance d sink by q / d, discs by (pi / 2)
/// q / a.
glm::dvec3 apart(const SupportFit& there, const SupportFit& here, bool by_cells) {
  const glm::dvec3 way = there.center - here.center;
  const double distance = glm::length(way);
  const double least = by_cells ? std::max(there.radius, here.radius) : there.radius + here.radius;
  return distance < least ? here.center + way * (least / distance) : there.center;
}

void find_coupling(const CompliantBody& body, const SupportFit& there, const SupportFit& here,
                   RegionCoupling& coupling) {
  coupling.serial_to = there.serial;
  coupling.serial_from = here.serial;
  Eigen::Map<Matrix6>(coupling.motion.data()) = motion_of(body, there, here);
}

/// @param found_before  true: those that were found before; false: those that never were
/// @return how many more may be found
std::size_t find_some_couplings(const CompliantBody& body, bool found_before, std::size_t most) {
  for (std::size_t i = 0; i < body.count; ++i) {
    for (std::size_t j = 0; j < i && most > 0; ++j) {
      const bool ordered = body.regions[i].block > body.regions[j].block;
      const SupportedRegion& to = body.regions[ordered ? i : j];
      const SupportedRegion& from = body.regions[ordered ? j : i];
      RegionCoupling& coupling = coupling_between(body, to, from);
      const SupportFit& there = support_fit_of(body, to);
      const SupportFit& here = support_fit_of(body, from);
      if ((coupling.serial_to != 0) == found_before && !is_found(coupling, there, here)) {
        find_coupling(body, there, here, coupling);
        --most;
      }
    }
  }
  return most;
}

}  // namespace

void forget_couplings(State& state, std::uint32_t block) {
  for (std::uint32_t other = 0; other < state.support_fits.size(); ++other) {
    if (other != block) {
      state.couplings.at<RegionCoupling>(coupling_row(block, other)) = RegionCoupling{};
    }
  }
}

Matrix6 motion_of(const CompliantBody& body, const SupportFit& there, const SupportFit& here) {
  Matrix6 motion = there.share * here.share * motion_between(body.ports, there, here);
  if (there.center != here.center) {
    const bool by_cells = law_of(body.model, body.row).by_cells;
    motion +=
        half_space_coupling({apart(there, here, by_cells), there.normal},
                            {here.center, here.normal}, body.model.bodies.at<Elasticity>(body.row));
  }
  const double thickness = layer_thickness(body.model, body.row, here.normal, here.center);
  if (thickness > 0.0) {
    motion = on_layer(body, motion, there, here, thickness);
  }
  return motion;
}

void find_couplings(const CompliantBody& body) {
  find_some_couplings(body, true, find_some_couplings(body, false, kCouplingsAStep));
}

RegionCoupling& coupling_between(const CompliantBody& body, const SupportedRegion& to,
                                 const SupportedRegion& from) {
  return body.state.couplings.at<RegionCoupling>(coupling_row(to.block, from.block));
}

namespace {

std::array<DiscForces, 6> unit_wrenches(const ContactEllipse& contact, double DiscPoint::*shares) {
  std::array<DiscForces, 6> forces;
  for (std::size_t c = 0; c < 6; ++c) {
    glm::dvec3 force(0.0);
    glm::dvec3 couple(0.0);
    (c < 3 ? force : couple)[static_cast<int>(c % 3)] = 1.0;
    forces[c] = spread_wrench(contact, shares, force, couple);
  }
  return forces;
}

}  // namespace

Matrix6 layer_motion(const Model& model, std::uint32_t body, const ContactEllipse& contact,
                     double thickness) {
  const std::array<DiscForces, 6> loads = unit_wrenches(contact, &DiscPoint::ball_share);
  const std::array<DiscForces, 6> means = unit_wrenches(contact, &DiscPoint::disc_share);
  Matrix6 motion = Matrix6::Zero();
  for (std::size_t to = 0; to < kDiscPoints; ++to) {
    std::array<glm::dvec3, 6> moved{};
    for (std::size_t from = 0; from < kDiscPoints; ++from) {
      const glm::dvec2 away = disc_points()[to].place - disc_points()[from].place;
      const glm::dmat3 response =
          layer_coupling(model, body, contact.normal,
                         contact.axis_1 * away.x + contact.axis_2 * away.y, thickness);
      for (std::size_t c = 0; c < 6; ++c) {
        moved[c] += response * loads[c][from];
      }
    }
    for (std::size_t row = 0; row < 6; ++row) {
      for (std::size_t c = 0; c < 6; ++c) {
        motion(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(c)) +=
            glm::dot(means[row][to], moved[c]);
      }
    }
  }
  return motion;
}

}  // namespace torsion::engine
