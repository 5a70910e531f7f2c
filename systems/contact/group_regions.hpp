#pragma once

#include "ecs/state.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion::engine {

/// Gives the groups of contact points an identity over time: a group continues the region that it
/// overlaps most. Of several groups over one region the largest keeps it and the others form new
/// ones (a split); several regions over one group end in the oldest (a merge); a region over no
/// group ends. New regions get the next order of formation. What an event would make jump is noted
/// in RegionWrench and fades (region_wrenches).
void group_regions(StepContext& context);

/// One contact is one region, however few samples it has: clusters of contact points that lie on
/// covered cells of one region (of the last step) become one where those cells are joined, across
/// corners too, and so do those of two regions whose cells touch. Without this the region of a
/// facet with four samples would fall in two when one of them leaves the contact, and a ring would
/// be sixteen.
void join_clusters(const Model& model, const State& state, ContactScratch& scratch,
                   ContactPair& pair);

}  // namespace torsion::engine
