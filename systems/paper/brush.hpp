#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ecs/components.hpp"
#include "systems/math/lanes.hpp"

namespace torsion::engine {

/// What the cells of one region share in one step of the paper's friction. Tractions are per area,
/// on the tool, in the grid's plane.
struct BrushState {
  double pressure = 0.0;               // Pa: F_n / A, uniform (f_max / n of the paper)
  double shear_modulus = 0.0;          // G, Pa
  double translation_stiffness = 0.0;  // Pa/m: 8 G a / (2 - nu) spread over the area
  double inverse_slip_displacement =
      0.0;                     // 1/m: elastic deflection at which the translating region slips
  double inverse_limit = 0.0;  // 1/Pa: of the static friction limit
  Friction friction;
  bool falls = false;      // friction, once a cell slips: mu_d is not mu_s
  glm::dvec2 pivot{0.0};   // m, grid
  glm::dvec2 center{0.0};  // m, grid: p_eq
  glm::dvec2 slide{0.0};   // m, grid, this step
  double spin = 0.0;       // rad, this step
  double lever_origin =
      0.0;  // m: l at the grid's origin; l_i = |lever_origin + lever_slope . (x, y, z)|
  glm::dvec3 lever_slope{0.0};
  double least_lever = 0.0;  // m: a
  double kinetic_share = 0.0;
  bool several = false;  // another region of the same tool and body
};

/// So many cells at a time as columns: a loop over them is a few vectors, whatever their width.
inline constexpr std::size_t kBrushBlock = 32;
using BrushColumn = std::array<double, kBrushBlock>;

/// Cells in contact, as columns. Those that a block lacks have area 0 and count nothing.
struct alignas(64) BrushBlock {
  BrushColumn x, y, height;            // m, grid
  BrushColumn area;                    // m^2, in contact
  BrushColumn traction_x, traction_y;  // Pa
  BrushColumn kinetic_share;           // as in CellTraction
  BrushColumn sticks;                  // out: 1 or 0
  // on the way
  BrushColumn twist_stiffness;       // Pa/m: equation (2), tau = G r phi / l
  BrushColumn limit;                 // Pa: of friction
  BrushColumn elastic_x, elastic_y;  // Pa
  BrushColumn trial_size;            // Pa
  BrushColumn cut_x, cut_y;          // N: what the limit cuts off
  BrushColumn moved;                 // m: the cell's own motion over the body
};

/// Sums over a region's cells in contact.
struct BrushSums {
  double area = 0.0;
  double stuck_area = 0.0;
  glm::dvec2 force{0.0};
  double couple = 0.0;           // N m about the normal through p_eq
  glm::dvec2 cut{0.0};           // N: what the elastic limit took
  double moved = 0.0;            // m, largest
  double stuck_couple = 0.0;     // N m about the pivot, of the cells that stick
  double stuck_stiffness = 0.0;  // N m/rad, of the same
};

/// The same for every eighth cell, one after another.
struct alignas(64) BrushLanes {
  Lanes area{}, stuck_area{}, force_x{}, force_y{}, couple{}, cut_x{}, cut_y{}, moved{};
  Lanes stuck_couple{}, stuck_stiffness{};
};

/// The return map of every cell: elastic trial, capped at the friction limit; where the region
/// slides, towards the limit against the cell's own motion. Adds to `lanes`.
void update_brushes(const BrushState& brush, BrushBlock& block, BrushLanes& lanes);

/// What the lanes come to.
BrushSums total(const BrushLanes& lanes);

}  // namespace torsion::engine
