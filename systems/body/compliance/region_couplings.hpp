#pragma once

// What a body's regions do to each other.

#include <cstddef>
#include <cstdint>

#include "systems/body/compliance/region_stands.hpp"

namespace torsion {

/// So many couplings between regions are found anew in a step at most, for each body: all of one
/// footing's.
inline constexpr std::size_t kCouplingsAStep = kMaxRegionsPerBody;

/// What a wrench on `here` does to `there`, half-space included.
Matrix6 motion_of(const CompliantBody& body, const Footing& there, const Footing& here);

/// A new region knows nothing of what the last one with its footing did to others.
void forget_couplings(State& state, std::uint32_t block);

/// Finds couplings anew between regions whose footings have been laid since, kCouplingsAStep at
/// most, of new regions first; the others stay as they are a step longer.
void find_couplings(const CompliantBody& body);

/// What a wrench on one region does to another one, half-space included. Of (to, from) and (from,
/// to) the one whose `to` has the higher block is stored; the other is it transposed.
RegionCoupling& coupling_between(const CompliantBody& body, const Stand& to, const Stand& from);

}  // namespace torsion
