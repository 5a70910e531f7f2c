#include "systems/contact_models/patch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/contact_axes.hpp"
#include "systems/contact_models/friction_decay.hpp"
#include "systems/contact_models/patch_cells.hpp"
#include "systems/contact_models/patch_energy.hpp"
#include "systems/contact_models/patch_passes.hpp"
#include "systems/contact_models/region_influences.hpp"
#include "systems/frames.hpp"
#include "systems/grid_cells.hpp"
#include "systems/patch_grid.hpp"
#include "systems/region_motion.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

// Of a region that begins or whose grid moved, at most: sweeps of either, of both in all rounds and
// regions together, and rounds of pressures and tractions in turn. What is left to do then is done
// in the next steps, of which each has its own sweeps. Where there are more such regions in a step,
// or many others, they share out what there is, or the step would be long.
constexpr std::uint32_t kSweepsAnew = 8;
constexpr std::uint32_t kSweepsOfAll = 16;
constexpr std::uint32_t kSweepsOfStep = 24;  // with those of the other regions
constexpr std::uint32_t kRoundsAnew = 8;
constexpr double kSkipAnew = 1e-5;  // the residual that will do then
// Of the last step's change. Steps that end early must not foresee more: an error that a step's
// sweeps leave to the share r comes back as r (1 + s) and -r s of the last two, with s what is
// foreseen; the roots of x^2 = r (1 + s) x - r s are within 1 for every r < 1 only where s <= 1.
constexpr double kMostForesight = 1.0;
// A body that gives way takes more sweeps: its motions have compliances of their own, beside those
// that the local inverse knows.
constexpr std::uint32_t kSweepsOnSoftBody = 4;  // times the settings'
constexpr std::uint32_t kRoundsOnSoftBody = 3;  // at most: pressing moves it sideways, too
// Where the body as a whole gives way, what a step leaves undone builds up, under a hand that is
// not steady the more so: by ends as early as elsewhere, played-back recordings went 7 % astray.
constexpr double kSettledOnBody = 0.01;  // PatchProblem::settled

/// One region at work.
struct Patch {
  World& world;
  const PatchColumns& columns;
  const PatchPlaces& places;
  const SupportColumns& support;
  PatchWork& work;
  std::uint32_t region = 0;
  std::uint32_t side = 0;
  RegionFrame frame;
  RegionMotion motion;
  PatchRows rows;
  PatchState& state;
  PatchProblem problem;
};

/// As the tool goes over cells that stay where they are, while RegionMotion's pivot goes with it.
RegionMotion motion_over_cells(const World& world, std::uint32_t region, const RegionFrame& frame) {
  RegionMotion motion = world.regions.at<RegionMotion>(region);
  const MotionOverBody over = motion_over_body(world, region);
  motion.slide +=
      glm::dvec2(body_to_grid_direction(frame, 0.5 * glm::cross(over.turn, over.shift)));
  return motion;
}

Patch patch_of(StepContext& context, std::uint32_t region) {
  World& world = context.world;
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const Settings& settings = world.settings.at<Settings>(0);
  const Elasticity& elasticity = world.bodies.at<Elasticity>(identity.body);
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const RegionInfluences influences = region_influences(world, region);
  if (influences.changed) {
    world.regions.at<PatchState>(region).moved = 1;
  }
  PatchProblem problem;
  problem.influences = influences.tables;
  problem.compliance = 2.0 * frame.half_size.x /
                       (static_cast<double>(settings.grid_side) * elasticity.shear_modulus());
  problem.coupled = influences.coupled;
  const PatchPlaces& places = context.scratch.patch_places;
  cell_centers(frame, settings.grid_side, places.x, places.y);
  problem.support = patch_support(world, region, context.scratch.disc_stiffness,
                                  {places.x, places.y}, context.scratch.patch_support);
  problem.sweeps = settings.sweeps;
  if (problem.support.soft) {
    problem.sweeps *= kSweepsOnSoftBody;
    problem.rounds = kRoundsOnSoftBody;
  }
  if (problem.support.response != nullptr) {
    problem.settled = kSettledOnBody;
  }
  return {world,
          context.scratch.patch_columns,
          context.scratch.patch_places,
          context.scratch.support_columns,
          context.scratch.patch_work,
          region,
          settings.grid_side,
          frame,
          motion_over_cells(world, region, frame),
          patch_rows(world, identity.cells),
          world.regions.at<PatchState>(region),
          problem};
}

