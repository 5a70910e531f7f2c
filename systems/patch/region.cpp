#include "systems/patch/region.hpp"

#include <algorithm>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/tool_motion.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/passes.hpp"

namespace torsion::engine {
namespace {

// A deflecting body takes more iterations: its motions have compliances of their own, which the
// local inverse does not contain.
constexpr std::uint32_t kSweepsOnSoftBody = 4;  // times the settings'
constexpr std::uint32_t kRoundsOnSoftBody = 3;  // at most: pressing moves it sideways, too
// What two iterations leave of the tractions the next steps do not always take. Where cells slip
// they led friction off by 1.2 % of its limit, however small the steps were
// (patch_mdr_invariance_test.cpp), and where a long contact slipped at its rims errors grew from
// step to step (long_contact_test.cpp). Most steps are settled after two.
constexpr std::uint32_t kTractionIterations = 8;
// Where the body as a whole deflects, the residuals of steps accumulate, most of all under an
// unsteady hand: with the usual tolerance, played-back recordings deviated by 7 %.
constexpr double kSettledOnBody = 0.01;  // PatchProblem::settled

/// mu beta: beta = (1 - 2 nu) / (2 (1 - nu)) is Dundurs' constant for a rigid tool (Johnson,
/// Contact Mechanics, 1985, 5.1).
double friction_feedback(const Friction& friction, const Elasticity& elasticity) {
  const double nu = elasticity.poisson_ratio;
  return std::max(friction.static_friction, friction.dynamic_friction) * (1.0 - 2.0 * nu) /
         (2.0 * (1.0 - nu));
}

/// The tool's motion over cells that stay in place, while RegionMotion's pivot moves with the tool.
RegionMotion motion_over_cells(const State& state, std::uint32_t region, const RegionFrame& frame) {
  RegionMotion motion = state.regions.at<RegionMotion>(region);
  const MotionOverBody over = motion_over_body(state, region);
  motion.slide +=
      glm::dvec2(body_to_grid_direction(frame, 0.5 * glm::cross(over.turn, over.shift)));
  return motion;
}

}  // namespace

Patch patch_of(StepContext& context, std::uint32_t region) {
  const Model& model = context.model;
  State& state = context.state;
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const Settings& settings = model.settings;
  const Elasticity& elasticity = model.bodies.at<Elasticity>(identity.body);
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const RegionInfluences influences = region_influences(model, state, region);
  if (influences.changed) {
    state.regions.at<PatchState>(region).moved = 1;
  }
  PatchProblem problem;
  problem.influences = influences.tables;
  problem.compliance = 2.0 * frame.half_size.x /
                       (static_cast<double>(settings.grid_side) * elasticity.shear_modulus());
  problem.coupled = influences.coupled;
  problem.feedback = friction_feedback(model.bodies.at<Friction>(identity.body), elasticity);
  const PatchPlaces& places = context.patch.places;
  cell_centers(frame, settings.grid_side, places.x, places.y);
  problem.support = patch_support(model, state, region, context.patch.disc_stiffness,
                                  {places.x, places.y}, context.patch.support_terms);
  problem.iterations = settings.iterations;
  if (problem.support.soft) {
    problem.iterations *= kSweepsOnSoftBody;
    problem.rounds = kRoundsOnSoftBody;
  } else {
    problem.traction_iterations = kTractionIterations;
  }
  if (problem.support.response != nullptr) {
    problem.settled = kSettledOnBody;
  }
  return {model,
          state,
          context.patch.columns,
          context.patch.places,
          context.patch.support,
          context.patch.work,
          region,
          settings.grid_side,
          frame,
          motion_over_cells(state, region, frame),
          patch_rows(state, identity.cells),
          state.regions.at<PatchState>(region),
          problem};
}

bool has_support(const Patch& patch) {
  return patch.problem.support.response != nullptr;
}

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
  const SupportPolynomials known = known_support(patch.state, patch.region);
  for (std::size_t k = 0; k < known.size(); ++k) {
    motion.polynomials[k] -= known[k];
  }
  add_polynomials(patch.problem.support, motion.polynomials, moved);
  return motion.energy;
}

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

}  // namespace torsion::engine
