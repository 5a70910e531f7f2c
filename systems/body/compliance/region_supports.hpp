#pragma once

// Where the body has moved the material under regions that begin, split or merge.

#include <cstdint>

#include "ecs/state.hpp"

namespace torsion {

// What kComplianceLaw says of regions that begin, split off or end (contact/support/body_law.hpp).

/// BodyLaw::begin. Writes RegionSupport.
void begin_support(const Model& model, State& state, std::uint32_t region);

/// BodyLaw::begin_split. Writes RegionSupport, of both.
void begin_split_support(const Model& model, State& state, std::uint32_t from,
                         std::uint32_t region);

/// BodyLaw::split. Writes Footing of the new one, and RegionSupport and RegionReaction.
void split_support(const Model& model, State& state, std::uint32_t from, std::uint32_t region);

/// BodyLaw::join. Writes RegionSupport and RegionReaction.
void join_support(const Model& model, State& state, std::uint32_t ended, std::uint32_t heir);

}  // namespace torsion
