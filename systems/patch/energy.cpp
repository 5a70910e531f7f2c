#include "systems/patch/energy.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/contact/stick_slip.hpp"
#include "systems/contact/tool_motion.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"
#include "systems/patch/passes.hpp"

namespace torsion::engine {
namespace {

// At most, of a step's elastic change and of the normal force. What is missing beyond that is
// charged later.
constexpr double kMostCharge = 0.25;
constexpr double kMostDrag = 0.02;
// Of the energy held: regridding lends up to 0.2 % of it.
constexpr double kMostLent = 0.01;
// Likewise, where a grid moves: a tool that rolls in steps so small that they cause little drag
// would owe ever more.
constexpr double kMostOwed = 0.01;

struct EnergySums {
  double stored = 0.0;  // Pa m: twice the energy of the tractions
  double left = 0.0;    // Pa m: the tractions times what is left to do
};

/// @param sunk  m: PatchSolution::sunk
/// @param left_x, left_y, left_z  m: the displacements beyond their targets, out
template <class Wide>
TORSION_LANES EnergySums add_up_energy(std::size_t count, const PatchColumns& columns,
                                       const double* __restrict sunk, double* __restrict left_x,
                                       double* __restrict left_y, double* __restrict left_z) {
  Wide stored{};
  Wide left{};
  const Wide none{};
  const Wide one = none + 1.0;
  for (std::size_t cell = 0; cell < count; cell += kLanes) {
    const Wide pressure = lanes_at<Wide>(&columns.pressure[cell]);
    const Wide traction_x = lanes_at<Wide>(&columns.traction_x[cell]);
    const Wide traction_y = lanes_at<Wide>(&columns.traction_y[cell]);
    const Wide down = lanes_at<Wide>(&columns.depression[cell]);
    const Wide moved_x = lanes_at<Wide>(&columns.moved_x[cell]);
    const Wide moved_y = lanes_at<Wide>(&columns.moved_y[cell]);
    const Wide sticks = one - lanes_at<Wide>(&columns.slips[cell]);
    const Wide gap = down + lanes_at<Wide>(sunk + cell) - lanes_at<Wide>(&columns.depth[cell]);
    // No branch inside a branch, which the compiler would take cell by cell.
    const Wide overlap = choose(gap < 0.0, gap, none);
    const Wide apart = choose(pressure > 0.0, gap - overlap, none);
    const Wide z = overlap + apart;
    const Wide x = sticks * (moved_x - lanes_at<Wide>(&columns.target_x[cell]));
    const Wide y = sticks * (moved_y - lanes_at<Wide>(&columns.target_y[cell]));
    stored += pressure * down + traction_x * moved_x + traction_y * moved_y;
    left += pressure * z + traction_x * x + traction_y * y;
    store_lanes(x, left_x + cell);
    store_lanes(y, left_y + cell);
    store_lanes(z, left_z + cell);
  }
  return {sum_of(stored), sum_of(left)};
}

/// u' B u of displacements u with B the preconditioner, Pa m.
double preconditioned_product(const PatchProblem& problem, const LocalInverse& inverse,
                              const std::vector<double>& left, PatchWork& work) {
  const std::uint32_t side = problem.influences.side;
  to_border(side, left.data(), work.bordered.data());
  return quadratic_form(inverse, 1.0 / problem.compliance, side, work.bordered.data());
}

/// The energy that the cells hold, and the body as a whole, J.
double held_energy(const PatchSolution& solution, double cell_area) {
  const PatchProblem& problem = solution.problem;
  PatchWork& work = solution.work;
  const EnergySums sums = TORSION_IN_WIDEST(
      add_up_energy, whole_lanes(solution.columns.pressure.size()), solution.columns,
      solution.sunk.data(), work.response_x.data(), work.response_y.data(), work.residual_x.data());
  const double product = preconditioned_product(problem, work.inverses.x, work.response_x, work) +
                         preconditioned_product(problem, work.inverses.y, work.response_y, work) +
                         preconditioned_product(problem, work.inverses.z, work.residual_x, work);
  const double stiffest = problem.coupled ? kStiffestCoupled : kStiffest;
  return solution.held_by_body +
         cell_area * (0.5 * sums.stored - sums.left + 0.5 * stiffest * product);
}

/// A step's motion, measured with the region's stiffness.
struct Drag {
  glm::dvec2 slide{0.0};  // m, grid
  double deepened = 0.0;  // m
  glm::dvec2 roll{0.0};   // rad, grid
  double spin = 0.0;      // rad
  double size = 0.0;      // m, with the turn at the radius
  double work = 0.0;      // J: of the stiffness over it, twice the energy
};

/// @param shift, turn  m and rad, body, at the contact's middle
Drag drag_of(const StuckStiffness& stiffness, const RegionFrame& frame, double radius,
             const glm::dvec3& shift, const glm::dvec3& turn) {
  Drag drag;
  const glm::dvec3 along = body_to_grid_direction(frame, shift);
  const glm::dvec3 about = body_to_grid_direction(frame, turn);
  drag.slide = glm::dvec2(along);
  drag.deepened = -along.z;
  drag.roll = glm::dvec2(about);
  drag.spin = about.z;
  drag.size = std::sqrt(glm::dot(shift, shift) + glm::dot(turn, turn) * radius * radius);
  drag.work = stiffness.along_tangents * glm::dot(drag.slide, drag.slide) +
              stiffness.along_normal * along.z * along.z +
              glm::dot(stiffness.about_tangents, drag.roll * drag.roll) +
              stiffness.about_normal * about.z * about.z;
  return drag;
}

/// The drag against rolling moves the centre of pressure ahead.
void charge(const Model& model, State& state, std::uint32_t region, const glm::dvec3& shift,
            const glm::dvec3& turn, double lacking) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  Contact& contact = state.regions.at<Contact>(region);
  RegionNormal& normal = state.regions.at<RegionNormal>(region);
  RegionFriction& friction = state.regions.at<RegionFriction>(region);
  const StuckStiffness stiffness = stuck_stiffness(model, state, region, contact.radius);
  const Drag drag = drag_of(stiffness, frame, contact.radius, shift, turn);
  if (drag.work <= 0.0) {
    return;
  }
  const double most = std::min(kMostCharge, kMostDrag * normal.force * drag.size / drag.work);
  // Work is computed with the mean of the wrenches before and after: half of the charge counts.
  const double share = std::min(2.0 * lacking / drag.work, most);
  friction.force -= share * stiffness.along_tangents * drag.slide;
  friction.couple -= share * stiffness.about_normal * drag.spin;
  const glm::dvec2 couple = share * stiffness.about_tangents * drag.roll;
  normal.force = std::max(normal.force + share * stiffness.along_normal * drag.deepened, 0.0);
  if (normal.force > 0.0) {
    contact.equivalent_point +=
        tangent_to_body(frame, glm::dvec2(couple.y, -couple.x) / normal.force);
  }
}

/// Displacement by the other regions at a point, m.
glm::dvec3 translation_by_others(const RegionSupport& support, const glm::dvec3& point) {
  return support.translation_by_others +
         glm::cross(support.rotation_by_others, point - support.about);
}

/// Stores what the next step's work is computed from.
void note_forces(const State& state, std::uint32_t region, PatchEnergy& energy) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const RegionNormal& normal = state.regions.at<RegionNormal>(region);
  const RegionFriction& friction = state.regions.at<RegionFriction>(region);
  const RegionSupport& support = state.regions.at<RegionSupport>(region);
  energy.depth = state.regions.at<Overlap>(region).largest_depth;
  energy.force = frame.normal * normal.force + tangent_to_body(frame, friction.force);
  energy.couple = frame.normal * friction.couple;
  energy.point = state.regions.at<Contact>(region).equivalent_point;
  energy.translation_by_others = translation_by_others(support, energy.point);
  energy.rotation_by_others = support.rotation_by_others;
}

