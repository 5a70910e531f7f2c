#include "systems/mdr/round_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

#include "systems/contact/support/body_law.hpp"
#include "systems/half_space/elliptic_contact.hpp"
#include "systems/half_space/layer.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

// Root mean square of what a paraboloid leaves of the depth, over that: up to here the contact is
// one; from there on it is not. A cone or an edge leaves 0.08, the corner of a box 0.13.
constexpr double kFits = 0.035;
constexpr double kUnlike = 0.06;

// How far its force may be from that of the overlap's area and mean depth, which of all shapes from
// a flat punch to a cone is within 10 %. Farther apart are paraboloids with their apex beyond the
// overlap's edge, of which nothing but the side is seen, and those as curved one way as the other,
// whose axes may lie anywhere, in an overlap that is longer than wide.
constexpr double kTogether = 0.15;
constexpr double kApart = 0.35;

/// The part that does not depend on how the contact was found: stiffnesses of an ellipse that
/// presses with `round_share` of Hertz' pressure.
/// @param axes  b / a
void set_stiffnesses(double axes, const EllipseShares& shares, double round_share,
                     double poisson_ratio, RoundContact& contact) {
  contact.pressure.elongation = round_share * (1.0 - axes);
  contact.slide_stiffness = shares.force;
  contact.turn_stiffness = axes < 1.0 ? bonded_turn_share(axes, poisson_ratio) : 1.0;
  contact.torque_share = shares.torque;
}

/// For known shapes: Hertz' ellipse, less what their surfaces lie beyond the paraboloid. A round
/// profile r^2 / (2 R) + c r^4 has g = x^2 / R + (8/3) c x^4, and so F = 2 E* (d a - a^3 / (3 R) -
/// (8/15) c a^5) with g(a) = d (Popov & Hess, 2015, ch. 3); its r^4 term here is the mean over the
/// ellipse's rim.
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

/// Mixes two ways of knowing a contact.
/// @param share  of `other`
RoundContact mix(const RoundContact& one, const RoundContact& other, double share) {
  RoundContact contact;
  contact.center = glm::mix(one.center, other.center, share);
  contact.radius = std::lerp(one.radius, other.radius, share);
  contact.depth = std::lerp(one.depth, other.depth, share);
  contact.force = std::lerp(one.force, other.force, share);
  contact.pressure.flat_share =
      std::lerp(one.pressure.flat_share, other.pressure.flat_share, share);
  contact.pressure.elongation =
      std::lerp(one.pressure.elongation, other.pressure.elongation, share);
  contact.slide_stiffness = std::lerp(one.slide_stiffness, other.slide_stiffness, share);
  contact.turn_stiffness = std::lerp(one.turn_stiffness, other.turn_stiffness, share);
  contact.torque_share = std::lerp(one.torque_share, other.torque_share, share);
  return contact;
}

/// Force, pressure and stiffnesses of a contact of known radius and depth, between a flat punch's
/// and a paraboloid's.
/// @param ratio        b / a, taken as at least 1 : 100
/// @param round_share  of the depth that falls off as a paraboloid's, 0 to 1
void press(double ratio, double round_share, const Elasticity& elasticity, RoundContact& contact) {
  const double axes = std::clamp(ratio, 0.01, 1.0);
  const EllipseShares shares = axes < 1.0 ? ellipse_shares(axes) : EllipseShares{};
  const double of_stamp = 2.0 * elasticity.contact_modulus() * contact.radius * contact.depth;
  contact.force = of_stamp * shares.force * (1.0 - round_share / 3.0);
  contact.pressure.flat_share = (1.0 - round_share) / (1.0 - round_share / 3.0);
  set_stiffnesses(axes, shares, round_share, elasticity.poisson_ratio, contact);
}

/// From the overlap's area A and mean depth alone, for shapes that no paraboloid fits: edges and
/// corners. All of the family from a flat punch (peak p = 0) to a paraboloid (p = 1) have a mean of
/// (1 - p / 2) of their depth and a contact of A / (1 + p), and their force at equal area and mean
/// depth differs by 10 %.
RoundContact contact_of_volume(const ContactShape& shape, const Overlap& overlap,
                               const Elasticity& elasticity) {
  RoundContact contact;
  contact.center = shape.stamp;
  // The overlap's has what lies between the middles, too, by the slope there: worth 10 % where it
  // is two cells wide. Where a face lies along the body it can be all of it, and wrong.
  constexpr double kMostBetween = 1.1;
  const double mean = std::min(overlap.mean_depth, kMostBetween * shape.mean_depth);
  contact.depth = mean / (1.0 - 0.5 * shape.peak);
  contact.radius = std::sqrt(overlap.area / (pi * (1.0 + shape.peak)));
  press(shape.axes, shape.peak, elasticity, contact);
  return contact;
}

