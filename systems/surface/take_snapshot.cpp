#include "systems/surface/take_snapshot.hpp"

#include "systems/surface/anchor_motions.hpp"
#include "systems/surface/region_fields.hpp"
#include "systems/surface/skeleton_motions.hpp"

namespace torsion {

SnapshotTables make_snapshot_tables(const State& state, const MdrTables& mdr) {
  return {mdr, state.patch_cells.empty() ? RingProfiles{} : make_ring_profiles()};
}

void take_snapshot(const Model& model, const State& state, const SnapshotTables& tables,
                   Snapshot& snapshot) {
  capture(model, state, snapshot);
  region_fields(model, state, tables, snapshot);
  skeleton_motions(model, state, snapshot);
  anchor_motions(model, state, snapshot);
}

}  // namespace torsion
