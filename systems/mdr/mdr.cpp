// The contact model `mdr`: each region is a round, or nearly round, contact of an elastic
// half-space (docs/models.md).

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "systems/contact/law.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/stick_slip.hpp"
#include "systems/contact/support/contact_load.hpp"
#include "systems/math/frames.hpp"
#include "systems/mdr/layers.hpp"
#include "systems/mdr/round_contact.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

/// Pressure over its mean at r^2 = square * a^2.
double pressure_share(double square, double flat_share) {
  constexpr double kRim = 0.1;  // a flat punch's pressure has no limit at the rim
  const double root = std::sqrt(std::max(1.0 - square, 0.0));
  return (1.0 - flat_share) * 1.5 * root + flat_share * 0.5 / std::max(root, kRim);
}

/// Pressure and stick state of the cells, for pictures and for those who count cells.
/// @param stick_radius  over the contact's
void set_cells(const Model& model, State& state, std::uint32_t region, const RoundContact& contact,
               double stick_radius) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const std::uint32_t side = model.settings.grid_side;
  const auto cells = state.cells.rows<CellGeometry>(identity.cells);
  const auto tractions = state.cells.rows<CellTraction>(identity.cells);
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

/// The input of the layers: the motion since the last step.
MdrContact layers_contact(const Model& model, const State& state, std::uint32_t region,
                          const RoundContact& round) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const RegionMotion& motion = state.regions.at<RegionMotion>(region);
  const Elasticity& elasticity = model.bodies.at<Elasticity>(identity.body);
  const Friction& friction = model.bodies.at<Friction>(identity.body);
  const double kinetic_share = state.regions.at<MdrState>(region).kinetic_share;
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

/// The stiffness when all springs stick, N/m.
double slide_stiffness(const MdrContact& contact) {
  return contact.slide_stiffness * 8.0 * contact.shear_modulus * contact.radius /
         (2.0 - contact.poisson_ratio);
}

/// mu_s falls to mu_d over a short slip, and recovers over an equally long elastic path.
void move_friction(const MdrContact& contact, double slipped, double& kinetic_share) {
  const double inverse = inverse_of(contact.friction * contact.force / slide_stiffness(contact));
  const double path = glm::length(contact.slide) + std::abs(contact.spin) * contact.radius;
  kinetic_share += (1.0 - kinetic_share) * travelled(slipped, inverse / kSlipLength);
  kinetic_share *= 1.0 - travelled(std::max(path - slipped, 0.0), inverse);
}

/// The contact's middle on the body's rest surface, m, body.
glm::dvec3 middle_of(const State& state, std::uint32_t region, const RoundContact& round) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const double height = body_to_grid(frame, state.regions.at<Overlap>(region).rest_center).z;
  return grid_to_body(frame, {round.center, height});
}

/// Writes the contact's place and size for the systems after this one.
void set_contact(State& state, std::uint32_t region, const RoundContact& round) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  Contact& contact = state.regions.at<Contact>(region);
  contact.rest_point = middle_of(state, region, round);
  contact.equivalent_point = contact.rest_point - frame.normal * round.depth;
  contact.radius = round.radius;
  contact.area = pi * round.radius * round.radius;
  contact.depth = round.depth;
}

/// A region's springs, tried several times in a step.
struct Springs {
  const MdrTables& tables;
  MdrPressure pressure;  // of the last step
  double radius = 0.0;   // m
  std::array<MdrLayer, kMdrLayers> before;
  std::span<MdrLayer> layers;
};

/// Moves the springs from the state before the step.
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

/// The contact and its springs in one step.
struct Outcome {
  RoundContact round;
  MdrContact contact;
  MdrForces forces;
  SupportAnswer answer;
};

/// Stiffnesses of springs that all stick and of the contact along its normal. Turns are multiplied
/// by the radius.
glm::dvec4 stiffness_of(const Outcome& outcome, double modulus) {
  const MdrContact& contact = outcome.contact;
  const double slide = slide_stiffness(contact);
  const double turn = contact.turn_stiffness * 16.0 / 3.0 * contact.shear_modulus * contact.radius;
  return {slide, slide, turn, normal_slope(outcome.round, modulus)};
}

/// A contact on a body that deflects, and the motion imposed on it.
struct Balance {
  const Model& model;
  const State& state;
  std::uint32_t region;
  const Springs& springs;
  RoundContact seen;  // when the body has not deflected in this step
  double modulus;     // E*, Pa
  glm::dvec4 turns;   // 1, 1, its radius, 1

