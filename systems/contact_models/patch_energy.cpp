#include "systems/contact_models/patch_energy.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/contact_models/patch_passes.hpp"
#include "systems/contact_models/stuck_stiffness.hpp"
#include "systems/frames.hpp"
#include "systems/region_motion.hpp"
#include "systems/widest.hpp"

namespace torsion {
namespace {

// At most, of the elastic change of a step and of the normal force; what is lacking beyond that is
// charged later.
constexpr double kMostCharge = 0.25;
constexpr double kMostDrag = 0.02;

struct EnergySums {
  Wide stored{};  // Pa m: twice the energy of the tractions
  Wide left{};    // Pa m: the tractions times what is left to do
};

/// @param left_x, left_y, left_z  m: the displacements beyond what was asked for, out
TORSION_WIDEST
void add_up(std::size_t count, const PatchColumns& columns, double* __restrict left_x,
            double* __restrict left_y, double* __restrict left_z, EnergySums& sums) {
  EnergySums total;
  const Wide none{};
  const Wide one = none + 1.0;
  for (std::size_t cell = 0; cell < count; cell += kPatchLanes) {
    const Wide pressure = lanes_at(&columns.pressure[cell]);
    const Wide traction_x = lanes_at(&columns.traction_x[cell]);
    const Wide traction_y = lanes_at(&columns.traction_y[cell]);
    const Wide down = lanes_at(&columns.depression[cell]);
    const Wide moved_x = lanes_at(&columns.moved_x[cell]);
    const Wide moved_y = lanes_at(&columns.moved_y[cell]);
    const Wide sticks = one - lanes_at(&columns.slips[cell]);
    const Wide gap = down - lanes_at(&columns.depth[cell]);
    // No choice within a choice, which the compiler makes cell by cell.
    const Wide overlap = gap < 0.0 ? gap : none;
    const Wide apart = pressure > 0.0 ? gap - overlap : none;
    const Wide z = overlap + apart;
    const Wide x = sticks * (moved_x - lanes_at(&columns.target_x[cell]));
    const Wide y = sticks * (moved_y - lanes_at(&columns.target_y[cell]));
    total.stored += pressure * down + traction_x * moved_x + traction_y * moved_y;
    total.left += pressure * z + traction_x * x + traction_y * y;
    lanes_at(left_x + cell) = x;
    lanes_at(left_y + cell) = y;
    lanes_at(left_z + cell) = z;
  }
  sums = total;
}

/// What is left to do times what it asks for, Pa m.
double asked_for(const PatchProblem& problem, const LocalInverse& inverse,
                 const std::vector<double>& left, PatchWork& work) {
  const std::uint32_t side = problem.influences.side;
  to_border(side, left.data(), work.bordered.data());
  return wanted_by_asked(inverse, 1.0 / problem.compliance, side, work.bordered.data());
}

/// The energy that the cells hold, J.
double held_energy(const PatchProblem& problem, const PatchColumns& columns, double cell_area,
                   PatchWork& work) {
  EnergySums sums;
  add_up(whole_lanes(columns.pressure.size()), columns, work.moves_x.data(), work.moves_y.data(),
         work.residual_x.data(), sums);
  const double asked = asked_for(problem, work.inverses.x, work.moves_x, work) +
                       asked_for(problem, work.inverses.y, work.moves_y, work) +
                       asked_for(problem, work.inverses.z, work.residual_x, work);
  const double stiffest = problem.coupled ? kStiffestCoupled : kStiffest;
  return cell_area * (0.5 * sum_of(sums.stored) - sum_of(sums.left) + 0.5 * stiffest * asked);
}

/// A step's motion as the region's stiffness sees it.
struct Drag {
  glm::dvec2 slide{0.0};  // m, grid
  double deepened = 0.0;  // m
  double spin = 0.0;      // rad
  double size = 0.0;      // m, with the spin at the radius
  double work = 0.0;      // J: of the stiffness over it, twice the energy
};

Drag drag_of(const StuckStiffness& stiffness, const RegionFrame& frame, double radius,
             const glm::dvec3& shift, double spin) {
  Drag drag;
  const glm::dvec3 along = body_to_grid_direction(frame, shift);
  drag.slide = glm::dvec2(along);
  drag.deepened = -along.z;
  drag.spin = spin;
  drag.size = std::sqrt(glm::dot(shift, shift) + spin * spin * radius * radius);
  drag.work = stiffness.along_tangents * glm::dot(drag.slide, drag.slide) +
              stiffness.along_normal * along.z * along.z + stiffness.about_normal * spin * spin;
  return drag;
}

void charge(World& world, std::uint32_t region, const glm::dvec3& shift, double spin,
            double lacking) {
  RegionNormal& normal = world.regions.at<RegionNormal>(region);
  RegionFriction& friction = world.regions.at<RegionFriction>(region);
  const double radius = world.regions.at<RegionGeometry>(region).radius;
  const StuckStiffness stiffness = stuck_stiffness(world, region, radius);
  const Drag drag = drag_of(stiffness, world.regions.at<RegionFrame>(region), radius, shift, spin);
  if (drag.work <= 0.0) {
    return;
  }
  const double most = std::min(kMostCharge, kMostDrag * normal.force * drag.size / drag.work);
  // By the mean of the wrenches before and after, so that half of it counts.
  const double share = std::min(2.0 * lacking / drag.work, most);
  friction.force -= share * stiffness.along_tangents * drag.slide;
  friction.couple -= share * stiffness.about_normal * spin;
  normal.force = std::max(normal.force + share * stiffness.along_normal * drag.deepened, 0.0);
}

PatchEnergy forces_of(const World& world, std::uint32_t region) {
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const RegionNormal& normal = world.regions.at<RegionNormal>(region);
  const RegionFriction& friction = world.regions.at<RegionFriction>(region);
  PatchEnergy energy;
  energy.depth = world.regions.at<RegionGeometry>(region).largest_depth;
  energy.force = frame.normal * normal.force + tangent_to_body(frame, friction.force);
  energy.couple = frame.normal * friction.couple;
  energy.point = world.regions.at<RegionGeometry>(region).equivalent_point;
  return energy;
}

/// The holder's work over a step by the mean of the forces before and after, J. The normal force is
/// bent over it: by Hertz' law, F ~ d^(3/2), the trapezoidal rule's first correction is that of its
/// slope, F h^2 (d1 - d0) / (16 d^2), which is nothing in small steps.
double work_between(const PatchEnergy& before, const PatchEnergy& after,
                    const MotionOverBody& motion, const glm::dvec3& normal) {
  const glm::dvec3 shift = shift_after(motion, after.point);
  const double twice = glm::dot(before.force, shift_before(motion, before.point)) +
                       glm::dot(after.force, shift) +
                       glm::dot(before.couple + after.couple, turn_of(motion));
  const double depths = before.depth + after.depth;
  const double share = depths > 0.0 ? glm::dot(normal, shift) / depths : 0.0;
  const double bent = 0.125 * glm::dot(normal, before.force + after.force) * share * share *
                      (after.depth - before.depth);
  return -0.5 * twice - bent;
}

}  // namespace

void settle_energy(World& world, std::uint32_t region, const PatchProblem& problem,
                   const PatchColumns& columns, PatchWork& work, bool begins) {
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const double held =
      held_energy(problem, columns, cell_area(frame, problem.influences.side), work);
  const MotionOverBody motion = motion_over_body(world, region);
  const PatchEnergy before = world.regions.at<PatchEnergy>(region);
  const double grown = before.owed + held - before.held;
  PatchEnergy now = forces_of(world, region);
  double owed = begins ? 0.0 : grown - work_between(before, now, motion, frame.normal);
  if (owed > 0.0) {
    charge(world, region, shift_after(motion, now.point), glm::dot(turn_of(motion), frame.normal),
           owed);
    now = forces_of(world, region);
    owed = grown - work_between(before, now, motion, frame.normal);
  }
  now.held = held;
  now.owed = std::max(owed, 0.0);
  world.regions.at<PatchEnergy>(region) = now;
}

}  // namespace torsion