/// The tool's motion over the material that the region holds. Where the material's motion is also
/// the body's motion under the region's own load, only the other regions' share of it carries the
/// material.
MotionOverBody motion_over_held(const State& state, std::uint32_t region, bool holds_body,
                                const PatchEnergy& before) {
  MotionOverBody motion = motion_over_body(state, region);
  if (holds_body) {
    const RegionSupport& support = state.regions.at<RegionSupport>(region);
    motion.carried_about = before.point;
    motion.carried_by = translation_by_others(support, before.point) - before.translation_by_others;
    motion.carried_turn = support.rotation_by_others - before.rotation_by_others;
  }
  return motion;
}

/// The holder's work over a step from the mean of the forces before and after, J. The normal force
/// is curved over the step: by Hertz, F ~ d^(3/2), the first correction of the trapezoidal rule is
/// F h^2 (d1 - d0) / (16 d^2), negligible in small steps.
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

/// While the tool lifts off, the force is reduced in the proportion of lent to held energy, so that
/// both reach zero together.
/// @param lifted  m, in this step
/// @param taken   N, in the step before
void take_back(const Model& model, State& state, std::uint32_t region, double lifted, double taken,
               PatchEnergy& energy) {
  RegionNormal& normal = state.regions.at<RegionNormal>(region);
  const double radius = state.regions.at<Contact>(region).radius;
  const double change =
      kMostCharge * stuck_stiffness(model, state, region, radius).along_normal * std::abs(lifted);
  const double share =
      lifted > 0.0 && energy.held > 0.0 ? std::min(energy.lent / energy.held, kMostLent) : 0.0;
  const double wanted = std::clamp(share * normal.force, taken - change, taken + change);
  // What was taken of a larger force goes down with it: friction has its limit by the pressures.
  energy.taken = std::min(wanted, kMostLent * normal.force);
  energy.lent = std::max(energy.lent - 0.5 * (taken + energy.taken) * lifted, 0.0);
  normal.force -= energy.taken;
}