bool has_support(const Patch& patch) {
  return patch.problem.support.response != nullptr;
}

/// The motion of this step along that of the last one, as a share of it: 1 in steady motion, -1
/// where it turns back.
double share_of_last(const Patch& patch, double deepened) {
  const double radius = patch.world.regions.at<RegionGeometry>(patch.region).radius;
  const PatchState& last = patch.state;
  const double spin = last.spin * radius;
  const double square =
      glm::dot(last.slide, last.slide) + spin * spin + last.deepened * last.deepened;
  const double along = glm::dot(last.slide, patch.motion.slide) +
                       spin * patch.motion.spin * radius + last.deepened * deepened;
  return square > 0.0 ? std::clamp(along / square, -1.0, 1.0) : 0.0;
}

/// How much of the last step's change to expect again.
ForeseenShares foreseen_shares(const Patch& patch) {
  if (has_support(patch)) {
    const double share = std::clamp(patch.state.along_last, 0.0, kMostForesight);
    return {share, share};
  }
  return best_shares(patch.rows, patch.columns, patch.problem.coupled, kMostForesight);
}

/// The body's own motion at every cell beyond what the tool's overlap has of it already; zero where
/// it gives way as a half-space does.
/// @return the energy that it holds of its own motion, J
double find_support(const Patch& patch) {
  const PatchColumns& columns = patch.columns;
  const PatchField moved{patch.support.x, patch.support.y, patch.support.z};
  for (const std::span<double>& each : {moved.x, moved.y, moved.z}) {
    std::ranges::fill(each, 0.0);
  }
  if (!has_support(patch)) {
    return 0.0;
  }
  SupportMotion motion = support_by(
      patch.problem.support, {columns.traction_x, columns.traction_y, columns.pressure}, false);
  const SupportPolynomials known = known_support(patch.world, patch.region);
  for (std::size_t k = 0; k < known.size(); ++k) {
    motion.polynomials[k] -= known[k];
  }
  add_polynomials(patch.problem.support, motion.polynomials, moved);
  return motion.energy;
}

/// Adds it, `sign` times, to the half-space's displacements.
void add_motion_of_body(const Patch& patch, double sign) {
  const PatchColumns& columns = patch.columns;
  const auto add = [sign](std::span<const double> motion, std::span<double> to) {
    add_scaled(motion.size(), sign, motion.data(), to.data());
  };
  add(patch.support.x, columns.moved_x);
  add(patch.support.y, columns.moved_y);
  add(patch.support.x, columns.target_x);
  add(patch.support.y, columns.target_y);
  add(patch.support.z, columns.depression);
}

/// As a step solves whose pressures have far to go.
/// @param sweeps  at most
void solve_longer(Patch& patch, std::uint32_t sweeps) {
  const std::uint32_t least = patch.world.settings.at<Settings>(0).sweeps;
  patch.problem.sweeps = std::max(least, std::min(kSweepsAnew, sweeps));
  patch.problem.sweeps_of_rounds = std::max(least, sweeps);
  patch.problem.rounds = kRoundsAnew;
  patch.problem.skip = kSkipAnew;
  patch.problem.settled = 0.0;
}

/// After the grid has moved, or at a region's beginning: displacements of the tractions that are
/// there.
/// @param sweeps  at most
void start_anew(Patch& patch, std::uint32_t sweeps) {
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
  solve_longer(patch, sweeps);
}

/// A pressure to measure changes by: the mean of what is there, or what the depth will ask for.
double reference_pressure(const Patch& patch, double depth) {
  const double mean = mean_pressure(patch.columns);
  if (mean > 0.0) {
    return mean;
  }
  const double reach = std::max(patch.frame.half_size.x, patch.frame.half_size.y);
  return depth / (reach * patch.problem.compliance * static_cast<double>(patch.side)) * reach;
}

