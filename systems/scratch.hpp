#pragma once

#include <span>

#include "ecs/schedule.hpp"
#include "ecs/state.hpp"
#include "systems/body/compliance/compliance.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"
#include "systems/mdr/places.hpp"
#include "systems/paper/carry_tractions.hpp"
#include "systems/patch/scratch.hpp"

namespace torsion::engine {

/// What the systems of one step need besides model and state, room by room. Reserved at load; but
/// for the times that the schedule has taken nothing in it outlives a step, so that a saved state
/// replays without it.
struct Scratch {
  ContactScratch contact;
  PaperScratch paper;
  MdrTables mdr;  // constant; empty without contact model mdr
  PatchScratch patch;
  ComplianceScratch compliance;

  /// The systems that the scene needs.
  Schedule<StepContext> schedule;

  /// Takes all memory that a step can need. Load time only.
  /// @param tables  contact model mdr's, which are the same for all scenes; null: they are made,
  ///                in 40 ms
  void reserve(const Model& model, State& state, const MdrTables* tables = nullptr);

  /// What the systems of a step get.
  StepContext context(const Model& model, State& state, std::span<const Pose> tool_poses);
};

}  // namespace torsion::engine
