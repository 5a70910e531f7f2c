#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ecs/model.hpp"
#include "ecs/state.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/contact/support/contact_load.hpp"
#include "systems/contact/support/support_fit.hpp"

namespace torsion::engine {

/// A region on a body with body model compliance.
struct SupportedRegion {
  std::uint32_t region = 0;
  std::uint32_t block = 0;  // of cells, and row of its support fit
  ContactLoad load;
  Vector6 motion = Vector6::Zero();  // at the support fit's centre, by this region's own load
  bool solved = false;               // its contact model computes that: patch does
};

/// One body, with its regions, while the system works on it.
struct CompliantBody {
  const Model& model;
  State& state;
  std::uint32_t row;
  PortCompliance ports;
  std::array<SupportedRegion, kMaxRegionsPerBody> regions{};
  std::size_t count = 0;
};

SupportFit& support_fit_of(const CompliantBody& body, const SupportedRegion& supported);

/// Square root of the stiffness of a contact that sticks against motions at its support fit's
/// centre, 6 x 6, body axes, and its inverse.
struct StiffnessRoot {
  Matrix6 root;
  Matrix6 inverse;
  Vector6 along;  // its diagonal along the contact's axes
  Matrix6 axes;   // rows: the grid's tangents and normal, for forces and for couples
};
using StiffnessRoots = std::array<StiffnessRoot, kMaxRegionsPerBody>;
StiffnessRoot stiffness_root(const CompliantBody& body, const SupportedRegion& supported);

/// A region as it stands, its load and motion not found yet.
SupportedRegion supported_region(const Model& model, const State& state, std::uint32_t region);

/// Fits the region's support, and finds the region's motion by its own wrench.
void fit_region_support(const CompliantBody& body, const SupportedRegion& supported,
                        const ContactEllipse& contact);

/// Finds the body's regions, fits their supports, and moves them by their own loads. To bound the
/// cost of a step, of the support fits that no longer fit only the oldest is refitted in a step;
/// the others are used for a step longer. A new region's support is fitted at once.
void find_supported_regions(CompliantBody& body);

// The motion of a body's regions by each other's wrenches.

/// The largest number of couplings between regions that are computed in a step, for each body: all
/// of one support fit's.
inline constexpr std::size_t kCouplingsAStep = kMaxRegionsPerBody;

/// Motion of `there` by a wrench on `here`, half-space included.
Matrix6 motion_of(const CompliantBody& body, const SupportFit& there, const SupportFit& here);

/// Forgets the couplings of the region that had this support fit before a new region.
void forget_couplings(State& state, std::uint32_t block);

/// Computes couplings again between regions whose supports have been refitted since, at most
/// kCouplingsAStep, new regions first. The others stay as they are for a step longer.
void find_couplings(const CompliantBody& body);

/// Motion of one region by a wrench on another one, half-space included. Of (to, from) and (from,
/// to) the one whose `to` has the higher block is stored; the other is its transpose.
RegionCoupling& coupling_between(const CompliantBody& body, const SupportedRegion& to,
                                 const SupportedRegion& from);

/// Motion of a contact on a layer as a rigid body, by a unit wrench with a ball's distribution of
/// traction, beyond that on a half-space (6 x 6, body axes, about its centre).
/// @param body       with a layer's kernel
/// @param thickness  m
Matrix6 layer_motion(const Model& model, std::uint32_t body, const ContactEllipse& contact,
                     double thickness);

/// In a support fit's serial: it is for the step in which its region begins, before that has
/// carried a load that says how large its contact is.
inline constexpr std::uint64_t kForFirstStep = std::uint64_t{1} << 63U;

// For regions that begin, split off or end: kComplianceLaw (contact/support/body_law.hpp).

/// BodyLaw::motion_at.
Pose motion_of_material(const Model& model, State& state, std::uint32_t row, std::uint32_t tool,
                        const SurfaceSpot& spot);

/// BodyLaw::begin. Writes RegionSupport.
void begin_support(const Model& model, State& state, std::uint32_t region);

/// BodyLaw::begin_answer. Writes SupportFit.
void begin_answer(const Model& model, State& state, std::uint32_t region);

/// BodyLaw::begin_split. Writes RegionSupport, of both.
void begin_split_support(const Model& model, State& state, std::uint32_t from,
                         std::uint32_t region);

/// BodyLaw::split. Writes SupportFit of the new one, and RegionSupport and RegionReaction.
void split_support(const Model& model, State& state, std::uint32_t from, std::uint32_t region);

/// BodyLaw::join. Writes RegionSupport and RegionReaction.
void join_support(const Model& model, State& state, std::uint32_t ended, std::uint32_t heir);

}  // namespace torsion::engine
