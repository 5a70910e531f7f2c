#pragma once

#include <span>
#include <vector>

#include "ecs/state.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/patch/cells.hpp"
#include "systems/patch/solver.hpp"
#include "systems/patch/support.hpp"

namespace torsion::engine {

/// How far the body as a whole has moved the cells of one region, beside its RegionSupport, m:
/// along the grid's axes and into the body.
struct SupportColumns {
  std::span<double> x, y, z;
};

/// What contact model `patch` needs while it works on one region.
struct PatchScratch {
  DiscStiffness disc_stiffness;                // constant; empty without compliance
  PatchColumns columns;                        // (cells of one region)
  PatchPlaces places;                          // likewise
  SupportColumns support;                      // likewise
  std::vector<double> support_terms;           // (kSupportTerms x cells of one region)
  PatchWork work;                              // likewise
  HeldBefore held_before;                      // (cells of one region) while its grid moves
  std::vector<CellTraction> tractions_before;  // likewise

  Column<double> column_memory;  // what the columns above are in

  /// Takes all memory that a step can need; none where no body has this model.
  void reserve(const Model& model, const State& state);
};

}  // namespace torsion::engine
