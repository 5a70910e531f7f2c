#pragma once

#include "systems/surface/take_snapshot.hpp"

namespace torsion {

/// Sums up every region of a half-space model for drawing: forces block by block, and the bonded
/// discs that turn the surface as its cells have turned and have the region's couple. Writes
/// RegionField.
void region_fields(const Model& model, const State& state, const SnapshotTables& tables,
                   Snapshot& snapshot);

}  // namespace torsion