/// From the cells: the contact of a paraboloid. Where the overlap ends before the paraboloid's
/// contact would, the contact ends there, and the rest of the depth presses like a flat punch: a
/// half-space resists a flat punch with 2 E* a d, a ball with (4/3) E* a d, and a cylinder between
/// two edges with a force between these.
RoundContact contact_of_cells(const Model& model, const State& state, std::uint32_t region,
                              const Elasticity& elasticity) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const Overlap& overlap = state.regions.at<Overlap>(region);
  const ContactShape shape =
      fit_contact_shape(state.regions.at<RegionFrame>(region), model.settings.grid_side,
                        state.cells.rows<CellGeometry>(identity.cells));
  RoundContact contact;
  if (shape.mean_depth <= 0.0 || overlap.area <= 0.0) {
    return contact;
  }
  if (shape.depth <= 0.0) {
    return contact_of_volume(shape, overlap, elasticity);
  }
  contact.center = shape.apex;
  contact.depth = shape.depth;
  const double radius_of_area = std::sqrt(overlap.area / pi);
  // No paraboloid so flat that its contact would be larger than the overlap.
  const double least_1 = shape.depth / (shape.extent_1 * shape.extent_1);
  const double least_2 = shape.depth / (shape.extent_2 * shape.extent_2);
  const double bend_1 = std::max(shape.curvature_1, least_1);
  const double bend_2 = std::max(shape.curvature_2, least_2);
  const EllipticContact ellipse = elliptic_contact(shape.depth, bend_1, bend_2);
  const double along = std::min(ellipse.major, bend_1 < bend_2 ? shape.extent_1 : shape.extent_2);
  const double across = std::min(ellipse.minor, bend_1 < bend_2 ? shape.extent_2 : shape.extent_1);
  contact.radius = std::min(std::sqrt(along * across), radius_of_area);
  // How much of each axis' curvature comes from the shapes.
  const double round_share = 0.5 * (shape.curvature_1 / bend_1 + shape.curvature_2 / bend_2);
  press(across / along, round_share, elasticity, contact);
  const RoundContact volume = contact_of_volume(shape, overlap, elasticity);
  const double apart = std::abs(contact.force / volume.force - 1.0);
  const double unlike = std::max(smooth_step((shape.misfit - kFits) / (kUnlike - kFits)),
                                 smooth_step((apart - kTogether) / (kApart - kTogether)));
  return unlike > 0.0 ? mix(contact, volume, unlike) : contact;
}

}  // namespace

RoundContact round_contact(const Model& model, const State& state, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const Elasticity& elasticity = model.bodies.at<Elasticity>(identity.body);
  const SmoothContact& smooth = state.regions.at<SmoothContact>(region);
  RoundContact contact;
  if (smooth.share < 1.0) {
    contact = contact_of_cells(model, state, region, elasticity);
  }
  if (smooth.share > 0.0) {
    contact = mix(contact, contact_of_shapes(smooth, elasticity), smooth.share);
  }
  // A body model in series already has the thickness of the body.
  const bool in_series = body_law_of(model, identity.body).moves_as_a_whole;
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const double thickness = in_series
                               ? 0.0
                               : layer_thickness(model, identity.body, frame.normal,
                                                 state.regions.at<Overlap>(region).rest_center);
  if (thickness > 0.0) {
    contact.force *= layer_force_share(contact.radius / thickness, elasticity.poisson_ratio);
  }
  return contact;
}

double normal_slope(const RoundContact& contact, double modulus) {
  return 2.0 * modulus * contact.radius * contact.slide_stiffness;
}

RoundContact pressed_to(double depth, double modulus, RoundContact contact) {
  const double power =
      std::clamp(normal_slope(contact, modulus) * contact.depth / contact.force, 1.0, 2.0);
  const double share = depth / contact.depth;
  const double wider = std::pow(share, power - 1.0);
  contact.depth = depth;
  contact.force *= share * wider;
  contact.radius *= wider;
  return contact;
}

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

}  // namespace torsion::engine
