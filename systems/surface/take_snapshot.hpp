#pragma once

#include "ecs/snapshot.hpp"
#include "ecs/state.hpp"
#include "systems/mdr/places.hpp"
#include "systems/surface/region_fields.hpp"

namespace torsion::engine {

/// Where the anchors of bodies with body model compliance are under the tractions of all regions,
/// for those who draw them. Writes AnchorMotion and AnchorTurns.
void anchor_motions(const Model& model, const State& state, Snapshot& snapshot);

/// Displacements of the anchors of each body whose body model is kSkeleton, summed over its regions
/// in their order of formation: bending, shear, stretch and sideways contraction of a Timoshenko
/// beam from q_f to where p_eq was at rest. Torsion about the beam is left out: the twist angles of
/// the drawn vertices carry it (systems/surface/surface_field.hpp). Source: docs/models.md, "Body
/// model skeleton".
void skeleton_motions(const Model& model, const State& state, Snapshot& snapshot);

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

}  // namespace torsion::engine
