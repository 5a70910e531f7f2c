#pragma once

// Where the body has moved the material under regions that begin, split or merge.

#include <cstdint>

#include "ecs/world.hpp"

namespace torsion {

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

}  // namespace torsion
