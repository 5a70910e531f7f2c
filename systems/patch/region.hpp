#pragma once

#include <cstdint>

#include "systems/contact/step_context.hpp"
#include "systems/patch/cells.hpp"
#include "systems/patch/scratch.hpp"
#include "systems/patch/solver.hpp"

namespace torsion {

/// One region of contact model patch at work.
struct Patch {
  const Model& model;
  State& state;
  const PatchColumns& columns;
  const PatchPlaces& places;
  const SupportColumns& support;
  PatchWork& work;
  std::uint32_t region = 0;
  std::uint32_t side = 0;
  RegionFrame frame;
  RegionMotion motion;
  PatchRows rows;
  PatchState& own;
  PatchProblem problem;
};

/// The region's problem for this step, with the sweeps of the settings.
Patch patch_of(StepContext& context, std::uint32_t region);

/// Whether the body as a whole gives way under the region's load.
bool has_support(const Patch& patch);

/// The body's own motion at every cell beyond what the tool's overlap has of it already; zero where
/// it gives way as a half-space does.
/// @return the energy that it holds of its own motion, J
double find_support(const Patch& patch);

/// Adds it, `sign` times, to the half-space's displacements.
void add_motion_of_body(const Patch& patch, double sign);

}  // namespace torsion
