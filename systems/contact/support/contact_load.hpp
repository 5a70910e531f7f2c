#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "ecs/state.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/support/support_fit.hpp"

namespace torsion::engine {

/// What a region's contact does to the material.
struct ContactLoad {
  SupportMoments moments{};          // N: of its forces, in a support fit's SupportField
  Vector6 wrench = Vector6::Zero();  // N, N m about the support fit's centre
};

PortCompliance ports_of(const Model& model, std::uint32_t body);

/// The ellipse that has the area and the second moments of the cells that carry pressure; the
/// region's disc where the contact model has no pressures cell by cell.
ContactEllipse contact_ellipse(const Model& model, const State& state, std::uint32_t region);

/// Contact model patch: cell by cell. The others: force and couple as a ball spreads them.
ContactLoad contact_load(const Model& model, const State& state, std::uint32_t region,
                         const SupportFit& support_fit);

// How a compliant body deflects under a region within the step in which the region's loads are
// found. Contact model patch has that in its own equations (patch/support.hpp); this is for those
// that know a contact as a whole.

/// Of a contact on the material: forces along the grid's x and y and the couple about its normal,
/// and the force into the body; or motions along them, m and rad.
using ContactLoads = glm::dvec4;

struct OwnAnswer {
  bool any = false;            // else the body does not deflect, or not so that it is known
  glm::dvec3 point{0.0};       // m, body: where the loads act
  glm::dmat4 compliance{0.0};  // motions by loads: the others' answers are in it, where they matter
  ContactLoads known{0.0};     // to which the body has deflected already
  // Of loads of 1, about the support fit's centre: wrenches, and what they move.
  Eigen::Matrix<double, 6, 4> wrenches, motions;
};

/// @param point  m, body: where the loads act
OwnAnswer own_answer(const Model& model, const State& state, std::uint32_t region,
                     const glm::dvec3& point);

/// What becomes of the region's support when the body has deflected under so much more load.
/// @param accounted  motion of the material that the contact has accounted for
SupportAnswer support_answer(const Model& model, const State& state, std::uint32_t region,
                             const OwnAnswer& answer, const ContactLoads& more,
                             const ContactLoads& accounted);

}  // namespace torsion::engine
