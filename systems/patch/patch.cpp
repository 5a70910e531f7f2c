// The contact model `patch`: each region is a piece of an elastic half-space under a grid of cells,
// with pressure and Coulomb friction solved together (docs/models.md).

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/stick_slip.hpp"
#include "systems/contact/tool_motion.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/cell_sums.hpp"
#include "systems/patch/cells.hpp"
#include "systems/patch/energy.hpp"
#include "systems/patch/grid.hpp"
#include "systems/patch/passes.hpp"
#include "systems/patch/region.hpp"

namespace torsion::engine {
namespace {

// Most iterations for a region that begins or whose grid has moved: for the pressures or the
// tractions of one round; of all rounds and all such regions together; and the same beside other
// regions. Regions share the total, so that no step gets long. The remaining residual is reduced in
// the next steps.
constexpr std::uint32_t kIterationsAnew = 8;
constexpr std::uint32_t kIterationsOfAll = 16;
constexpr std::uint32_t kIterationsOfStep = 24;
constexpr std::uint32_t kRoundsAnew = 8;  // of pressures and tractions in turn
constexpr double kSkipAnew = 1e-5;        // largest change, relative, that ends them
// Largest share of the last step's change by which a solution is extrapolated. With s that share
// and r the part of an error that a step's iterations leave, the errors e of successive steps
// follow e_n = r (1 + s) e_(n-1) - r s e_(n-2), which decays for every r < 1 only if s <= 1.
constexpr double kMostExtrapolation = 1.0;
// A contact rolls if the tool tilts so much in a step that the depth at the contact's rim changes
// by more than kRolls of the mean depth: new material comes in, of which the last solution knows
// nothing. With two iterations a step the friction of rolling with spin was off by 2.3 % of the
// largest, with eight, and with more, by 0.8 % (patch_steady_rolling_test.cpp).
constexpr std::uint32_t kIterationsOfRolling = 8;  // at most
constexpr double kRolls = 2e-3;
// Share of the depth by which a contact deepens in a step that takes as many: what it grows by is
// new, too.
constexpr double kDeepens = 0.05;

/// Component of this step's motion along the last one's, divided by the last one's size: 1 in
/// steady motion, -1 where it turns back.
double share_of_last(const Patch& patch, double deepened) {
  const double radius = patch.state.regions.at<Overlap>(patch.region).radius;
  const PatchState& last = patch.own;
  const double spin = last.spin * radius;
  const double square =
      glm::dot(last.slide, last.slide) + spin * spin + last.deepened * last.deepened;
  const double along = glm::dot(last.slide, patch.motion.slide) +
                       spin * patch.motion.spin * radius + last.deepened * deepened;
  return square > 0.0 ? std::clamp(along / square, -1.0, 1.0) : 0.0;
}

/// The share of the last step's change by which the solution is extrapolated.
ExtrapolationShares extrapolation_shares(const Patch& patch) {
  if (has_support(patch)) {
    const double share = std::clamp(patch.own.along_last, 0.0, kMostExtrapolation);
    return {share, share};
  }
  return best_shares(patch.rows, patch.columns, patch.problem.coupled, kMostExtrapolation);
}

/// Whether the contact rolls in this step (kRolls).
bool rolls(const Patch& patch) {
  const Overlap& overlap = patch.state.regions.at<Overlap>(patch.region);
  const glm::dvec3 turn = turn_of(motion_over_body(patch.state, patch.region));
  const glm::dvec3 tilt = turn - patch.frame.normal * glm::dot(turn, patch.frame.normal);
  return glm::length(tilt) * overlap.radius > kRolls * overlap.mean_depth;
}

/// Solves with the iterations of a solution that is far from converged.
/// @param iterations  at most
void solve_longer(Patch& patch, std::uint32_t iterations) {
  const std::uint32_t least = patch.model.settings.iterations;
  patch.problem.iterations = std::max(least, std::min(kIterationsAnew, iterations));
  patch.problem.iterations_of_rounds = std::max(least, iterations);
  patch.problem.traction_iterations = 0;
  patch.problem.rounds = kRoundsAnew;
  patch.problem.skip = kSkipAnew;
  patch.problem.settled = 0.0;
}

/// Begins a solution after the grid has moved or at a region's beginning: finds the displacements
/// of the present tractions.
/// @param iterations  at most
void start_anew(Patch& patch, std::uint32_t iterations) {
  const PatchColumns& columns = patch.columns;
  for (std::size_t cell = 0; cell < patch.rows.tractions.size(); ++cell) {
    if (columns.pressure[cell] <= 0.0 || columns.depth[cell] == kNoContact) {
      columns.pressure[cell] = 0.0;
      columns.traction_x[cell] = 0.0;
      columns.traction_y[cell] = 0.0;
    }
  }
  displace_patch(patch.problem, columns, patch.work);
  const PatchSurface& surface = patch.rows.surface;
  std::ranges::copy(columns.moved_x, surface.moved_x.begin());
  std::ranges::copy(columns.moved_y, surface.moved_y.begin());
  std::ranges::copy(columns.depression, surface.depression.begin());
  for (std::size_t cell = 0; cell < patch.rows.tractions.size(); ++cell) {
    if (surface.known[cell] == 0.0) {
      patch.places.from_x[cell] = columns.moved_x[cell];
      patch.places.from_y[cell] = columns.moved_y[cell];
    }
    patch.rows.tractions[cell].pressure = columns.pressure[cell];
    patch.rows.tractions[cell].traction =
        -glm::dvec2(columns.traction_x[cell], columns.traction_y[cell]);
  }
  solve_longer(patch, iterations);
}

/// A typical pressure, to which changes are compared: the mean, or, where there is none yet, the
/// pressure that the depth will need.
double reference_pressure(const Patch& patch, double depth) {
  const double mean = mean_pressure(patch.columns);
  if (mean > 0.0) {
    return mean;
  }
  const double reach = std::max(patch.frame.half_size.x, patch.frame.half_size.y);
  return depth / (reach * patch.problem.compliance * static_cast<double>(patch.side)) * reach;
}

/// Radius of the disc with the loaded cells' area, m.
double contact_radius(const Patch& patch, const PatchSums& sums) {
  return std::sqrt(sums.loaded_cells * cell_area(patch.frame, patch.side) / std::numbers::pi);
}

/// Static friction falls to dynamic friction with the path slipped, and recovers with the elastic
/// path.
/// @param radius  m, of the contact
void update_kinetic_shares(const Patch& patch, double force, double radius) {
  const RegionIdentity& identity = patch.state.regions.at<RegionIdentity>(patch.region);
  const Friction& friction = patch.model.bodies.at<Friction>(identity.body);
  if (friction.static_friction == friction.dynamic_friction) {
    return;
  }
  const Elasticity& elasticity = patch.model.bodies.at<Elasticity>(identity.body);
  // Displacement of a disc at its friction limit: stiffness 8 G a / (2 - nu).
  const double stiffness =
      8.0 * elasticity.shear_modulus() * radius / (2.0 - elasticity.poisson_ratio);
  const double inverse =
      inverse_of(stiffness > 0.0 ? friction.static_friction * force / stiffness : 0.0);
  const PatchColumns& columns = patch.columns;
  for (std::size_t cell = 0; cell < patch.rows.tractions.size(); ++cell) {
    double& share = patch.rows.tractions[cell].kinetic_share;
    const glm::dvec2 moved(columns.moved_x[cell], columns.moved_y[cell]);
    if (columns.pressure[cell] <= 0.0) {
      share = 0.0;
    } else if (columns.slips[cell] != 0.0) {
      const glm::dvec2 target(columns.target_x[cell], columns.target_y[cell]);
      share += (1.0 - share) * travelled(glm::distance(target, moved), inverse / kSlipLength);
    } else if (share > 0.0) {
      const glm::dvec2 was(patch.rows.surface.moved_x[cell], patch.rows.surface.moved_y[cell]);
      share *= 1.0 - travelled(glm::distance(moved, was), inverse);
    }
  }
}

/// Writes the region's components.
void summarize(const Patch& patch, const PatchSums& sums) {
  const Model& model = patch.model;
  State& state = patch.state;
  RegionFriction& friction = state.regions.at<RegionFriction>(patch.region);
  RegionNormal& normal = state.regions.at<RegionNormal>(patch.region);
  RegionCarrier& carrier = state.regions.at<RegionCarrier>(patch.region);
  Contact& contact = state.regions.at<Contact>(patch.region);
  friction = RegionFriction{};
  normal = RegionNormal{};
  contact = contact_of(state.regions.at<Overlap>(patch.region));
  if (sums.force <= 0.0) {
    carrier = RegionCarrier{};
    return;
  }
  const std::uint32_t body = state.regions.at<RegionIdentity>(patch.region).body;
  const glm::dvec3 center(sums.center, sums.height);
  const double cell = cell_area(patch.frame, patch.side);
  contact.equivalent_point = grid_to_body(patch.frame, center);
  contact.area = sums.loaded_cells * cell;
  contact.radius = contact_radius(patch, sums);
  contact.depth = sums.depth;
  contact.rest_point = contact.equivalent_point + patch.frame.normal * contact.depth;
  normal.force = sums.force;
  normal.stiffness = 2.0 * model.bodies.at<Elasticity>(body).contact_modulus() * contact.radius;
  friction.force = sums.friction;
  friction.couple = sums.couple - (center.x * sums.friction.y - center.y * sums.friction.x);
  friction.stick_share = sums.stuck_cells / sums.loaded_cells;
  friction.stick_radius = std::sqrt(sums.stuck_cells * cell / std::numbers::pi);
  friction.stick_turn = sums.turn;
  const double turn = friction.stick_turn;
  // As a rotation about the contact's middle, so that the place of the grid's origin does not
  // matter. The middle is not the centre of pressure: the grid would follow that, and the contact's
  // rim, moving over the cells, would move the centre in turn.
  const glm::dvec2 about = sums.middle;
  const glm::dvec2 from_center = about - sums.center;
  const glm::dvec2 moved = sums.moved + turn * glm::dvec2(-from_center.y, from_center.x);
  const glm::dvec2 turned(std::cos(turn) * about.x - std::sin(turn) * about.y,
                          std::sin(turn) * about.x + std::cos(turn) * about.y);
  const glm::dvec2 of_origin = moved - (turned - about);
  carrier.translation = tangent_to_body(patch.frame, of_origin);
  carrier.rotation = patch.frame.normal * turn;
}

/// While a region settles on a grid with other axes, its displacements are found on other cells and
/// differ a little from those before, as if the material had moved under a tool at rest. Newly
/// covered cells, without traction, would reduce the traction, the material would spring back
/// farther, and so on. Instead the grid moves back by the difference, to where the material under
/// it was.
/// @param before  when the cells' depths were found
void keep_place(const Patch& patch, const RegionCarrier& before) {
  RegionFrame& frame = patch.state.regions.at<RegionFrame>(patch.region);
  RegionCarrier& carrier = patch.state.regions.at<RegionCarrier>(patch.region);
  turn_axes(frame, glm::dot(before.rotation - carrier.rotation, frame.normal));
  const glm::dvec3 shift = before.translation - carrier.translation;
  frame.origin += shift - frame.normal * glm::dot(shift, frame.normal);
}

/// True where the last step's displacements can't be started from.
bool is_anew(const PatchState& state) {
  return state.started == 0 || state.moved != 0;
}

SolutionStart start_of(const Patch& patch) {
  if (patch.own.started == 0) {
    return SolutionStart::kNone;
  }
  if (patch.own.resized != 0 || patch.problem.support.refitted) {
    return SolutionStart::kOtherGrid;
  }
  return patch.own.moved != 0 ? SolutionStart::kMovedGrid : SolutionStart::kLastStep;
}

/// How many iterations a region gets in this step at most.
struct IterationLimits {
  std::uint32_t anew = 0;  // one that is_anew or settles
  std::uint32_t of_rolling = 0;
};

/// Where this step's solution starts, and how many iterations it may take.
/// @param deepened  m, in this step
void begin_solution(Patch& patch, double deepened, const IterationLimits& iterations) {
  if (is_anew(patch.own)) {
    extrapolate_cells(patch.rows, {}, patch.columns, patch.problem);
    start_anew(patch, iterations.anew);
    set_targets(patch.motion, patch.places, patch.columns);
    return;
  }
  set_targets(patch.motion, patch.places, patch.columns);
  extrapolate_cells(patch.rows, extrapolation_shares(patch), patch.columns, patch.problem);
  release_cells(patch.problem, patch.columns, patch.work, kNoContact);
  if (patch.own.settling > 0) {
    solve_longer(patch, iterations.anew);
  } else if (rolls(patch) || deepened > kDeepens * patch.own.depth) {
    patch.problem.iterations = std::max(patch.problem.iterations, iterations.of_rolling);
  }
}

/// The first solution is not a change that the next step could extrapolate.
void forget_change(const PatchChange& change) {
  for (const std::span<double>& each : {change.traction_x, change.traction_y, change.pressure,
                                        change.moved_x, change.moved_y, change.depression}) {
    std::ranges::fill(each, 0.0);
  }
}

void solve_region(StepContext& context, std::uint32_t region, const IterationLimits& iterations) {
  const RegionCarrier carrier = context.state.regions.at<RegionCarrier>(region);
  Patch patch = patch_of(context, region);
  const std::uint32_t settling = patch.own.settling;
  const std::uint32_t body = patch.state.regions.at<RegionIdentity>(region).body;
  if (load_cells(patch.rows, patch.model.bodies.at<Friction>(body), patch.columns, patch.places)) {
    patch.problem.rims = {patch.places.softness, patch.places.root};
  }
  add_rims(patch.problem, patch.columns, patch.rows, 1.0);
  find_starts(patch.rows, patch.places);
  const double depth = largest(whole_lanes(patch.columns.depth.size()), patch.columns.depth.data());
  const double deepened = depth - patch.own.depth;
  patch.own.along_last = share_of_last(patch, deepened);
  begin_solution(patch, deepened, iterations);
  if (has_support(patch)) {
    find_support(patch);
    take_off_support(patch.rows.surface.known, patch.support.x, patch.support.y, patch.columns);
    add_motion_of_body(patch, 1.0);
  }
  patch.problem.reference = reference_pressure(patch, depth);
  const PatchOutcome outcome = solve_patch(patch.problem, patch.columns, patch.work);
  const double held_by_body = find_support(patch);
  if (has_support(patch)) {
    add_motion_of_body(patch, -1.0);
  }
  const SolutionStart start = start_of(patch);
  const PatchSums sums = sum_cells(patch.columns, patch.places, cell_area(patch.frame, patch.side),
                                   patch.problem.reference);
  update_kinetic_shares(patch, sums.force, contact_radius(patch, sums));
  const std::span<const double> none;
  store_cells(patch.columns, has_support(patch) ? patch.support.x : none,
              has_support(patch) ? patch.support.y : none, patch.rows);
  if (start == SolutionStart::kNone) {
    forget_change(patch.rows.change);
  }
  patch.own = {.slide = patch.motion.slide,
               .spin = patch.motion.spin,
               .deepened = deepened,
               .along_last = patch.own.along_last,
               .depth = depth,
               .residual = outcome.residual,
               .iterations = outcome.iterations,
               .started = 1,
               .settling = settling > 0 ? settling - 1 : 0,
               .grown = patch.own.grown};
  summarize(patch, sums);
  settle_energy(patch.model, patch.state, region,
                {patch.problem, patch.columns, patch.support.z, held_by_body, patch.work}, start);
  add_rims(patch.problem, patch.columns, patch.rows, -1.0);
  if (settling > 0 && sums.force > 0.0) {
    keep_place(patch, carrier);
  }
}

bool is_patch(const Model& model, const State& state, std::uint32_t region) {
  const std::uint32_t body = state.regions.at<RegionIdentity>(region).body;
  return model.bodies.at<BodyModels>(body).contact == ContactModel::kPatch;
}

IterationLimits iteration_limits(const Model& model, const State& state) {
  std::uint32_t all = 0;
  std::uint32_t anew = 0;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    if (is_patch(model, state, region)) {
      ++all;
      const PatchState& own = state.regions.at<PatchState>(region);
      anew += is_anew(own) || own.settling > 0 ? 1U : 0U;
    }
  }
  const std::uint32_t of_others = (all - anew) * model.settings.iterations;
  const std::uint32_t left = kIterationsOfStep - std::min(kIterationsOfStep, of_others);
  return {std::min(kIterationsOfAll, left) / std::max(anew, 1U),
          std::min(kIterationsOfRolling, kIterationsOfStep / std::max(all, 1U))};
}

void forget_cells(const Model& model, State& state, std::uint32_t block) {
  const std::uint32_t side = model.settings.grid_side;
  state.patch_cells.zero({block * side * side, side * side});
}

/// Pressures, tractions, forces and couple of every region of a body with this model.
void patch_forces(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  const IterationLimits iterations = iteration_limits(model, state);
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    if (is_patch(model, state, region)) {
      solve_region(context, region, iterations);
    }
  }
}

constexpr ColumnSet kPatchWrites =
    columns<PatchState, PatchEnergy, LayerGrid, Influence, SupportResponse, RegionCarrier,
            CellTraction, RegionNormal, RegionFriction, Contact>();
constexpr System<StepContext> kPatchSolve[] = {
    {"patch_forces", "elastic half-space cell by cell: pressure, friction and torque",
     "a body with contact model patch", any_with<ContactModel::kPatch>, patch_forces,
     kPatchWrites | table_columns<PatchCellTable>(), columns<RegionFrame>()},
};

}  // namespace

const ContactLaw kPatchLaw{
    .model = ContactModel::kPatch,
    .by_cells = true,
    .answers_from = 0.5,
    .keeps = KeptColumns::kSurfaceCells,
    .solve = kPatchSolve,
    .follow = follow_patch,
    .find_cells = find_patch_cells,
    .half_size = tabulated_half_size,
    .spare_columns = patch_spare,
    .begin = forget_cells,
    .split = copy_patch,
    .share_out = share_out_patch,
    .join = join_patch,
    .end = join_energies,
};

}  // namespace torsion::engine
