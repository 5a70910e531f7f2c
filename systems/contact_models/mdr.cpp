#include "systems/contact_models/mdr.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/contact_models/contact_shape.hpp"
#include "systems/contact_models/elliptic_contact.hpp"
#include "systems/contact_models/friction_decay.hpp"
#include "systems/contact_models/layer_thickness.hpp"
#include "systems/contact_models/mdr_layers.hpp"
#include "systems/frames.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

using std::numbers::pi;

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

/// What does not depend on how the contact was found: stiffnesses of an ellipse that presses with
/// `round_share` of Hertz' pressure.
/// @param axes  b / a
void set_stiffnesses(double axes, const EllipseShares& shares, double round_share,
                     double poisson_ratio, RoundContact& contact) {
  contact.pressure.elongation = round_share * (1.0 - axes);
  contact.slide_stiffness = shares.force;
  contact.turn_stiffness = axes < 1.0 ? bonded_turn_share(axes, poisson_ratio) : 1.0;
  contact.torque_share = shares.torque;
}

/// Of shapes that are known: Hertz' ellipse, and as much less as their surfaces part beyond the
/// paraboloid. A round profile r^2 / (2 R) + c r^4 has g = x^2 / R + (8/3) c x^4, and so
/// F = 2 E* (d a - a^3 / (3 R) - (8/15) c a^5) with g(a) = d (Popov & Hess, 2015, ch. 3); its
/// r^4 term here is the mean over the ellipse's rim.
RoundContact contact_of_shapes(const SmoothContact& smooth, const Elasticity& elasticity) {
  RoundContact contact;
  if (smooth.depth <= 0.0) {
    return contact;
  }
  const double depth = smooth.depth;
  const EllipticContact ellipse = elliptic_contact(depth, smooth.curvature_1, smooth.curvature_2);
  const double paraboloid = std::sqrt(ellipse.major * ellipse.minor);
  // In units of that radius and of the depth: g = x^2 + quartic x^4 with g = 1 at the edge, where
  // x^2 / R alone made 1, so that `beyond` r^2 / (2 R) at r = 1 is `beyond` / 2.
  const double quartic = std::max(4.0 / 3.0 * smooth.beyond, -0.2);
  const double square = 2.0 / (1.0 + std::sqrt(1.0 + 4.0 * quartic));
  const double radius = std::sqrt(square);
  contact.center = smooth.place;
  contact.depth = depth;
  contact.radius = radius * paraboloid;
  contact.force = 2.0 * elasticity.contact_modulus() * paraboloid * depth * radius *
                  (1.0 - square / 3.0 - 0.2 * quartic * square * square) * ellipse.shares.force;
  set_stiffnesses(ellipse.minor / ellipse.major, ellipse.shares, 1.0, elasticity.poisson_ratio,
                  contact);
  return contact;
}

/// From the cells: a paraboloid's contact. Where the overlap ends before the contact's own edge
/// would be, it ends there, and the rest of the depth presses like a flat stamp: a half-space gives
/// way to a stamp by d at 2 E* a d, to a ball at (4/3) E* a d, and to a cylinder between two edges
/// in between.
RoundContact contact_of_cells(const World& world, std::uint32_t region,
                              const Elasticity& elasticity) {
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const RegionGeometry& geometry = world.regions.at<RegionGeometry>(region);
  const ContactShape shape = fit_contact_shape(world.regions.at<RegionFrame>(region),
                                               world.settings.at<Settings>(0).grid_side,
                                               world.cells.rows<CellGeometry>(identity.cells));
  RoundContact contact;
  if (shape.depth <= 0.0 || geometry.area <= 0.0) {
    return contact;
  }
  contact.center = shape.apex;
  contact.depth = shape.depth;
  const double overlap = std::sqrt(geometry.area / pi);
  // No paraboloid so flat that its contact would reach beyond the overlap.
  const double least_1 = shape.depth / (shape.extent_1 * shape.extent_1);
  const double least_2 = shape.depth / (shape.extent_2 * shape.extent_2);
  const double bend_1 = std::max(shape.curvature_1, least_1);
  const double bend_2 = std::max(shape.curvature_2, least_2);
  const EllipticContact ellipse = elliptic_contact(shape.depth, bend_1, bend_2);
  const double along = std::min(ellipse.major, bend_1 < bend_2 ? shape.extent_1 : shape.extent_2);
  const double across = std::min(ellipse.minor, bend_1 < bend_2 ? shape.extent_2 : shape.extent_1);
  contact.radius = std::min(std::sqrt(along * across), overlap);
  // How much of each axis' curvature is the shapes' own.
  const double round_share = 0.5 * (shape.curvature_1 / bend_1 + shape.curvature_2 / bend_2);
  const double axes = std::clamp(across / along, 0.01, 1.0);
  const EllipseShares shares = axes < 1.0 ? ellipse_shares(axes) : EllipseShares{};
  const double of_stamp = 2.0 * elasticity.contact_modulus() * contact.radius * shape.depth;
  contact.force = of_stamp * shares.force * (1.0 - round_share / 3.0);
  contact.pressure.flat_share = (1.0 - round_share) / (1.0 - round_share / 3.0);
  set_stiffnesses(axes, shares, round_share, elasticity.poisson_ratio, contact);
  return contact;
}

