#pragma once

// What a region with contact model `patch` holds of the work that was done on it, so that it never
// gives back more.

#include <cstdint>
#include <span>

#include "ecs/state.hpp"
#include "systems/patch/solver.hpp"

namespace torsion::engine {

/// The local inverse so many times is at least the inverse of all influences of a grid: to 1 /
/// 0.656 of 12 cells a side, 1 / 0.638 of 16; coupled, at nu = 0, 1 / 0.411 and 1 / 0.396
/// (patch_energy_test.cpp).
inline constexpr double kStiffest = 1.75;
inline constexpr double kStiffestCoupled = 3.0;

/// A step's solution in one region.
struct PatchSolution {
  const PatchProblem& problem;
  const PatchColumns& columns;
  /// m, into the body, whole lanes: how far the whole body's motion has gone beyond what the depths
  /// have of it already; zero where the body deflects as a half-space does.
  std::span<const double> sunk;
  double held_by_body;  // J: by the whole body under the region's load, beyond the half-space
  PatchWork& work;      // of the solution; overwritten
};

/// Where a step's solution has its beginning.
enum class SolutionStart : std::uint32_t {
  kNone,       // there is none before it
  kOtherGrid,  // in that of other cells or another support fit, which held something else
  kMovedGrid,  // in the last step's, of which cells have come and gone
  kLastStep
};

/// Takes back what the forces of this step, as they are in the region's components, would give the
/// tool's holder beyond what the region held: the work of a step is at least what the held energy
/// grows by. What is lacking is charged as a drag along the step's motion, shared out as by the
/// stiffness of a region that sticks. Where that drag would be too large the rest is owed.
/// So a solution that lags behind the tool, as one does that ends after few iterations, gives no
/// energy. Compare: passivity control, Hannaford and Ryu, IEEE Trans. Robotics and Automation 18
/// (2002) 1, which knows the work but not what is held. What a region holds more after regridding
/// than the one before it is no lag: it is lent, and taken back off the normal force while the tool
/// lifts off. Writes PatchEnergy, RegionNormal, RegionFriction.
///
/// The energy that a region's cells hold is computed from tractions t that need not be those of the
/// targets w: with u the displacements by them and r = u - w, the energy of w is
/// t u / 2 - t r + r A^-1 r / 2, A the influences (complementary energy, whose slope is r; Johnson,
/// Contact Mechanics, 1985, 5.9). Instead of A^-1 there is the local inverse, kStiffest times: so
/// that the energy of the residual is counted in advance, and never for less than it will be. A
/// body that deflects as a whole adds its compliance to A, so that A^-1 is less. Cells that slip
/// hold what they have.
/// @pre the displacements in the columns are those by the tractions alone, the targets likewise
void settle_energy(const Model& model, State& state, std::uint32_t region,
                   const PatchSolution& solution, SolutionStart start);

/// Gives a region that splits off another one its share of what that one holds, of which the force
/// is `share`. Both are at the tractions that they have kept.
void split_energy(State& state, std::uint32_t from, std::uint32_t region, double share);

/// What the other regions have to do with a region's motion was `before` and is something else now,
/// though the material has not moved: nothing works by that.
void retell_others(State& state, std::uint32_t region, const RegionSupport& before);

/// ContactLaw::end. What a region that ends hands to the one that takes over.
void join_energies(State& state, std::uint32_t ended_region, std::uint32_t heir_region);

}  // namespace torsion::engine