  /// The loads on the material (the couple over the radius) when the springs have moved and the
  /// contact has this depth.
  /// @param motion  along x and y, turning times the radius, and the depth, m
  ContactLoads load_at(const glm::dvec4& motion, Outcome& outcome) const {
    outcome.round = pressed_to(motion.w, modulus, seen);
    outcome.contact = layers_contact(model, state, region, outcome.round);
    outcome.contact.slide = glm::dvec2(motion);
    outcome.contact.spin = motion.z / turns.z;
    outcome.forces = move_springs(springs, outcome.round, outcome.contact);
    return {-outcome.forces.force, -outcome.forces.couple / turns.z, outcome.round.force};
  }
};

/// Springs and depth when the body deflects under their loads l: z = free - C (l(z) - known), by
/// Broyden's method (Dennis and Schnabel, Numerical Methods for Unconstrained Optimization, 8),
/// which begins with springs that all stick.
/// @param last  of the springs in the last step, N and N m, on the material
/// @return the loads beyond those under which the body had deflected
ContactLoads settle(const Balance& balance, const OwnAnswer& body, const glm::dvec3& last,
                    Outcome& outcome) {
  constexpr int kMostTries = 8;
  constexpr double kClose = 0.03;      // of the springs' motion
  constexpr double kClosePart = 1e-3;  // of how far they go until all slips
  constexpr double kCloseDepth = 3e-3;
  constexpr double kLeastDepth = 1e-3;  // of that seen: what parts does so in the next step
  const RoundContact& seen = balance.seen;
  const glm::dvec4& turns = balance.turns;
  const ContactLoads known = body.known / turns;
  glm::dmat4 compliance = body.compliance;
  for (int column = 0; column < 4; ++column) {
    compliance[column] *= turns[column] * turns;
  }
  outcome.contact = layers_contact(balance.model, balance.state, balance.region, seen);
  const glm::dvec4 free =
      turns * glm::dvec4(outcome.contact.slide, outcome.contact.spin, seen.depth);
  const glm::dvec4 stiffness = stiffness_of(outcome, balance.modulus);
  const double slips = outcome.contact.friction * seen.force / stiffness.x;
  glm::dmat4 slope(1.0);
  for (int column = 0; column < 4; ++column) {
    slope[column] += compliance[column] * stiffness[column];
  }
  const ContactLoads at_rest = ContactLoads(last, seen.force) / turns;
  glm::dvec4 at(0.0, 0.0, 0.0, seen.depth);
  glm::dvec4 way = glm::inverse(slope) * (free - at - compliance * (at_rest - known));
  glm::dvec4 before(0.0);
  ContactLoads load(0.0);
  for (int k = 0; k < kMostTries; ++k) {
    const glm::dvec4 from = at;
    at += way;
    at.w = std::max(at.w, kLeastDepth * seen.depth);
    way = at - from;
    load = balance.load_at(at, outcome);
    const glm::dvec4 lacking = at - free + compliance * (load - known);
    const double moved = glm::length(glm::dvec3(at));
    if (glm::length(glm::dvec3(lacking)) <= kClose * moved + kClosePart * slips &&
        std::abs(lacking.w) <= kCloseDepth * at.w) {
      break;
    }
    if (way == glm::dvec4(0.0)) {
      break;  // it parts, and nothing else moves
    }
    if (k > 0) {
      slope += glm::outerProduct(lacking - before - slope * way, way) / glm::dot(way, way);
    }
    before = lacking;
    way = -(glm::inverse(slope) * lacking);
  }
  return turns * (load - known);
}