/// Between the two, where the shapes say only part of it.
RoundContact mix(const RoundContact& cells, const RoundContact& shapes, double share) {
  RoundContact contact;
  contact.center = glm::mix(cells.center, shapes.center, share);
  contact.radius = std::lerp(cells.radius, shapes.radius, share);
  contact.depth = std::lerp(cells.depth, shapes.depth, share);
  contact.force = std::lerp(cells.force, shapes.force, share);
  contact.pressure.flat_share =
      std::lerp(cells.pressure.flat_share, shapes.pressure.flat_share, share);
  contact.pressure.elongation =
      std::lerp(cells.pressure.elongation, shapes.pressure.elongation, share);
  contact.slide_stiffness = std::lerp(cells.slide_stiffness, shapes.slide_stiffness, share);
  contact.turn_stiffness = std::lerp(cells.turn_stiffness, shapes.turn_stiffness, share);
  contact.torque_share = std::lerp(cells.torque_share, shapes.torque_share, share);
  return contact;
}

RoundContact contact_of(const World& world, std::uint32_t region) {
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const Elasticity& elasticity = world.bodies.at<Elasticity>(identity.body);
  const SmoothContact& smooth = world.regions.at<SmoothContact>(region);
  RoundContact contact;
  if (smooth.share < 1.0) {
    contact = contact_of_cells(world, region, elasticity);
  }
  if (smooth.share > 0.0) {
    contact = mix(contact, contact_of_shapes(smooth, elasticity), smooth.share);
  }
  // A body model in series has the body's thickness itself.
  const bool in_series = world.bodies.at<BodyModels>(identity.body).body == BodyModel::kCompliance;
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const double thickness =
      in_series ? 0.0
                : layer_thickness(world, identity.body, frame.normal,
                                  world.regions.at<RegionGeometry>(region).rest_point);
  if (thickness > 0.0) {
    contact.force *= layer_force_share(contact.radius / thickness, elasticity.poisson_ratio);
  }
  return contact;
}

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

/// Where the contact is, for the systems after this one.
void set_geometry(World& world, std::uint32_t region, const RoundContact& round) {
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  RegionGeometry& geometry = world.regions.at<RegionGeometry>(region);
  const double height = body_to_grid(frame, geometry.rest_point).z;
  geometry.rest_point = grid_to_body(frame, {round.center, height});
  geometry.equivalent_point = geometry.rest_point - frame.normal * round.depth;
  geometry.radius = round.radius;
  geometry.area = pi * round.radius * round.radius;
  geometry.mean_depth = round.depth;
}

void move_region(StepContext& context, const MdrTables& tables, std::uint32_t region) {
  World& world = context.world;
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const Elasticity& elasticity = world.bodies.at<Elasticity>(identity.body);
  MdrState& state = world.regions.at<MdrState>(region);
  RegionNormal& normal = world.regions.at<RegionNormal>(region);
  RegionFriction& tangential = world.regions.at<RegionFriction>(region);
  const RoundContact round = contact_of(world, region);
  const std::uint32_t block = block_of(identity);
  const auto layers = world.mdr_layers.rows<MdrLayer>({block * kMdrLayers, kMdrLayers});
  normal = RegionNormal{};
  tangential = RegionFriction{};
  if (round.force <= 0.0) {
    std::ranges::fill(layers, MdrLayer{});
    state = MdrState{};
    set_cells(world, region, round, 0.0);
    return;
  }
  const MdrContact contact = layers_contact(world, region, round);
  const MdrPlaces places = places_of(tables, round.pressure);
  const MdrPressure pressure_before{state.flat_share, state.elongation};
  if (state.radius != round.radius || pressure_before != round.pressure) {
    resize_layers({places_of(tables, pressure_before), state.radius}, {places, round.radius},
                  layers);
  }
  const MdrForces forces = move_layers(places, tables.limit_curve, contact, layers);
  state.radius = round.radius;
  state.flat_share = round.pressure.flat_share;
  state.elongation = round.pressure.elongation;
  move_friction(contact, forces.slipped, state.kinetic_share);

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

double layer_force_share(double chi, double poisson_ratio) {
  const double nu = poisson_ratio;
  const double x = std::clamp(chi, 0.0, 0.5);
  const double a = -(1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1.0 - nu);
  const double b = (0.6387 - 1.0277 * nu + 1.5164 * nu * nu) / (1.0 - nu);
  const double t = 2.0 / pi * x;
  const double cube = a * a * a;
  return 1.0 - a * t + a * a * t * t - (cube + 4.0 * pi * pi / 15.0 * b) * t * t * t -
         a * (cube + 0.6 * pi * pi * b) * t * t * t * t;
}

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
