#pragma once

#include "ecs/world.hpp"

namespace torsion {

/// What one step lets others see: values only, a few KiB, copied whole from the physics thread to
/// the frame.
struct Snapshot {
  Table<Clock> clock;
  Table<ToolPose, ToolMotion, ToolWrench> tools;
  RegionTable regions;
  // Found for who draws (systems/surface/take_snapshot.hpp), zero until then
  Table<RegionField, AnchorTurns> region_fields;  // (regions)
  Table<AnchorMotion> anchors;                    // (anchors of the world)

  /// Takes memory for whatever `world` can hold.
  void reserve(const World& world);
};

/// Copies the state of `world` into `snapshot`, and zeroes the rest. Allocates nothing. @pre
/// snapshot.reserve(world) was called.
void capture(const World& world, Snapshot& snapshot);

}  // namespace torsion
