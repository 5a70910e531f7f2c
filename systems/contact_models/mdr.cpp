#include "systems/contact_models/mdr.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "systems/body_models/own_answer.hpp"
#include "systems/contact_models/friction_decay.hpp"
#include "systems/contact_models/mdr_layers.hpp"
#include "systems/contact_models/round_contact.hpp"
#include "systems/frames.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

using std::numbers::pi;

/// Pressure over its mean at r^2 = square * a^2.
double pressure_share(double square, double flat_share) {
  constexpr double kRim = 0.1;  // a flat punch's pressure has no limit at the rim
  const double root = std::sqrt(std::max(1.0 - square, 0.0));
  return (1.0 - flat_share) * 1.5 * root + flat_share * 0.5 / std::max(root, kRim);
}

/// Pressure and what sticks for those who draw it and count cells.
/// @param stick_radius  over the contact's
void set_cells(World& world, std::uint32_t region, const RoundContact& contact,
               double stick_radius) {
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  const auto cells = world.cells.rows<CellGeometry>(identity.cells);
  const auto tractions = world.cells.rows<CellTraction>(identity.cells);
  const double pressure =
      contact.radius > 0.0 ? contact.force / (pi * contact.radius * contact.radius) : 0.0;
  const double per_radius = 1.0 / std::max(contact.radius, 1e-300);
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      const glm::dvec2 arm = (cell_center(frame, side, i, j) - contact.center) * per_radius;
      const double square = glm::dot(arm, arm);
      const bool inside = cells[cell].coverage > 0.0 && square < 1.0;
      tractions[cell] = CellTraction{};
      tractions[cell].pressure =
          inside ? pressure * pressure_share(square, contact.pressure.flat_share) : 0.0;
      tractions[cell].coverage = inside ? 1.0 : 0.0;
      tractions[cell].sticks = inside && square < stick_radius * stick_radius ? 1U : 0U;
    }
  }
}

/// Motion of the tool over the body at the contact's centre.
glm::dvec2 slide_at(const RegionMotion& motion, const glm::dvec2& center) {
  const glm::dvec2 arm = center - motion.pivot;
  return motion.slide + motion.spin * glm::dvec2(-arm.y, arm.x);
}

/// What the layers are asked, of the motion since the last step.
MdrContact layers_contact(const World& world, std::uint32_t region, const RoundContact& round) {
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const RegionMotion& motion = world.regions.at<RegionMotion>(region);
  const Elasticity& elasticity = world.bodies.at<Elasticity>(identity.body);
  const Friction& friction = world.bodies.at<Friction>(identity.body);
  const double kinetic_share = world.regions.at<MdrState>(region).kinetic_share;
  MdrContact contact;
  contact.radius = round.radius;
  contact.force = round.force;
  contact.flat_share = round.pressure.flat_share;
  contact.friction = friction.static_friction +
                     kinetic_share * (friction.dynamic_friction - friction.static_friction);
  contact.shear_modulus = elasticity.shear_modulus();
  contact.poisson_ratio = elasticity.poisson_ratio;
  contact.slide_stiffness = round.slide_stiffness;
  contact.turn_stiffness = round.turn_stiffness;
  contact.torque_share = round.torque_share;
  contact.slide = slide_at(motion, round.center);
  contact.spin = motion.spin;
  return contact;
}

/// mu_s comes down to mu_d over a short slip and is back after as long an elastic path.
void move_friction(const MdrContact& contact, double slipped, double& kinetic_share) {
  const double stiffness = contact.slide_stiffness * 8.0 * contact.shear_modulus * contact.radius /
                           (2.0 - contact.poisson_ratio);
  const double inverse = inverse_of(contact.friction * contact.force / stiffness);
  const double path = glm::length(contact.slide) + std::abs(contact.spin) * contact.radius;
  kinetic_share += (1.0 - kinetic_share) * travelled(slipped, inverse / kSlipLength);
  kinetic_share *= 1.0 - travelled(std::max(path - slipped, 0.0), inverse);
}

/// The contact's middle on the body's rest surface, m, body.
glm::dvec3 middle_of(const World& world, std::uint32_t region, const RoundContact& round) {
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const double height = body_to_grid(frame, world.regions.at<RegionGeometry>(region).rest_point).z;
  return grid_to_body(frame, {round.center, height});
}

