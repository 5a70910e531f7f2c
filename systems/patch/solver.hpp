#pragma once

// Contact with Coulomb friction on a grid of cells of an elastic half-space: which pressures and
// tangential tractions press a given shape into it and move it along.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "systems/half_space/influence.hpp"
#include "systems/patch/disc_projection.hpp"
#include "systems/patch/support.hpp"

namespace torsion::engine {

/// One grid's cells as columns, (side x side) each, x fastest, and followed by zeros up to whole
/// lanes (wide_lanes.hpp). Tractions are on the body; z points into it.
struct PatchColumns {
  // in
  std::span<double> depth;               // m: overlap; very negative where there can be no contact
  std::span<double> friction;            // Coulomb's coefficient of each cell
  std::span<double> target_x, target_y;  // m: where a cell that sticks is displaced to
  // in and out: tractions, Pa, and the displacements that they cause, m
  std::span<double> pressure, traction_x, traction_y;
  std::span<double> depression, moved_x, moved_y;
  // out
  std::span<double> slips;  // 1: at the friction limit or without pressure, 0: sticks
};

/// What a solution needs while it is sought.
struct PatchWork {
  // (side x side), and zeros up to whole lanes
  std::vector<double> residual_x, residual_y;              // m
  std::vector<double> preconditioned_x, preconditioned_y;  // Pa: z, the preconditioned residual
  std::vector<double> direction_x,
      direction_y;  // Pa: d, the search direction, and then the last step; pressures have x only
  std::vector<double> response_x, response_y;                    // m: A d, the displacements by it
  std::vector<double> response_both;                             // m: what both components share
  std::vector<double> limit, along_x, along_y, softened, clips;  // as in TractionColumns
  std::vector<double> change_pressure, change_x, change_y;       // Pa, in this solution
  std::vector<double> change_depression, depth;                  // m, of a round (rounds.cpp)
  // Rigid motions of the cells that count, and what the preconditioner makes of them, Pa/m and Pa
  std::array<std::vector<double>, 3> rigid_x, rigid_y, rigid_tractions_x, rigid_tractions_y;
  // Of tractions on a body that deflects: where their cells are to go beside its motion, m
  std::vector<double> target_x, target_y;
  DiscColumns discs;
  LocalInverses inverses;  // of the problem's tables, found by solve_patch
  // ((side + 2) x (side + 2)): cells with a border of zeros, and kLanes zeros
  std::vector<double> bordered;
  // Cells with a traction
  std::vector<double> scales_x, scales_y, scales;
  std::vector<std::uint32_t> places;  // as in InfluenceSources
  void reserve(std::uint32_t side);
};

/// Cells that only partly lie in contact, at the rims of faces. What such a cell carries it carries
/// on a smaller area, and deflects by more under it: a softness of its own that grows beyond all
/// bounds as the share goes to 0, so that cells come and go with nothing.
struct PatchRims {
  // (side x side) and zeros up to whole lanes; empty when all cells in contact are so as a whole
  std::span<const double> softness;  // over the cell's own influence on itself; 0 of whole cells
  std::span<const double> root;      // 1 / sqrt(1 + softness)
};

/// What one solution is for.
struct PatchProblem {
  InfluenceTables influences;
  PatchRims rims;
  PatchSupport support;     // what the body as a whole adds to displacements
  double compliance = 0.0;  // m/Pa: cell length along x over the shear modulus
  bool coupled = false;     // pressure moves the surface sideways: nu < 0.5
  double feedback = 0.0;    // mu beta: of pressures on themselves by friction (rounds.cpp)
  double reference = 0.0;   // Pa: typical pressure; a largest change below `skip` times it ends
  double skip = 1e-9;       // relative
  double settled = 3e-2;    // of the whole change of a step: a smaller one ends it, too; sums over
                            // the cells
  double extrapolated_pressure =
      0.0;  // Pa: change since the last step that is there already, sum over
  double extrapolated_traction = 0.0;     // the cells, both components
  std::uint32_t iterations = 2;           // at most, of the pressures and then of the tractions
  std::uint32_t traction_iterations = 0;  // at most, of the tractions, where that is more
  std::uint32_t rounds = 1;  // at most, of the two in turn where they are coupled; more
                             // where much friction feeds back
  std::uint32_t iterations_of_rounds = 0xffffffff;  // at most, of all rounds together
};

/// What became of it.
struct PatchOutcome {
  // What is left of the equations, as a norm over the cells: of the gap or overlap over that of the
  // depth, or of what slip does not have the friction that belongs to it (traction_residual) over
  // that of friction's coefficient times depth, whichever is more.
  double residual = 0.0;
  double last_change = 0.0;  // the largest of the last iteration, over `reference`
  std::uint32_t iterations = 0;
};

/// Projected conjugate gradients, first for pressures p >= 0, then for tractions in their discs
/// |q| <= mu p, both with the local inverse B of the influences A as preconditioner. With r the
/// residual, z = B r, beta = r' z over that of the iteration before, search direction
/// d = z + beta times the last step, alpha = r' d / d' A d: the step is alpha d. (A textbook
/// carries the last direction on, not the last step. Where cells come and go in between that was
/// measured to be no better: after two iterations forces and torques of the shipped scenes are as
/// far from those after sixty.) An iteration changes all cells at once, so the grid has no first
/// cell, and mirror images have mirrored solutions. Starts from the tractions that are there;
/// displacements must belong to them. With mu = 0 the tractions go to zero. Source: Polonsky and
/// Keer, Wear 231 (1999) 206; Dostal and Kozubek, Mathematical Programming 135 (2012) 195 (discs);
/// Johnson, Contact Mechanics, 1985, 5.9; Vollebregt, CONTACT user guide.
PatchOutcome solve_patch(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work);

/// Displacements from tractions, from nothing.
void displace_patch(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work);

/// Takes the tractions away from cells that pull, and from those out of reach: pressure below or at
/// zero, or depth below `least_depth`.
void release_cells(const PatchProblem& problem, const PatchColumns& columns, PatchWork& work,
                   double least_depth);

}  // namespace torsion::engine
