#pragma once

#include <cstdint>

#include "ecs/state.hpp"
#include "systems/contact/step_context.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/patch/cells.hpp"
#include "systems/patch/scratch.hpp"
#include "systems/patch/solver.hpp"

namespace torsion::engine {

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

/// The region's problem for this step, with the iterations of the settings.
Patch patch_of(StepContext& context, std::uint32_t region);

/// Whether the body as a whole deflects under the region's load.
bool has_support(const Patch& patch);

/// The body's own motion at every cell beyond what the tool's overlap has of it already; zero where
/// it deflects as a half-space does.
/// @return the energy that it holds of its own motion, J
double find_support(const Patch& patch);

/// Adds it, `sign` times, to the half-space's displacements.
void add_motion_of_body(const Patch& patch, double sign);

/// The tables that a region with contact model patch works with.
struct RegionInfluences {
  InfluenceTables tables;
  bool coupled = false;  // pressure moves the surface sideways
  bool changed = false;  // they are not those of the last step
};

/// The half-space's, from its body; on a layer with body model compliance its own, which are filled
/// when its grid or the thickness has changed. Writes LayerGrid.
RegionInfluences region_influences(const Model& model, State& state, std::uint32_t region);

/// ContactLaw::split. Begins a region that splits off another one as that one is: on the
/// same grid, with the same pressures and tractions. Which of the cells are whose is found with the
/// tool's surface; then share_out_patch tells them apart.
/// Nothing where that one has no solution (PatchState::started).
void copy_patch(State& state, std::uint32_t from, std::uint32_t region);

/// ContactLaw::share_out. Takes from a region that was copied in this step, and from the one that
/// it was copied from, the tractions on cells that have become the other's, and lets each know what
/// the other's load does to the body under it: nothing but the tool's motion is to change the sum
/// of their forces.
void share_out_patch(StepContext& context, std::uint32_t region);

/// ContactLaw::join. Lets a region take over what another one that ends holds: its grid is
/// laid around the loaded cells of both, the other's pressures and tractions are added, and what
/// that one's load does to the body here is by its own load from now on.
/// Nothing where one of both has no solution that has settled.
/// @pre the rows of the one that ends are still what they were
void join_patch(StepContext& context, std::uint32_t ended, std::uint32_t heir);

}  // namespace torsion::engine
