// The contact model `winkler`: a bed of independent springs, with Coulomb friction smoothed over a
// small velocity. Engines for games and robots use it for soft contacts (hydroelastic contact:
// Elandt, Drumwright, Sherman and Ruina, IROS 2019; friction: Drake's Stribeck model). Here it is a
// yardstick: its largest couple under a ball is 8/15 mu F a. It has no springs that stick: a
// contact at rest has no tangential force.

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/contact/law.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

constexpr double kStiction = 1e-3;  // m/s: the least velocity with all of the static friction

/// Pressure over depth, Pa/m. The pressure reaches E at half the body's smallest side.
double bed_stiffness(const Model& model, std::uint32_t body) {
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const glm::dvec3 side = bounds.highest - bounds.lowest;
  return model.bodies.at<Elasticity>(body).youngs_modulus /
         (0.5 * std::min({side.x, side.y, side.z}));
}

/// The coefficient of friction at a velocity over kStiction: rises to the static one at 1, falls to
/// the dynamic one at 3.
double coefficient_at(const Friction& friction, double velocity) {
  const double falling = smooth_step(0.5 * (velocity - 1.0));
  return smooth_step(velocity) *
         glm::mix(friction.static_friction, friction.dynamic_friction, falling);
}

/// Sums over a region's cells, in the grid's frame.
struct BedSums {
  double force = 0.0;        // N, along the normal
  double area = 0.0;         // m^2
  glm::dvec3 center{0.0};    // N m: pressures times their places
  glm::dvec2 friction{0.0};  // N, on the tool
  double couple = 0.0;       // N m, about the grid's origin
};

BedSums press_bed(const Model& model, State& state, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const RegionMotion& motion = state.regions.at<RegionMotion>(region);
  const Friction& friction = model.bodies.at<Friction>(identity.body);
  const std::uint32_t side = model.settings.grid_side;
  const double stiffness = bed_stiffness(model, identity.body);
  const double to_velocity = 1.0 / (model.dt * kStiction);
  const auto cells = state.cells.rows<CellGeometry>(identity.cells);
  const auto tractions = state.cells.rows<CellTraction>(identity.cells);
  BedSums sums;
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      CellTraction& traction = tractions[cell];
      traction = CellTraction{};
      if (cells[cell].coverage <= 0.0 || cells[cell].depth <= 0.0) {
        continue;
      }
      const glm::dvec2 place = cell_center(frame, side, i, j);
      const glm::dvec2 arm = place - motion.pivot;
      const glm::dvec2 slide = motion.slide + motion.spin * glm::dvec2(-arm.y, arm.x);
      const double way = glm::length(slide);
      traction.pressure = stiffness * cells[cell].depth;
      traction.coverage = cells[cell].coverage;
      if (way > 0.0) {
        const double limit = coefficient_at(friction, way * to_velocity) * traction.pressure;
        traction.traction = -limit / way * slide;
      }
      const double area = traction.coverage * cell_area(frame, side);
      sums.area += area;
      sums.force += area * traction.pressure;
      sums.center += area * traction.pressure * glm::dvec3(place, cells[cell].height);
      sums.friction += area * traction.traction;
      sums.couple += area * (place.x * traction.traction.y - place.y * traction.traction.x);
    }
  }
  return sums;
}

void solve_region(const Model& model, State& state, std::uint32_t region) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const BedSums sums = press_bed(model, state, region);
  RegionNormal& normal = state.regions.at<RegionNormal>(region);
  RegionFriction& friction = state.regions.at<RegionFriction>(region);
  Contact& contact = state.regions.at<Contact>(region);
  contact = contact_of(state.regions.at<Overlap>(region));
  normal = RegionNormal{};
  friction = RegionFriction{};
  if (sums.force <= 0.0) {
    return;
  }
  const glm::dvec3 center = sums.center / sums.force;
  contact.equivalent_point = grid_to_body(frame, center);
  contact.rest_point = contact.equivalent_point + frame.normal * contact.depth;
  const std::uint32_t body = state.regions.at<RegionIdentity>(region).body;
  normal = {sums.force, bed_stiffness(model, body) * sums.area};
  friction.force = sums.friction;
  friction.couple = sums.couple - (center.x * sums.friction.y - center.y * sums.friction.x);
}

void winkler_forces(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const std::uint32_t body = state.regions.at<RegionIdentity>(region).body;
    if (model.bodies.at<BodyModels>(body).contact == ContactModel::kWinkler) {
      solve_region(model, state, region);
    }
  }
}

constexpr System<StepContext> kWinklerSolve[] = {
    {"winkler_forces", "a bed of springs with friction smooth over a velocity",
     "a body with contact model winkler", any_with<ContactModel::kWinkler>, winkler_forces,
     columns<CellTraction, RegionNormal, RegionFriction, Contact>()},
};

}  // namespace

const ContactLaw kWinklerLaw{
    .model = ContactModel::kWinkler,
    .answers_from = std::numeric_limits<double>::infinity(),
    .is_of_whole_body = true,
    .solve = kWinklerSolve,
    .follow = follow_overlap,
    .find_cells = find_overlap,
};

}  // namespace torsion::engine
