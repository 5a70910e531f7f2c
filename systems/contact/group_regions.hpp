#pragma once

#include "ecs/state.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion::engine {

inline bool is_of_pair(const RegionIdentity& region, const ContactPair& pair) {
  return region.tool == pair.tool && region.body == pair.body;
}

/// Gives the groups of contact points an identity over time: a group continues the region that it
/// overlaps most. Of several groups over one region the largest keeps it and the others form new
/// ones (a split); several regions over one group end in the oldest (a merge); a region over no
/// group ends. Where a contact goes on without points, its regions end in the oldest that their
/// cells touch. New regions get the next order of formation. What an event would make jump is noted
/// in RegionWrench and fades (region_wrenches).
void group_regions(StepContext& context);

/// One contact is one region, however few samples it has: clusters of contact points become one
/// where the tool's surface between them is inside the body; where they lie on covered cells of one
/// region (of the last step) that are joined, across corners too; and where they lie on two regions
/// whose cells touch. Without this the region of a facet with four samples would fall in two when
/// one of them leaves the contact, a ring would be sixteen, and a cylinder along another one as
/// many as it has samples near the line.
void join_clusters(const Model& model, const State& state, ContactScratch& scratch,
                   ContactPair& pair);

/// Whether a covered cell of one region (of the last step) lies on one of another or beside it, and
/// both look the same way.
bool touch(const Model& model, const State& state, std::uint32_t region, std::uint32_t other);

}  // namespace torsion::engine