/// Where the contact is, for the systems after this one.
void set_geometry(World& world, std::uint32_t region, const RoundContact& round) {
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  RegionGeometry& geometry = world.regions.at<RegionGeometry>(region);
  geometry.rest_point = middle_of(world, region, round);
  geometry.equivalent_point = geometry.rest_point - frame.normal * round.depth;
  geometry.radius = round.radius;
  geometry.area = pi * round.radius * round.radius;
  geometry.mean_depth = round.depth;
}

/// A region's springs, as often as they are tried in a step.
struct Springs {
  const MdrTables& tables;
  MdrPressure pressure;  // of the last step
  double radius = 0.0;   // m
  std::array<MdrLayer, kMdrLayers> before;
  std::span<MdrLayer> layers;
};

/// Moves them from where they were before.
MdrForces move_springs(const Springs& springs, const RoundContact& round,
                       const MdrContact& contact) {
  std::ranges::copy(springs.before, springs.layers.begin());
  const MdrPlaces places = places_of(springs.tables, round.pressure);
  if (springs.radius != round.radius || springs.pressure != round.pressure) {
    resize_layers({places_of(springs.tables, springs.pressure), springs.radius},
                  {places, round.radius}, springs.layers);
  }
  return move_layers(places, springs.tables.limit_curve, contact, springs.layers);
}

/// What a contact and its springs come to in one step.
struct Outcome {
  RoundContact round;
  MdrContact contact;
  MdrForces forces;
};

/// Of the springs on the material: along x and y, N, and the couple over the radius.
glm::dvec3 spring_load(const MdrForces& forces, double radius) {
  return -glm::dvec3(forces.force, forces.couple / radius);
}

/// Stiffnesses of springs that all stick, with turns times the radius.
glm::dvec3 spring_stiffness(const MdrContact& contact) {
  const double slide = contact.slide_stiffness * 8.0 * contact.shear_modulus * contact.radius /
                       (2.0 - contact.poisson_ratio);
  const double turn = contact.turn_stiffness * 16.0 / 3.0 * contact.shear_modulus * contact.radius;
  return {slide, slide, turn};
}

/// The springs' motion x when the body gives way to their load l(x): x = free - C (l(x) - known),
/// by Broyden's method (Dennis and Schnabel, Numerical Methods for Unconstrained Optimization, 8),
/// from springs that go on as they did in the last step. All with turns times the radius.
/// @param compliance  C
/// @param free        the tool's motion over the material, without what the load adds to it
/// @param known       the load that is in it
/// @param last        load of the last step
/// @param outcome     its contact's slide and spin, and its forces, out
void move_in_balance(const Springs& springs, const glm::dmat3& compliance, const glm::dvec3& free,
                     const glm::dvec3& known, const glm::dvec3& last, Outcome& outcome) {
  constexpr int kMostTries = 8;
  constexpr double kClose = 0.03;  // of the motion
  const glm::dvec3 stiffness = spring_stiffness(outcome.contact);
  glm::dmat3 slope(1.0);
  for (int column = 0; column < 3; ++column) {
    slope[column] += compliance[column] * stiffness[column];
  }
  const double radius = outcome.round.radius;
  glm::dvec3 x = glm::inverse(slope) * (free - compliance * (last - known));
  glm::dvec3 way(0.0);
  glm::dvec3 lacking_before(0.0);
  for (int k = 0; k < kMostTries; ++k) {
    outcome.contact.slide = glm::dvec2(x);
    outcome.contact.spin = x.z / radius;
    outcome.forces = move_springs(springs, outcome.round, outcome.contact);
    const glm::dvec3 lacking =
        x - free + compliance * (spring_load(outcome.forces, radius) - known);
    if (glm::length(lacking) <= kClose * (glm::length(x) + glm::length(free))) {
      return;
    }
    if (k > 0) {
      const glm::dvec3 off = lacking - lacking_before - slope * way;
      slope += glm::outerProduct(off, way) / glm::dot(way, way);
    }
    way = -(glm::inverse(slope) * lacking);
    lacking_before = lacking;
    x += way;
  }
}

