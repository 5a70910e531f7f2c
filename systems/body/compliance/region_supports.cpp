#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/body/compliance/supported_regions.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

/// Motion of each of two regions that were one by a wrench on the other.
struct ToEachOther {
  Matrix6 motion;
  Matrix6 known;  // of that, what it did as the one region's own load
};

ToEachOther to_each_other(const CompliantBody& body, const SupportFit& there,
                          const SupportFit& here) {
  ToEachOther both{motion_of(body, there, here), Matrix6::Zero()};
  if (here.on_layer == 0) {
    both.known = there.share * here.share * motion_between(body.ports, there, here);
  }
  return both;
}

ContactEllipse disc_in(const RegionFrame& frame, const glm::dvec3& center, double radius) {
  return {center, radius * frame.tangent_x, radius * frame.tangent_y, frame.normal, radius};
}

/// A disc as large as the grid around a new region's contact points.
ContactEllipse disc_of_grid(const RegionFrame& frame) {
  return disc_in(frame, frame.origin, std::sqrt(frame.half_size.x * frame.half_size.y));
}

/// Accounts for a part of a region's load that has become another region's.
/// @param motion  by that load here, 6 x 6
/// @param known   the part of it that has been applied before
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

/// The load to which the body has answered. A contact model that does not know the answer to its
/// load in the step in which that is found is a step ahead of the body with it.
Vector6 answered_load(const CompliantBody& body, std::uint32_t region, const SupportFit& here) {
  if (law_of(body.model, body.row).by_cells) {
    return contact_load(body.model, body.state, region, here).wrench;
  }
  const auto& wrench = body.state.regions.at<RegionReaction>(region).wrench;
  return Eigen::Map<const Vector6>(wrench.data());
}

/// How the loads of a body's regions move the material under a contact.
/// @param counts  of a region's row: whether its load does
template <class Counts>
Vector6 motion_under(const CompliantBody& body, const ContactEllipse& contact,
                     const Counts& counts) {
  const State& state = body.state;
  SupportFit there;
  Vector6 motion = Vector6::Zero();
  for (std::uint32_t other = 0; other < state.regions.size(); ++other) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(other);
    const SupportFit& here = state.support_fits.at<SupportFit>(block_of(identity));
    if (identity.body != body.row || !counts(other) || here.reach == 0.0) {
      continue;
    }
    if (there.reach == 0.0) {
      fit_support(body.ports, contact, there);
      there.share = 1.0;
    }
    motion += motion_of(body, there, here) * answered_load(body, other, here);
  }
  return motion;
}

}  // namespace

Pose motion_of_material(const Model& model, State& state, std::uint32_t row, std::uint32_t tool,
                        const SurfaceSpot& spot) {
  RegionFrame frame;
  frame.origin = spot.point;
  frame.half_size = glm::dvec2(spot.radius);
  turn_normal_to(frame, spot.normal);
  const CompliantBody body{model, state, row, ports_of(model, row)};
  const Vector6 motion = motion_under(body, disc_of_grid(frame), [&](std::uint32_t region) {
    return state.regions.at<RegionIdentity>(region).tool != tool;
  });
  const glm::dquat rotation = rotation_by({motion[3], motion[4], motion[5]});
  return {spot.point - rotation * spot.point + glm::dvec3(motion[0], motion[1], motion[2]),
          rotation};
}

void begin_support(const Model& model, State& state, std::uint32_t region) {
  const std::uint32_t row = state.regions.at<RegionIdentity>(region).body;
  RegionSupport& support = state.regions.at<RegionSupport>(region);
  support = RegionSupport{};
  const CompliantBody body{model, state, row, ports_of(model, row)};
  const Vector6 motion = motion_under(body, disc_of_grid(state.regions.at<RegionFrame>(region)),
                                      [region](std::uint32_t other) { return other != region; });
  support.about = state.regions.at<RegionFrame>(region).origin;
  support.translation = {motion[0], motion[1], motion[2]};
  support.rotation = {motion[3], motion[4], motion[5]};
  support.translation_by_others = support.translation;
  support.rotation_by_others = support.rotation;
}

