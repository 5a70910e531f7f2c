#pragma once

// Where a tool's and a body's smooth exact surfaces lie deepest in each other, from the shapes
// themselves and not from samples or cells: the same whichever way the scene is turned or mirrored,
// and a depth whose change is the motion along the common normal, so that a force of it alone does
// no work around a closed path.

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

#include "ecs/components.hpp"
#include "ecs/state.hpp"
#include "systems/contact/step_context.hpp"
#include "systems/mdr/places.hpp"

namespace torsion::engine {

/// Finds a region's SmoothContact. Where it is known it also turns RegionFrame to the common normal
/// and moves Overlap's points and its largest depth to the deepest place. For ContactLaw::refine.
void refine_overlap(StepContext& context, std::uint32_t region);

// The paraboloid that fits a region's overlap.

struct ContactShape {
  double depth = 0.0;        // m: at the apex, over the centre where flat
  glm::dvec2 apex{0.0};      // m, grid: of the paraboloid, the middle where flat
  double curvature_1 = 0.0;  // 1/m, principal, >= 0: how fast the depth falls away from the apex
  double curvature_2 = 0.0;  // 1/m
  // m, along the same axes: half of the overlap's length, of a rectangle 1.15 times that (twice the
  // spread of the area, so that a square is about as wide as the disc of its area).
  double extent_1 = 0.0;
  double extent_2 = 0.0;
  double misfit = 0.0;  // root mean square of what the paraboloid leaves of the depth, over that
  // What does not depend on the paraboloid, but on sums over the overlap alone.
  glm::dvec2 stamp{0.0};  // m, grid: where a flat punch of this overlap would press
  double peak = 0.0;      // 0 where the depth is the same everywhere, 1 where it falls off as a
                          // paraboloid's or faster: 3 (mean of its square / square of its mean - 1)
  double axes = 1.0;      // smaller over larger spread of the area
  double mean_depth = 0.0;  // m, over the area, of the cells' middles
};

/// Least squares over the cells in contact, weighted by their share in it and about the square of
/// their depth, for what lies near the apex matters most. In a direction in which the depth hardly
/// falls off, because the contact is flat and ends at an edge, no apex can be told: there the place
/// is that of a stamp's force, and the depth is that over the middle of the area, which a tilt
/// about it does not change.
/// @param cells  (side x side)
ContactShape fit_contact_shape(const RegionFrame& frame, std::uint32_t side,
                               std::span<const CellGeometry> cells);

// The contact of a region as contact model mdr has it: round, or nearly so.

/// What a region's overlap says of its contact.
struct RoundContact {
  glm::dvec2 center{0.0};  // m, grid
  double radius = 0.0;     // m: sqrt(a b)
  double depth = 0.0;      // m
  double force = 0.0;      // N
  MdrPressure pressure;
  // Over those of a round contact of the same radius and force.
  double slide_stiffness = 1.0;
  double turn_stiffness = 1.0;
  double torque_share = 1.0;
};

/// From the shapes where those are known, else from the region's cells.
RoundContact round_contact(const Model& model, const State& state, std::uint32_t region);

/// dF/dd, which of all round contacts is 2 E* a. Source: Popov and Hess, 2015, 2.2.
/// @param modulus  E*, Pa
double normal_slope(const RoundContact& contact, double modulus);

/// The contact at another depth: near its own, d, its force goes with a power m of that, by its
/// slope there, and so its radius with the power m - 1.
/// @param depth  m, > 0
RoundContact pressed_to(double depth, double modulus, RoundContact contact);

/// Normal force on a bonded incompressible or compressible layer over that on a half-space, at
/// equal depth. Within 2 % up to chi = 0.26 (nu = 0.5), 7.7 % off at 0.5;
/// larger values are taken as 0.5. Source:
/// Dimitriadis et al., Biophys. J. 82 (2002) 2798.
/// @param chi  sqrt(R depth) / thickness
double layer_force_share(double chi, double poisson_ratio);

}  // namespace torsion::engine
