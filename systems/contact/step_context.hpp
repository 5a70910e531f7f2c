#pragma once

#include <span>

#include "ecs/state.hpp"

namespace torsion::engine {

struct ContactScratch;  // systems/contact/scratch.hpp

// What single models keep for themselves, each said in its own room.
struct PaperScratch;
struct MdrTables;
struct PatchScratch;
struct ComplianceScratch;

/// What a system of the physics step may touch.
struct StepContext {
  const Model& model;
  State& state;
  std::span<const Pose> tool_poses;  // (tools) the tool frames in the world at the end of this step
  ContactScratch& scratch;           // what the systems of contact/ tell each other within a step
  PaperScratch& paper;
  const MdrTables& mdr;
  PatchScratch& patch;
  ComplianceScratch& compliance;
};

}  // namespace torsion::engine