/// The contact and its springs in this step, with the body's reaction where that is known.
Outcome find_outcome(const Model& model, const State& state, std::uint32_t region,
                     const Springs& springs) {
  Outcome outcome;
  outcome.round = round_contact(model, state, region);
  if (outcome.round.force <= 0.0) {
    return outcome;
  }
  const OwnAnswer body = own_answer(model, state, region, middle_of(state, region, outcome.round));
  if (!body.any) {
    outcome.contact = layers_contact(model, state, region, outcome.round);
    outcome.forces = move_springs(springs, outcome.round, outcome.contact);
    return outcome;
  }
  const double modulus =
      model.bodies.at<Elasticity>(state.regions.at<RegionIdentity>(region).body).contact_modulus();
  const Balance balance{
      model, state, region, springs, outcome.round, modulus, {1.0, 1.0, outcome.round.radius, 1.0}};
  const RegionFriction& friction = state.regions.at<RegionFriction>(region);
  const ContactLoads more =
      settle(balance, body, -glm::dvec3(friction.force, friction.couple), outcome);
  const RegionMotion& motion = state.regions.at<RegionMotion>(region);
  const glm::dvec2 slide = slide_at(motion, outcome.round.center) - outcome.contact.slide;
  outcome.answer = support_answer(model, state, region, body, more,
                                  ContactLoads(slide, motion.spin - outcome.contact.spin, 0.0));
  return outcome;
}

std::span<MdrLayer> layers_of(State& state, std::uint32_t block) {
  return state.mdr_layers.rows<MdrLayer>({block * kMdrLayers, kMdrLayers});
}

void move_region(StepContext& context, const MdrTables& tables, std::uint32_t region) {
  const Model& model = context.model;
  State& state = context.state;
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  MdrState& own = state.regions.at<MdrState>(region);
  RegionNormal& normal = state.regions.at<RegionNormal>(region);
  RegionFriction& tangential = state.regions.at<RegionFriction>(region);
  const std::span<MdrLayer> layers = layers_of(state, block_of(identity));
  Springs springs{tables, {own.flat_share, own.elongation}, own.radius, {}, layers};
  std::ranges::copy(layers, springs.before.begin());
  const Outcome outcome = find_outcome(model, state, region, springs);
  context.scratch.support_answers[block_of(identity)] = outcome.answer;
  const RoundContact& round = outcome.round;
  const MdrForces& forces = outcome.forces;
  state.regions.at<Contact>(region) = contact_of(state.regions.at<Overlap>(region));
  normal = RegionNormal{};
  tangential = RegionFriction{};
  if (round.force <= 0.0) {
    std::ranges::fill(layers, MdrLayer{});
    own = MdrState{};
    set_cells(model, state, region, round, 0.0);
    return;
  }
  own.radius = round.radius;
  own.flat_share = round.pressure.flat_share;
  own.elongation = round.pressure.elongation;
  move_friction(outcome.contact, forces.slipped, own.kinetic_share);
  normal.force = round.force;
  normal.stiffness =
      normal_slope(round, model.bodies.at<Elasticity>(identity.body).contact_modulus());
  tangential.force = forces.force;
  tangential.couple = forces.couple;
  tangential.stick_share = forces.stick_radius * forces.stick_radius;
  tangential.stick_radius = forces.stick_radius * round.radius;
  tangential.stick_turn = layers.back().turn;
  set_contact(state, region, round);
  set_cells(model, state, region, round, forces.stick_radius);
}

void forget_layers(const Model& /*model*/, State& state, std::uint32_t block) {
  std::ranges::fill(layers_of(state, block), MdrLayer{});
}

void turn_layers(State& state, std::uint32_t region, const glm::dmat2& back) {
  for (MdrLayer& layer : layers_of(state, block_of(state.regions.at<RegionIdentity>(region)))) {
    layer.shift = back * layer.shift;
  }
}

/// Normal force, friction and couple of every region of a body with this model.
void mdr_forces(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const std::uint32_t body = state.regions.at<RegionIdentity>(region).body;
    if (model.bodies.at<BodyModels>(body).contact == ContactModel::kMdr) {
      move_region(context, context.mdr, region);
    }
  }
}

constexpr System<StepContext> kMdrSolve[] = {
    {"mdr_forces", "round contacts of an elastic half-space: force, friction and torque",
     "a body with contact model mdr", any_with<ContactModel::kMdr>, mdr_forces,
     columns<MdrLayer, MdrState, CellTraction, RegionNormal, RegionFriction, Contact>()},
};

}  // namespace

// The springs are axisymmetric: they need no grid that turns with the sticking material.
const ContactLaw kMdrLaw{
    .model = ContactModel::kMdr,
    .moves_own_support = true,
    .answers_from = 0.5,
    .keeps = KeptColumns::kSpringLayers,
    .grid_side = 12,
    .solve = kMdrSolve,
    .follow = follow_overlap,
    .find_cells = find_overlap,
    .refine = refine_overlap,
    .turn = turn_layers,
    .begin = forget_layers,
};

}  // namespace torsion::engine
