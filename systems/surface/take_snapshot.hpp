#pragma once

#include "ecs/snapshot.hpp"
#include "ecs/state.hpp"
#include "systems/mdr/places.hpp"
#include "systems/surface/ring_turns.hpp"

namespace torsion {

/// Tables by which a step's snapshot is taken. Constant.
struct SnapshotTables {
  const MdrTables& mdr;  // those of the step: they take 40 ms to make
  RingProfiles rings;    // empty without contact model patch
};

/// Load time.
SnapshotTables make_snapshot_tables(const State& state, const MdrTables& mdr);

/// What a step has left, with all that only a picture needs of it: what each region does to the
/// surface around it, and how far the anchors have gone. Costs a part of a step, and nothing in
/// steps of which nobody takes one. Allocates nothing. @pre snapshot.reserve(model, state) was
/// called
void take_snapshot(const Model& model, const State& state, const SnapshotTables& tables,
                   Snapshot& snapshot);

}  // namespace torsion