/// That of the disc of the loaded cells' area, m.
double contact_radius(const Patch& patch, const PatchSums& sums) {
  return std::sqrt(sums.loaded_cells * cell_area(patch.frame, patch.side) / std::numbers::pi);
}

/// Static friction gives way to dynamic with the path slipped, and comes back with the elastic
/// path.
/// @param radius  m, of the contact
void update_kinetic_shares(const Patch& patch, double force, double radius) {
  const RegionIdentity& identity = patch.world.regions.at<RegionIdentity>(patch.region);
  const Friction& friction = patch.world.bodies.at<Friction>(identity.body);
  if (friction.static_friction == friction.dynamic_friction) {
    return;
  }
  const Elasticity& elasticity = patch.world.bodies.at<Elasticity>(identity.body);
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

/// What the region's components become.
void summarize(const Patch& patch, const PatchSums& sums) {
  World& world = patch.world;
  RegionFriction& friction = world.regions.at<RegionFriction>(patch.region);
  RegionNormal& normal = world.regions.at<RegionNormal>(patch.region);
  RegionCarrier& carrier = world.regions.at<RegionCarrier>(patch.region);
  friction = RegionFriction{};
  normal = RegionNormal{};
  if (sums.force <= 0.0) {
    carrier = RegionCarrier{};
    return;
  }
  RegionGeometry& geometry = world.regions.at<RegionGeometry>(patch.region);
  const std::uint32_t body = world.regions.at<RegionIdentity>(patch.region).body;
  const glm::dvec3 center(sums.center, sums.height);
  const double cell = cell_area(patch.frame, patch.side);
  geometry.equivalent_point = grid_to_body(patch.frame, center);
  geometry.area = sums.loaded_cells * cell;
  geometry.radius = contact_radius(patch, sums);
  geometry.mean_depth = sums.depth;
  geometry.rest_point = geometry.equivalent_point + patch.frame.normal * geometry.mean_depth;
  normal.force = sums.force;
  normal.stiffness = 2.0 * world.bodies.at<Elasticity>(body).contact_modulus() * geometry.radius;
  friction.force = sums.friction;
  friction.couple = sums.couple - (center.x * sums.friction.y - center.y * sums.friction.x);
  friction.stick_share = sums.stuck_cells / sums.loaded_cells;
  friction.stick_radius = std::sqrt(sums.stuck_cells * cell / std::numbers::pi);
  friction.stick_turn = sums.turn;
  const double turn = friction.stick_turn;
  // About the grid's origin, which is not the pressure's centre.
  const glm::dvec2 turned(std::cos(turn) * center.x - std::sin(turn) * center.y,
                          std::sin(turn) * center.x + std::cos(turn) * center.y);
  const glm::dvec2 of_origin = sums.moved - (turned - sums.center);
  carrier.translation = tangent_to_body(patch.frame, of_origin);
  carrier.rotation = patch.frame.normal * turn;
}

/// While a region settles on a grid with other axes its displacements are found on other cells, and
/// differ a little from those before, as if the material had moved under the tool that has not:
/// fresh cells would come into contact that carry no traction, less traction would let the material
/// spring back farther, and so on. It is the grid that goes back by as much instead, to where the
/// material under it stands as it stood.
/// @param before  when the cells' depths were found
void keep_place(const Patch& patch, const RegionCarrier& before) {
  RegionFrame& frame = patch.world.regions.at<RegionFrame>(patch.region);
  RegionCarrier& carrier = patch.world.regions.at<RegionCarrier>(patch.region);
  turn_axes(frame, glm::dot(before.rotation - carrier.rotation, frame.normal));
  const glm::dvec3 shift = before.translation - carrier.translation;
  frame.origin += shift - frame.normal * glm::dot(shift, frame.normal);
}

/// True where the last step's displacements are no start.
bool is_anew(const PatchState& state) {
  return state.started == 0 || state.moved != 0;
}

SolutionStart start_of(const Patch& patch) {
  if (patch.state.started == 0) {
    return SolutionStart::kNone;
  }
  if (patch.state.resized != 0 || patch.problem.support.laid_anew) {
    return SolutionStart::kOtherGrid;
  }
  return patch.state.moved != 0 ? SolutionStart::kMovedGrid : SolutionStart::kLastStep;
}

/// @param sweeps_anew  at most, of one that is
void solve_region(StepContext& context, std::uint32_t region, std::uint32_t sweeps_anew) {
  const RegionCarrier carrier = context.world.regions.at<RegionCarrier>(region);
  Patch patch = patch_of(context, region);
  const bool anew = is_anew(patch.state);
  const std::uint32_t settling = patch.state.settling;
  const std::uint32_t body = patch.world.regions.at<RegionIdentity>(region).body;
  load_cells(patch.rows, patch.world.bodies.at<Friction>(body), patch.columns, patch.places);
  const double depth = largest(whole_lanes(patch.columns.depth.size()), patch.columns.depth.data());
  const double deepened = depth - patch.state.depth;
  patch.state.along_last = share_of_last(patch, deepened);
  if (anew) {
    foresee_cells(patch.rows, {}, patch.columns, patch.problem);
    start_anew(patch, sweeps_anew);
    set_targets(patch.motion, patch.places, patch.columns);
  } else {
    set_targets(patch.motion, patch.places, patch.columns);
    foresee_cells(patch.rows, foreseen_shares(patch), patch.columns, patch.problem);
    let_go_cells(patch.problem, patch.columns, patch.work, kNoContact);
    if (settling > 0) {
      solve_longer(patch, sweeps_anew);
    }
  }
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
  const PatchSums sums = sum_cells(patch.columns, patch.places, cell_area(patch.frame, patch.side));
  update_kinetic_shares(patch, sums.force, contact_radius(patch, sums));
  const std::span<const double> none;
  store_cells(patch.columns, has_support(patch) ? patch.support.x : none,
              has_support(patch) ? patch.support.y : none, patch.rows);
  if (start == SolutionStart::kNone) {
    const PatchChange& change = patch.rows.change;
    for (const std::span<double>& each : {change.traction_x, change.traction_y, change.pressure,
                                          change.moved_x, change.moved_y, change.depression}) {
      std::ranges::fill(each, 0.0);
    }
  }
  patch.state = {patch.motion.slide,
                 patch.motion.spin,
                 deepened,
                 patch.state.along_last,
                 depth,
                 outcome.residual,
                 outcome.sweeps,
                 1,
                 0,
                 0,
                 settling > 0 ? settling - 1 : 0,
                 0};
  summarize(patch, sums);
  settle_energy(patch.world, region,
                {patch.problem, patch.columns, patch.support.z, held_by_body, patch.work}, start);
  if (settling > 0 && sums.force > 0.0) {
    keep_place(patch, carrier);
  }
}

/// How many sweeps each of the regions that are anew gets in this step.
std::uint32_t sweeps_of_each_anew(const World& world) {
  std::uint32_t all = 0;
  std::uint32_t anew = 0;
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    if (has_patch(world, world.regions.at<RegionIdentity>(region))) {
      ++all;
      const PatchState& state = world.regions.at<PatchState>(region);
      anew += is_anew(state) || state.settling > 0 ? 1U : 0U;
    }
  }
  const std::uint32_t of_others = (all - anew) * world.settings.at<Settings>(0).sweeps;
  const std::uint32_t left = kSweepsOfStep - std::min(kSweepsOfStep, of_others);
  return std::min(kSweepsOfAll, left) / std::max(anew, 1U);
}

}  // namespace

void patch_forces(StepContext& context) {
  World& world = context.world;
  const std::uint32_t sweeps_anew = sweeps_of_each_anew(world);
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    if (has_patch(world, world.regions.at<RegionIdentity>(region))) {
      solve_region(context, region, sweeps_anew);
    }
  }
}

}  // namespace torsion
