#pragma once

#include "ecs/snapshot.hpp"
#include "ecs/state.hpp"

namespace torsion {

/// Where the anchors of bodies with body model compliance are under the tractions of all regions,
/// for those who draw them. Writes AnchorMotion and AnchorTurns.
void anchor_motions(const Model& model, const State& state, Snapshot& snapshot);

}  // namespace torsion
