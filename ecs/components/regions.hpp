#pragma once

// Contact regions. Rows are in the order of formation; a region of a step continues the one of the
// last step that it overlaps most.
// Units, frames and "written by": ecs/components.hpp.

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ecs/components/basics.hpp"
#include "ecs/range.hpp"

namespace torsion::engine {

/// Written by: group_regions.
struct RegionIdentity {
  std::uint32_t body = 0;   // row in `bodies`
  std::uint32_t tool = 0;   // row in `tools`
  std::uint64_t order = 0;  // 0, 1, 2, ... in the order of formation, never used twice
  Range cells;              // its rows in `cells`: grid_side x grid_side, x fastest
};

/// The region's block of cells, by number: it does not move when rows do.
inline std::uint32_t block_of(const RegionIdentity& region) {
  return region.cells.first / region.cells.count;
}

/// The grid's placement. Its x and y axes keep their direction as well as the turning normal lets
/// them. Written by: region_grids.
struct RegionFrame {
  glm::dvec3 origin{0.0};               // m, body: on the rest surface, centre of the grid
  glm::dvec3 tangent_x{1.0, 0.0, 0.0};  // body, unit
  glm::dvec3 tangent_y{0.0, 1.0, 0.0};  // body, unit
  glm::dvec3 normal{0.0, 0.0, 1.0};     // body, unit, out of the body: tangent_x x tangent_y
  glm::dvec2 half_size{0.0};            // m: the grid covers origin +- half_size
};

/// How the material under the region has moved from where the rest shape has it, as a rigid body.
/// Contact is found against the rest shape, so the tool is seen from the moved material. Written
/// by: the contact model; zero for `paper`.
struct RegionCarrier {
  glm::dvec3 translation{0.0};  // m, body, of the grid's origin
  glm::dvec3 rotation{0.0};     // rad, body: rotation vector
};

/// How the whole body's deformation has moved the material under the region, as a rigid body.
/// Written by: compliance; zero with other body models.
struct RegionSupport {
  glm::dvec3 about{0.0};             // m, body: the point that has gone by `translation`
  glm::dvec3 translation{0.0};       // m, body
  glm::dvec3 rotation{0.0};          // rad, body: rotation vector
  glm::dvec3 translation_step{0.0};  // m: by the last step
  glm::dvec3 rotation_step{0.0};     // rad
  // The part of it that the body's other regions have to do with; the rest is by its own load.
  glm::dvec3 translation_by_others{0.0};  // m, body, likewise
  glm::dvec3 rotation_by_others{0.0};     // rad
};

/// How the body's other regions answer to a change of this one's load, where the body deflects
/// much: by it they move this one, as a rigid body, by minus `motion` times the change. Without it
/// each of two tools that pinch a soft body would feel it move away by far, and the other's answer
/// a step later. Written by: compliance; zero where the body deflects little. With contact
/// model mdr `wrench` is what the region's own support counts on, whether others answer or not.
struct RegionReaction {
  std::array<double, 36> motion{};  // 6 x 6, body axes, about RegionSupport::about
  std::array<double, 6> wrench{};   // on the material, about it, that the others have answered to
  std::uint32_t active = 0;
  std::uint32_t padding = 0;
};

inline constexpr std::uint32_t kSupportTerms = 15;

/// How the whole body's deformation moves the material under the region beyond RegionSupport: a
/// polynomial of the fourth degree in two coordinates along the surface. Written by: compliance;
/// zero with other body models.
struct SupportField {
  glm::dvec3 origin{0.0};   // m, body
  glm::dvec3 along_x{0.0};  // 1/m, body: coordinate x is dot(along_x, point - origin)
  glm::dvec3 along_y{0.0};
  std::array<glm::dvec3, kSupportTerms> terms{};  // m, body: of 1; x, y; x^2, x y, y^2; x^3, ...
};

/// Where the tractions are: the grid as it was when they were last carried over to it, moved since
/// with the material where that sticks; half_size 0 before the first time. Written by:
/// carry_tractions.
struct TractionFrame {
  RegionFrame frame;
};

/// Where the tool lies in the body's rest shape. Written by: region_grids.
struct Overlap {
  glm::dvec3 center{0.0};       // m, body: its centroid, on the tool's surface
  glm::dvec3 rest_center{0.0};  // m, body: above that on the body's rest surface
  double area = 0.0;            // m^2
  double radius = 0.0;          // m: sqrt(area / pi)
  double mean_depth = 0.0;      // m: x of the paper, over the area
  double largest_depth = 0.0;   // m
  // body, unit: of the rest surface, over the area; beside edges a part of the way there from the
  // grid's (overlap_normal.hpp)
  glm::dvec3 mean_normal{0.0};
};

/// What of the overlap carries load, as the contact model finds it: a ball's contact on an elastic
/// half-space has half the area of its overlap. Without force it is the overlap. Written by: the
/// contact model.
struct Contact {
  glm::dvec3 equivalent_point{0.0};  // m, body: p_eq, the pressure centre, on the tool's surface
  glm::dvec3 rest_point{0.0};        // m, body: where p_eq was on the body's rest surface
  double area = 0.0;                 // m^2
  double radius = 0.0;               // m: a, the contact radius
  double depth = 0.0;                // m: of the tool under the rest surface, as the model has it
};

/// The contact that is all of the overlap.
inline Contact contact_of(const Overlap& overlap) {
  return {overlap.center, overlap.rest_center, overlap.area, overlap.radius, overlap.mean_depth};
}

/// Motion of the tool over the body at the region. Written by: region_motion.
struct RegionMotion {
  glm::dvec2 pivot{0.0};  // m, grid: where the axis goes through the region; p_eq when it misses it
  glm::dvec2 slide{0.0};  // m, grid: tangential motion of the tool at the pivot in this step
  glm::dvec3 axis{0.0};   // body, unit; zero before the tool has turned
  double spin = 0.0;      // rad: turn about the normal in this step
  double turn = 0.0;      // rad: phi, the sum of spin since the region formed
  double largest_turn = 0.0;      // rad: the most that |turn| has been since then
  glm::dvec3 rotation{0.0};       // rad, body: the tool's over the material since then, summed up
  double largest_rotation = 0.0;  // rad: the most that its length has been
  double axis_share = 0.0;        // 1: the rotation axis goes through the region; 0: it misses it
  double lever = 0.0;  // m: l of the paper, distance to the fixed point along the axis, at least a
};

/// Written by: the contact model.
struct RegionNormal {
  double force = 0.0;      // N: F_n without rotation, along the outward normal on the tool
  double stiffness = 0.0;  // N/m: dF/dx
};

/// Written by: the contact model.
struct RegionFriction {
  glm::dvec2 force{0.0};       // N, grid, on the tool
  double couple = 0.0;         // N m, about the normal through p_eq, on the tool
  double kinetic_share = 0.0;  // 0: threshold mu_s and elastic traction; 1: mu_d along the slip
  double stick_radius = 0.0;   // m: r_m, at most a
  double stick_turn = 0.0;     // rad: phi at r_m that the body's surface follows (phi_m)
  double stick_share = 0.0;    // of the area that sticks: there the body moves with the tool
};

/// How the contact model `patch` stands in a region. Written by: patch_forces.
struct PatchState {
  glm::dvec2 slide{0.0};         // m, grid: motion of the last step, as in RegionMotion
  double spin = 0.0;             // rad, likewise
  double deepened = 0.0;         // m: change of the largest depth in the last step
  double along_last = 0.0;       // share of the motion before it by which it went on: -1 to 1
  double depth = 0.0;            // m: the largest depth
  double residual = 0.0;         // what is left of the equations, as in PatchOutcome
  std::uint32_t iterations = 0;  // in the last step
  std::uint32_t started = 0;     // 0: no solution yet
  std::uint32_t moved = 0;       // 1: the grid has moved, displacements must be found again
  std::uint32_t resized = 0;     // 1: and its cells have another size or other axes
  std::uint32_t settling = 0;    // steps to go until it has settled on other axes
  std::uint32_t cut = 0;         // 1: in the last step the contact came to the grid's edge
  std::uint32_t grown = 0;       // 1: the grid grew with the depth and is not fitted yet
  std::uint32_t copy_of = 0;  // in the step in which it splits off: 1 + the other's block of cells
};

/// What a region with contact model `patch` holds of the work done on it, and the forces of the
/// last step that its work is computed from. Written by: patch_forces.
struct PatchEnergy {
  double held = 0.0;       // J, with what the body as a whole holds of its load
  double owed = 0.0;       // J: lacking work that is still to be charged
  double lent = 0.0;       // J: what was held more after regriddings than before them
  double taken = 0.0;      // N, off the normal force: takes that back while the tool lifts off
  double depth = 0.0;      // m: the largest
  glm::dvec3 force{0.0};   // N, body, on the tool; with what is taken
  glm::dvec3 couple{0.0};  // N m, body, about `point`
  glm::dvec3 point{0.0};   // m, body
  // How far the body's other regions had moved the material here, as in RegionSupport.
  glm::dvec3 translation_by_others{0.0};  // m, body, of `point`
  glm::dvec3 rotation_by_others{0.0};     // rad
};

/// Where smooth exact shapes lie deepest in each other in a region with contact model `mdr`.
/// Written by: region_grids.
struct SmoothContact {
  double share = 0.0;        // 1: known from the shapes; 0: not, what the cells show counts
  double depth = 0.0;        // m, along the common normal
  glm::dvec2 place{0.0};     // m, grid
  glm::dvec2 extent{0.0};    // m: half the overlap's, along the grid's axes
  double curvature_1 = 0.0;  // 1/m, principal, of both surfaces together
  double curvature_2 = 0.0;  // 1/m, the larger
  double beyond = 0.0;  // how far the surfaces part at the edge beyond their paraboloid, relative
};

/// How the contact model `mdr` stands in a region. Written by: mdr_forces.
struct MdrState {
  double radius = 0.0;      // m: a of the last step, 0 before the first
  double elongation = 0.0;  // 1 - b / a
  double flat_share = 0.0;  // of the force: by a flat punch's pressure, the rest by a paraboloid's
  double kinetic_share = 0.0;  // 0: mu_s, 1: mu_d
};

/// Written by: region_wrenches.
struct RegionWrench {
  Wrench on_tool;            // world, about the tool's mass centre, as output
  Wrench event_change;       // world: what an event would have made jump; none: the last change
  double event_share = 0.0;  // of event_change, in on_tool: 1 at the event, 0 when faded
  std::uint32_t event_now =
      0;  // a RegionEvent (region_wrenches.hpp); group_regions and region_grids set it
  std::uint32_t padding = 0;
};

}  // namespace torsion::engine