/// The contact and its springs when the body has given way to what they come to.
/// @param last  of the springs in the last step, N and N m, on the material
/// @return the loads beyond those that the body had given way to
ContactLoads settle(const World& world, std::uint32_t region, const Springs& springs,
                    const OwnAnswer& body, const glm::dvec3& last, Outcome& outcome) {
  constexpr int kMostPasses = 3;
  constexpr double kClose = 0.01;  // of the depth
  const double modulus =
      world.bodies.at<Elasticity>(world.regions.at<RegionIdentity>(region).body).contact_modulus();
  const RoundContact seen = outcome.round;
  const glm::dmat4& yields = body.compliance;
  const glm::dvec3 known(body.known);
  ContactLoads more(last - known, 0.0);
  double deeper = 0.0;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const double before = deeper;
    deeper = -(yields[0].w * more.x + yields[1].w * more.y + yields[2].w * more.z);
    if (pass > 0 && std::abs(deeper - before) <= kClose * outcome.round.depth) {
      break;
    }
    outcome.round = give_way({yields[3].w, body.known.w, deeper}, modulus, seen);
    outcome.contact = layers_contact(world, region, outcome.round);
    more.w = outcome.round.force - body.known.w;
    if (outcome.round.force <= 0.0) {
      break;
    }
    const glm::dvec3 turns(1.0, 1.0, outcome.round.radius);
    glm::dmat3 compliance(yields);
    for (int column = 0; column < 3; ++column) {
      compliance[column] *= turns[column] * turns;
    }
    const glm::dvec3 moved(outcome.contact.slide, outcome.contact.spin);
    move_in_balance(springs, compliance, turns * (moved - more.w * glm::dvec3(yields[3])),
                    known / turns, last / turns, outcome);
    const glm::dvec3 load = turns * spring_load(outcome.forces, outcome.round.radius);
    more = ContactLoads(load - known, more.w);
  }
  return more;
}

void move_region(StepContext& context, const MdrTables& tables, std::uint32_t region) {
  World& world = context.world;
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const Elasticity& elasticity = world.bodies.at<Elasticity>(identity.body);
  MdrState& state = world.regions.at<MdrState>(region);
  RegionNormal& normal = world.regions.at<RegionNormal>(region);
  RegionFriction& tangential = world.regions.at<RegionFriction>(region);
  const auto layers =
      world.mdr_layers.rows<MdrLayer>({block_of(identity) * kMdrLayers, kMdrLayers});
  Springs springs{tables, {state.flat_share, state.elongation}, state.radius, {}, layers};
  std::ranges::copy(layers, springs.before.begin());
  RegionSupport& support = world.regions.at<RegionSupport>(region);
  support.translation_step = support.rotation_step = glm::dvec3(0.0);  // region_motion has it
  Outcome outcome;
  outcome.round = round_contact(world, region);
  if (outcome.round.force > 0.0) {
    const OwnAnswer body = own_answer(world, region, middle_of(world, region, outcome.round));
    if (body.any) {
      const glm::dvec3 last = -glm::dvec3(tangential.force, tangential.couple);
      const ContactLoads more = settle(world, region, springs, body, last, outcome);
      const glm::dvec2 slide =
          slide_at(world.regions.at<RegionMotion>(region), outcome.round.center) -
          outcome.contact.slide;
      const double spin = world.regions.at<RegionMotion>(region).spin - outcome.contact.spin;
      if (outcome.round.force > 0.0) {
        move_by_own_answer(world, region, body, more, ContactLoads(slide, spin, 0.0));
      }
    } else {
      outcome.contact = layers_contact(world, region, outcome.round);
      outcome.forces = move_springs(springs, outcome.round, outcome.contact);
    }
  }
  const RoundContact& round = outcome.round;
  normal = RegionNormal{};
  tangential = RegionFriction{};
  if (round.force <= 0.0) {
    std::ranges::fill(layers, MdrLayer{});
    state = MdrState{};
    set_cells(world, region, round, 0.0);
    return;
  }
  state.radius = round.radius;
  state.flat_share = round.pressure.flat_share;
  state.elongation = round.pressure.elongation;
  move_friction(outcome.contact, outcome.forces.slipped, state.kinetic_share);
  const MdrForces& forces = outcome.forces;
  normal.force = round.force;
  normal.stiffness = 2.0 * elasticity.contact_modulus() * round.radius * round.slide_stiffness;
  tangential.force = forces.force;
  tangential.couple = forces.couple;
  tangential.stick_share = forces.stick_radius * forces.stick_radius;
  tangential.stick_radius = forces.stick_radius * round.radius;
  tangential.stick_turn = layers.back().turn;
  set_geometry(world, region, round);
  set_cells(world, region, round, forces.stick_radius);
}

}  // namespace

void mdr_forces(StepContext& context) {
  World& world = context.world;
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    const std::uint32_t body = world.regions.at<RegionIdentity>(region).body;
    if (world.bodies.at<BodyModels>(body).contact == ContactModel::kMdr) {
      move_region(context, context.scratch.mdr_tables, region);
    }
  }
}

}  // namespace torsion