void begin_answer(const Model& model, State& state, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const ContactLaw& law = law_of(model, identity.body);
  const Overlap& overlap = state.regions.at<Overlap>(region);
  const bool knows_answer = law.by_cells || law.moves_own_support;
  SupportFit& support_fit = state.support_fits.at<SupportFit>(block_of(identity));
  if (!knows_answer || overlap.area <= 0.0 || support_fit.reach > 0.0) {
    return;
  }
  const CompliantBody body{model, state, identity.body, ports_of(model, identity.body)};
  const SupportedRegion supported = supported_region(model, state, region);
  forget_couplings(state, supported.block);
  // A ball's contact on an elastic half-space has half the area of its overlap.
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  fit_region_support(
      body, supported,
      disc_in(frame, overlap.rest_center, overlap.radius * std::numbers::sqrt2 / 2.0));
  support_fit.serial |= kForFirstStep;
}

void begin_split_support(const Model& model, State& state, std::uint32_t from,
                         std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(from);
  RegionSupport& old = state.regions.at<RegionSupport>(from);
  RegionSupport& fresh = state.regions.at<RegionSupport>(region);
  fresh = old;
  const SupportFit& here = state.support_fits.at<SupportFit>(block_of(identity));
  if (law_of(model, identity.body).by_cells || here.reach == 0.0) {
    return;
  }
  const CompliantBody body{model, state, identity.body, ports_of(model, identity.body)};
  SupportFit there;
  fit_support(body.ports, disc_of_grid(state.regions.at<RegionFrame>(region)), there);
  there.share = here.share;
  const ToEachOther both = to_each_other(body, there, here);
  const double relative = there.radius / here.radius;
  const double share = std::min(relative * relative, 0.5);
  Vector6 taken = Vector6::Zero();
  const Vector6 load = contact_load(model, state, from, here).wrench;
  taken.head<3>() = share * load.head<3>();
  Vector6 left = load - taken;
  const glm::dvec3 arm = there.center - here.center;
  const glm::dvec3 couple = glm::cross(arm, glm::dvec3(taken[0], taken[1], taken[2]));
  left.tail<3>() -= Eigen::Vector3d(couple.x, couple.y, couple.z);
  move_by_part(both.motion, both.known, left, there.center, fresh);
  move_by_part(both.motion.transpose(), both.known.transpose(), taken, here.center, old);
  // How far each has been moved by its own load (contact_load.hpp).
  Eigen::Map<Vector6>(state.regions.at<RegionReaction>(from).wrench.data()) -= load - left;
  Eigen::Map<Vector6>(state.regions.at<RegionReaction>(region).wrench.data()) = taken;
}

void split_support(const Model& model, State& state, std::uint32_t from, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(from);
  const SupportFit& here = state.support_fits.at<SupportFit>(block_of(identity));
  if (here.reach == 0.0) {
    return;
  }
  const CompliantBody body{model, state, identity.body, ports_of(model, identity.body)};
  const SupportedRegion supported = supported_region(model, state, region);
  forget_couplings(state, supported.block);
  fit_region_support(body, supported, contact_ellipse(model, state, region));
  const SupportFit& there = support_fit_of(body, supported);
  const ToEachOther both = to_each_other(body, there, here);
  RegionSupport& old = state.regions.at<RegionSupport>(from);
  RegionSupport& fresh = state.regions.at<RegionSupport>(region);
  fresh = old;
  move_by_part(both.motion, both.known, contact_load(model, state, from, here).wrench, there.center,
               fresh);
  move_by_part(both.motion.transpose(), both.known.transpose(),
               contact_load(model, state, region, there).wrench, here.center, old);
  RegionReaction& reaction = state.regions.at<RegionReaction>(from);
  if (reaction.active != 0) {
    // The regions have answered to the whole load, and it is still there.
    Eigen::Map<Vector6>(reaction.wrench.data()) -= contact_load(model, state, region, here).wrench;
  }
}

void join_support(const Model& model, State& state, std::uint32_t ended, std::uint32_t heir) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(heir);
  const SupportFit& here = state.support_fits.at<SupportFit>(block_of(identity));
  const SupportFit& there =
      state.support_fits.at<SupportFit>(block_of(state.regions.at<RegionIdentity>(ended)));
  if (here.reach == 0.0 || there.reach == 0.0) {
    return;
  }
  const CompliantBody body{model, state, identity.body, ports_of(model, identity.body)};
  const ToEachOther both = to_each_other(body, here, there);
  RegionSupport& support = state.regions.at<RegionSupport>(heir);
  move_by_part(both.motion, both.known, -contact_load(model, state, ended, there).wrench,
               here.center, support);
  state.regions.at<RegionReaction>(heir) = RegionReaction{};
}

}  // namespace torsion::engine
