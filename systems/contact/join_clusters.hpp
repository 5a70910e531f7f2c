#pragma once

#include "ecs/state.hpp"
#include "systems/contact/scratch.hpp"

namespace torsion {

/// One contact is one region, however few samples it has: clusters of contact points that lie on
/// covered cells of one region (of the last step) become one where those cells are joined, across
/// corners too, and so do those of two regions whose cells touch. Without this the region of a
/// facet with four samples would fall in two when one of them leaves the contact, and a ring would
/// be sixteen.
void join_clusters(const Model& model, const State& state, ContactScratch& scratch,
                   ContactPair& pair);

}  // namespace torsion