/// The energy lowers the normal force below what the pressures make; Coulomb's law is to hold of
/// what is left, but for the drag.
void limit_friction(const Model& model, State& state, std::uint32_t region, PatchEnergy& energy) {
  const Friction& law = model.bodies.at<Friction>(state.regions.at<RegionIdentity>(region).body);
  const double most = (std::max(law.static_friction, law.dynamic_friction) + kMostDrag) *
                      state.regions.at<RegionNormal>(region).force;
  glm::dvec2& friction = state.regions.at<RegionFriction>(region).force;
  const double size = glm::length(friction);
  if (size > most) {
    const glm::dvec2 beyond = (1.0 - most / size) * friction;
    friction -= beyond;
    energy.force -= tangent_to_body(state.regions.at<RegionFrame>(region), beyond);
  }
}

}  // namespace

void settle_energy(const Model& model, State& state, std::uint32_t region,
                   const PatchSolution& solution, SolutionStart start) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const PatchEnergy before = state.regions.at<PatchEnergy>(region);
  const MotionOverBody motion =
      motion_over_held(state, region, solution.problem.support.response != nullptr, before);
  PatchEnergy now;
  note_forces(state, region, now);
  now.held = held_energy(solution, cell_area(frame, solution.problem.influences.side));
  now.lent = before.lent;
  const double grown = before.owed + now.held - before.held;
  double lacking = grown - work_between(before, now, motion, frame.normal);
  if (start == SolutionStart::kNone) {
    lacking = 0.0;
  } else if (start == SolutionStart::kOtherGrid) {
    now.lent += lacking;
    lacking = 0.0;
  } else if (lacking > 0.0) {
    charge(model, state, region, shift_after(motion, now.point), turn_of(motion), lacking);
    note_forces(state, region, now);
    lacking = grown - work_between(before, now, motion, frame.normal);
  }
  now.owed = std::max(lacking, 0.0);
  if (start == SolutionStart::kMovedGrid) {
    now.owed = std::min(now.owed, kMostOwed * now.held);
  }
  // What friction dissipates beyond that also repays what was lent.
  now.lent = std::max(now.lent + std::min(lacking, 0.0), 0.0);
  take_back(model, state, region, glm::dot(frame.normal, shift_after(motion, now.point)),
            before.taken, now);
  limit_friction(model, state, region, now);
  state.regions.at<PatchEnergy>(region) = now;
}

void split_energy(State& state, std::uint32_t from, std::uint32_t region, double share) {
  const PatchEnergy before = state.regions.at<PatchEnergy>(from);
  for (const std::uint32_t each : {from, region}) {
    const double part = each == region ? share : 1.0 - share;
    const RegionSupport& support = state.regions.at<RegionSupport>(each);
    PatchEnergy& energy = state.regions.at<PatchEnergy>(each);
    energy.held = part * before.held;
    energy.owed = part * before.owed;
    energy.lent = part * before.lent;
    energy.taken = part * before.taken;
    energy.depth = state.regions.at<Overlap>(each).largest_depth;
    energy.force = part * before.force;
    energy.couple = part * before.couple;
    energy.point = state.regions.at<Overlap>(each).center;
    energy.translation_by_others = translation_by_others(support, energy.point);
    energy.rotation_by_others = support.rotation_by_others;
  }
}

void retell_others(State& state, std::uint32_t region, const RegionSupport& before) {
  const RegionSupport& now = state.regions.at<RegionSupport>(region);
  PatchEnergy& energy = state.regions.at<PatchEnergy>(region);
  energy.translation_by_others +=
      translation_by_others(now, energy.point) - translation_by_others(before, energy.point);
  energy.rotation_by_others += now.rotation_by_others - before.rotation_by_others;
}

void join_energies(State& state, std::uint32_t ended_region, std::uint32_t heir_region) {
  const PatchEnergy& ended = state.regions.at<PatchEnergy>(ended_region);
  PatchEnergy& heir = state.regions.at<PatchEnergy>(heir_region);
  heir.held += ended.held;
  heir.owed += ended.owed;
  heir.lent += ended.lent;
  heir.taken += ended.taken;
  heir.force += ended.force;
  heir.couple += ended.couple + glm::cross(ended.point - heir.point, ended.force);
}

}  // namespace torsion::engine
