#include "systems/surface/take_snapshot.hpp"

#include "systems/surface/anchor_motions.hpp"
#include "systems/surface/region_fields.hpp"
#include "systems/surface/skeleton_motions.hpp"

namespace torsion {

SnapshotTables make_snapshot_tables(const World& world) {
  SnapshotTables tables;
  if (!world.mdr_layers.empty()) {
    tables.mdr = make_mdr_tables();
  }
  if (!world.patch_cells.empty()) {
    tables.rings = make_ring_profiles();
  }
  return tables;
}

void take_snapshot(const World& world, const SnapshotTables& tables, Snapshot& snapshot) {
  capture(world, snapshot);
  region_fields(world, tables, snapshot);
  skeleton_motions(world, snapshot);
  anchor_motions(world, snapshot);
}

}  // namespace torsion
