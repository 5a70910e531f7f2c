#pragma once

#include "ecs/state.hpp"

namespace torsion::engine {

/// What one step lets others see: values only, a few KiB, copied whole from the physics thread to
/// the frame.
struct Snapshot {
  Clock clock;
  Table<ToolPose, ToolMotion, ToolWrench> tools;
  Table<StoredEnergy, BodyPose> bodies;
  Table<ToolOverBody> tools_over_bodies;  // as State has them
  RegionTable regions;
  // Found for who draws (systems/surface/take_snapshot.hpp), zero until then
  Table<RegionField, AnchorTurns> region_fields;  // (regions)
  Table<AnchorMotion> anchors;                    // (Model::anchors)

  /// As State::over.
  [[nodiscard]] const ToolOverBody& over(std::uint32_t tool, std::uint32_t body) const {
    return tools_over_bodies.at<ToolOverBody>(tool * bodies.size() + body);
  }

  /// Takes memory for whatever a step of the scene can leave, with any models of its bodies.
  void reserve(const Model& model, const State& state);
};

/// Copies what it has of `state`, and zeroes the rest. Allocates nothing. @pre snapshot.reserve was
/// called with that model and state, or others of the same scene
void capture(const Model& model, const State& state, Snapshot& snapshot);

}  // namespace torsion::engine
