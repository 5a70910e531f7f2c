#pragma once

#include <array>

#include "systems/body/compliance/compliance.hpp"
#include "systems/body/compliance/slip.hpp"
#include "systems/body/compliance/supported_regions.hpp"

namespace torsion::engine {

/// Newton's step of a body: how it moves the material under all its regions from where their
/// supports have it, in the scaled motions y = K^(1/2) du.
struct NewtonStep {
  Vector motion;  // y: six rows a region
  StiffnessRoots roots;
  // Whether the regions' loads move with the material, in one equation for all regions (add_sway);
  // and how far each region has been moved since its load was found.
  bool sways_together = false;
  std::array<Vector6, kMaxRegionsPerBody> moved;
  Slips slips;
};

/// Finds the step of du = (I + C K)^-1 (C f - u). On a body that deflects much beside its contacts
/// it goes on from there where they slip, and finds the regions' answers to each other
/// (RegionReaction). May come out not finite.
/// @param body  its regions' loads and couplings found; sway() changes their motions
NewtonStep newton_step(CompliantBody& body, ComplianceScratch& scratch);

}  // namespace torsion::engine
