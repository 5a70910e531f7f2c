#pragma once

// The cells and layers over which a region's contact model works.
// Units, frames and "written by": ecs/components.hpp.

#include <cstdint>

#include <glm/vec2.hpp>

namespace torsion::engine {

/// One cell of a region's grid. Written by: region_grids.
struct CellGeometry {
  // z of the tool's surface, m, grid: under the cell's centre, at a rim of the tool under the
  // middle of what of the cell lies under it.
  double height = 0.0;
  double depth = 0.0;     // m: overlap along the normal there, <= 0 outside the contact
  double coverage = 0.0;  // share of the cell's area that is in contact, 0 to 1
  // How stiff a cell is for contact model patch, 0 to 1: 1 where it can touch as a whole, 0 where
  // it cannot, in between at the rims of faces.
  double bearing = 0.0;
};

/// Written by: the contact model.
struct CellTraction {
  glm::dvec2 traction{0.0};    // Pa, grid, on the tool, per covered area
  double pressure = 0.0;       // Pa
  double kinetic_share = 0.0;  // 0: threshold mu_s; 1: mu_d, after slipping a slip length
  double coverage = 0.0;       // share of the cell that the traction acts on
  std::uint32_t sticks = 0;    // 1: sticks, 0: slips or carries nothing
  std::uint32_t padding = 0;
};

/// One value of the influence tables that fill_influences
/// (systems/half_space/influence.hpp) makes. Written by: load.
struct Influence {
  double value = 0.0;
};

/// What a region's own tables in `layer_influences` were filled for; zero before. Written by:
/// patch_forces.
struct LayerGrid {
  double thickness = 0.0;     // m; 0: for a curved surface
  glm::dvec2 half_size{0.0};  // m
  glm::dvec3 tangent_x{0.0};  // of the grid, for a curved surface
};

/// One number of a cell of a region with contact model `patch`, a column each, so that loops take
/// whole vectors. `Part` says which.
template <class Part>
struct PatchValue {
  double value = 0.0;
};

// The body's surface under the cell. Written by: patch_forces.
using PatchMovedX = PatchValue<struct MovedX>;  // m, grid: displacement of the local half-space
using PatchMovedY = PatchValue<struct MovedY>;  // m
using PatchDepression = PatchValue<struct Depression>;  // m: into the body
using PatchHeldX = PatchValue<struct HeldX>;  // m, grid: where friction holds or has left it
using PatchHeldY = PatchValue<struct HeldY>;  // m
using PatchKnown = PatchValue<struct Known>;  // 1, or 0: where it is held is where it has moved to

// What the last step changed, from which the next one starts. Written by: patch_forces.
using PatchChangeX = PatchValue<struct ChangeX>;  // Pa, grid: of the traction, on the body
using PatchChangeY = PatchValue<struct ChangeY>;  // Pa
using PatchChangePressure = PatchValue<struct ChangePressure>;      // Pa
using PatchChangeMovedX = PatchValue<struct ChangeMovedX>;          // m
using PatchChangeMovedY = PatchValue<struct ChangeMovedY>;          // m
using PatchChangeDepression = PatchValue<struct ChangeDepression>;  // m

inline constexpr std::uint32_t kMdrLayers = 32;

/// One layer of springs of a region with contact model `mdr`: how far the tool has deflected it.
/// Written by: mdr_forces.
struct MdrLayer {
  glm::dvec2 shift{0.0};  // m, grid
  double turn = 0.0;      // rad
};

}  // namespace torsion::engine
