#pragma once

// Contact with Coulomb friction on a grid of cells of an elastic half-space: which pressures and
// tangential tractions press a given shape into it and move it along.

#include <cstdint>
#include <span>

#include "systems/contact_models/influence.hpp"

namespace torsion {

/// One grid's cells as columns, (side x side) each, x fastest. Tractions are on the body; z points
/// into it.
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

/// What one solution is for.
struct PatchProblem {
  InfluenceTables influences;
  double compliance = 0.0;   // m/Pa: cell length along x over the shear modulus
  bool coupled = false;      // pressure moves the surface sideways: nu < 0.5
  double reference = 0.0;    // Pa: typical pressure; changes below `skip` times it are left out
  double skip = 1e-5;        // relative
  std::uint32_t sweeps = 2;  // at most; even numbers go forth and back
};

/// What became of it.
struct PatchOutcome {
  double residual = 0.0;  // largest change of the last sweep over `reference`
  std::uint32_t sweeps = 0;
};

/// Block Gauss-Seidel with projection: pressures onto p >= 0, tractions onto the disc |q| <= mu p.
/// Starts from the tractions that are there; displacements must belong to them. With mu = 0 the
/// tractions go to zero.
/// Source: Johnson, Contact Mechanics, 1985, 5.9; Vollebregt, CONTACT user guide.
PatchOutcome solve_patch(const PatchProblem& problem, const PatchColumns& columns);

/// Displacements from tractions, anew.
void displace_patch(const PatchProblem& problem, const PatchColumns& columns);

/// Takes a cell's tractions away.
void unload_cell(const PatchProblem& problem, const PatchColumns& columns, std::uint32_t cell);

}  // namespace torsion
