#pragma once

#include "ecs/world.hpp"

namespace torsion {

/// What one step lets others see: values only, a few KiB, copied whole from the physics thread to
/// the frame.
struct Snapshot {
  Table<Clock> clock;
  Table<ToolPose, ToolMotion, ToolWrench> tools;
  RegionTable regions;
  Table<AnchorMotion> anchors;

  /// Takes memory for whatever `world` can hold.
  void reserve(const World& world);
};

/// Copies the state of `world` into `snapshot`. Allocates nothing. @pre snapshot.reserve(world) was
/// called.
void capture(const World& world, Snapshot& snapshot);

}  // namespace torsion
