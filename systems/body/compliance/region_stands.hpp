#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ecs/model.hpp"
#include "ecs/state.hpp"
#include "systems/contact/support/contact_load.hpp"
#include "systems/contact/support/support_fit.hpp"

namespace torsion {

/// A region on a body with body model compliance.
struct Stand {
  std::uint32_t region = 0;
  std::uint32_t block = 0;  // of cells, and row of its support fit
  ContactLoad load;
  Vector6 motion = Vector6::Zero();  // at the support fit's centre, by this region's own load
  bool solved = false;               // its contact model knows what that is: contact model patch
};

/// One body at work.
struct CompliantBody {
  const Model& model;
  State& state;
  std::uint32_t row;
  PortCompliance ports;
  std::array<Stand, kMaxRegionsPerBody> stands{};
  std::size_t count = 0;
};

SupportFit& support_fit_of(const CompliantBody& body, const Stand& stand);

/// Square root of the stiffness of a contact that sticks against motions at its support fit's
/// centre, 6 x 6, body axes, and its inverse.
struct StiffnessRoot {
  Matrix6 root;
  Matrix6 inverse;
};
StiffnessRoot stiffness_root(const CompliantBody& body, const Stand& stand);

/// Lays the region's support fit, and finds what its own wrench does to it.
void lay_stand(const CompliantBody& body, const Stand& stand, const ContactEllipse& contact);

/// Takes the regions of the body, lays support fits, and moves the regions by their own loads. That
/// a step has a bounded cost, of the support fits that no longer fit one is refitted in a step,
/// that which was laid first; the others serve a step longer. A new region's is laid at once.
void find_stands(CompliantBody& body);

// What a body's regions do to each other.

/// So many couplings between regions are found anew in a step at most, for each body: all of one
/// support fit's.
inline constexpr std::size_t kCouplingsAStep = kMaxRegionsPerBody;

/// What a wrench on `here` does to `there`, half-space included.
Matrix6 motion_of(const CompliantBody& body, const SupportFit& there, const SupportFit& here);

/// A new region knows nothing of what the last one with its support fit did to others.
void forget_couplings(State& state, std::uint32_t block);

/// Finds couplings anew between regions whose supports have been refitted since, kCouplingsAStep at
/// most, of new regions first; the others stay as they are a step longer.
void find_couplings(const CompliantBody& body);

/// What a wrench on one region does to another one, half-space included. Of (to, from) and (from,
/// to) the one whose `to` has the higher block is stored; the other is it transposed.
RegionCoupling& coupling_between(const CompliantBody& body, const Stand& to, const Stand& from);

/// How a unit wrench on a contact of a layer, spread as a ball spreads it, moves the contact as a
/// rigid body (6 x 6, body axes, about its centre) beyond what it would do on a half-space.
/// @param body       with a layer's kernel
/// @param thickness  m
Matrix6 layer_motion(const Model& model, std::uint32_t body, const ContactEllipse& contact,
                     double thickness);

// Where the body has moved the material under regions that begin, split or merge.

// What kComplianceLaw says of regions that begin, split off or end (contact/support/body_law.hpp).

/// BodyLaw::begin. Writes RegionSupport.
void begin_support(const Model& model, State& state, std::uint32_t region);

/// BodyLaw::begin_split. Writes RegionSupport, of both.
void begin_split_support(const Model& model, State& state, std::uint32_t from,
                         std::uint32_t region);

/// BodyLaw::split. Writes SupportFit of the new one, and RegionSupport and RegionReaction.
void split_support(const Model& model, State& state, std::uint32_t from, std::uint32_t region);

/// BodyLaw::join. Writes RegionSupport and RegionReaction.
void join_support(const Model& model, State& state, std::uint32_t ended, std::uint32_t heir);

}  // namespace torsion
