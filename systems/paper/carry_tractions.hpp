#pragma once

#include <vector>

#include <glm/vec4.hpp>

#include "systems/contact/step_context.hpp"

namespace torsion::engine {

/// What a place on the body carries from one grid to the next: traction times coverage along x and
/// y, Pa; coverage, as a share of the cell; kinetic share, as in CellTraction. In one vector, for
/// all four go the same way.
using CarriedCell = glm::dvec4;

/// What carry_tractions needs while it works on one region.
struct PaperScratch {
  std::vector<CarriedCell> carried_cells;  // (cells of one region and a border of one around them)

  /// Takes all memory that a step can need.
  void reserve(const Model& model);
};

/// System: a region's grid follows the contact, but the tractions belong to places on the body.
/// Where the grid has moved, grown or shrunk, each cell takes the tractions from where it now is,
/// between the old cells; new area starts without any, area that is left loses its own.
void carry_tractions(StepContext& context);

}  // namespace torsion::engine
