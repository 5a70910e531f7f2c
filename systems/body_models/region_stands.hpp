#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "systems/body_models/contact_load.hpp"
#include "systems/body_models/footing.hpp"

namespace torsion {

/// A region on a body with body model compliance.
struct Stand {
  std::uint32_t region = 0;
  std::uint32_t block = 0;  // of cells, and row of its footing
  ContactLoad load;
  Vector6 motion = Vector6::Zero();  // at the footing's centre, by this region's own load
  bool solved = false;               // its contact model knows what that is: contact model patch
};

/// One body at work.
struct CompliantBody {
  World& world;
  std::uint32_t row;
  PortCompliance ports;
  std::array<Stand, kMaxRegionsPerBody> stands{};
  std::size_t count = 0;
};

Footing& footing_of(const CompliantBody& body, const Stand& stand);

/// Square root of the stiffness of a contact that sticks against motions at its footing's centre,
/// 6 x 6, body axes, and its inverse.
struct StiffnessRoot {
  Matrix6 root;
  Matrix6 inverse;
};
StiffnessRoot stiffness_root(const CompliantBody& body, const Stand& stand);

/// So many couplings between regions are found anew in a step at most, for each body: all of one
/// footing's.
inline constexpr std::size_t kCouplingsAStep = kMaxRegionsPerBody;

/// Takes the regions of the body, lays footings, and moves the regions by their own loads. That a
/// step has a bounded cost, of the footings that no longer fit one is laid anew in a step, that
/// which was laid first; the others serve a step longer. A new region's is laid at once.
void find_stands(CompliantBody& body);

/// Where a region that begins finds the material: moved by what the body's other regions do to it
/// now. Without it the first solution would press on the body at rest, and the others would feel
/// that. Writes RegionSupport.
void begin_support(World& world, std::uint32_t region);

/// The same of a region that splits off another one: where that one has it. With contact model
/// patch split_support has the rest to do, of others the load is shared out by the discs' areas.
/// Writes RegionSupport, of both.
void begin_split_support(World& world, std::uint32_t from, std::uint32_t region);

/// A region with contact model patch that has taken a part of another's load: to each of the two
/// what the other one's part does to it is by another region from now on. Writes Footing of the new
/// one, and RegionSupport and RegionReaction.
void split_support(World& world, std::uint32_t from, std::uint32_t region);

/// A region with contact model patch that has taken over another one's tractions, which that still
/// has, too: what they do here is by its own load from now on. Writes RegionSupport and
/// RegionReaction.
void join_support(World& world, std::uint32_t ended, std::uint32_t heir);

/// Finds couplings anew between regions whose footings have been laid since, kCouplingsAStep at
/// most, of new regions first; the others stay as they are a step longer.
void find_couplings(const CompliantBody& body);

/// What a wrench on one region does to another one, half-space included. Of (to, from) and (from,
/// to) the one whose `to` has the higher block is stored; the other is it transposed.
RegionCoupling& coupling_between(const CompliantBody& body, const Stand& to, const Stand& from);

}  // namespace torsion
