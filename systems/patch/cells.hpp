#pragma once

// The cells of a region with contact model `patch` between the tables, where each is a row, and the
// columns that the solver works on.

#include <cstdint>
#include <span>
#include <vector>

#include "ecs/state.hpp"
#include "systems/patch/solver.hpp"

namespace torsion::engine {

/// What a step needs of the cells beside PatchColumns, (side x side) each.
struct PatchPlaces {
  std::span<double> x, y;            // m, grid: the cells' centres
  std::span<double> height;          // m, grid: of the tool
  std::span<double> share;           // of a cell that is in contact
  std::span<double> softness, root;  // as in PatchRims
  std::span<double> from_x, from_y;  // m: where friction holds a cell, or how it is displaced
};

inline constexpr double kNoContact = -1e30;  // m: depth of a cell that cannot touch

/// The columns of the table `patch_cells`, rows of one region. Units and frames are those of
/// PatchMovedX and so on (ecs/components/cells.hpp).
struct PatchSurface {
  std::span<double> moved_x, moved_y, depression;
  std::span<double> held_x, held_y;
  std::span<double> known;  // 1: what is held is with the body's motion, 0: nothing is held
};
struct PatchChange {
  std::span<double> traction_x, traction_y, pressure;
  std::span<double> moved_x, moved_y, depression;
};

/// The rows of one region's cells.
struct PatchRows {
  std::span<const CellGeometry> geometry;
  std::span<CellTraction> tractions;
  PatchSurface surface;
  PatchChange change;
};

PatchRows patch_rows(State& state, Range cells);

/// Where cells were held while their grid moves, m, (side x side).
struct HeldBefore {
  std::vector<double> x, y;
};

/// Fills the columns with what the last step left, except displacements.
/// @return whether cells at rims are only partly in contact
bool load_cells(const PatchRows& rows, const Friction& friction, const PatchColumns& columns,
                const PatchPlaces& places);

/// Where cells start from: where they are held, or where they have moved to.
void find_starts(const PatchRows& rows, const PatchPlaces& places);

/// Adds to what the rows hold of displacements, of which the softness of cells at rims is no part,
/// what it makes of their tractions; with sign -1 takes it off.
/// @pre the tractions in the columns are the rows'
void add_rims(const PatchProblem& problem, const PatchColumns& columns, const PatchRows& rows,
              double sign);

/// Of what the last step changed.
struct ExtrapolationShares {
  double normal = 0.0;      // of the pressures and depressions
  double tangential = 0.0;  // of what is along the surface
};

/// How much of it to change again before anything else: as much as brings the complementary energy
/// of this step's depths and targets to its least along it, 0 to `most`.
/// @param coupled  pressures and tractions change together
ExtrapolationShares best_shares(const PatchRows& rows, const PatchColumns& columns, bool coupled,
                                double most);

/// Fills the displacements and carries all on by these shares. Sets what of it is extrapolated in
/// `problem`.
void extrapolate_cells(const PatchRows& rows, const ExtrapolationShares& shares,
                       const PatchColumns& columns, PatchProblem& problem);

/// Puts the columns back into the rows.
/// @param support_x, support_y  m: the body's motion, which what is held is with; empty without
void store_cells(const PatchColumns& columns, std::span<const double> support_x,
                 std::span<const double> support_y, const PatchRows& rows);

/// Where the cells go if they stick: on from where they are held, with the tool.
void set_targets(const RegionMotion& motion, const PatchPlaces& places,
                 const PatchColumns& columns);

/// Takes the body's motion off the targets that have it.
/// @param known                 of PatchSurface
/// @param support_x, support_y  m: the body's motion, which what is sought is without
void take_off_support(std::span<const double> known, std::span<const double> support_x,
                      std::span<const double> support_y, const PatchColumns& columns);

}  // namespace torsion::engine
