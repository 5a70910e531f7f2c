#include "systems/mdr/round_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include "systems/contact/support/body_law.hpp"
#include "systems/half_space/elliptic_contact.hpp"
#include "systems/half_space/layer.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/linear_algebra.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

constexpr int kMoments = 15;  // of x^p y^q with p + q <= 4

/// Index of x^p y^q in the list of moments: by degree, then by q.
constexpr std::size_t moment(int p, int q) {
  const int degree = p + q;
  return static_cast<std::size_t>(degree * (degree + 1) / 2 + q);
}

/// Moments of the cells' places, in half grid sizes, and of their depths. Those for the paraboloid
/// have the weight weight_of; those of the area the share in contact; those of the middle that
/// share times the square of the depth.
struct PlaceMoments {
  std::array<double, kMoments> of_place{};
  std::array<double, 6> of_depth{};
  std::array<double, 6> of_area{};
  glm::dvec2 of_middle{0.0};
  double squares = 0.0;
};

double largest_depth(std::span<const CellGeometry> cells) {
  double most = 0.0;
  for (const CellGeometry& cell : cells) {
    most = cell.coverage > 0.0 ? std::max(most, cell.depth) : most;
  }
  return most;
}

/// Weight of a cell in contact, whose depth is `relative` of the largest. Rim cells, whose middles
/// may not touch, count little; but in a contact narrower than two cells they alone show how it
/// falls off across. Without them it would seem flat.
double weight_of(double relative) {
  constexpr double kRim = 0.01;
  const double deep = std::max(relative, 0.0);
  const double square = (2.0 - relative) * (2.0 - relative);
  return deep * deep + kRim / (square * square);
}

PlaceMoments add_cells(std::uint32_t side, std::span<const CellGeometry> cells, double largest) {
  PlaceMoments sums;
  const double step = 2.0 / static_cast<double>(side);
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    const double y = (static_cast<double>(j) + 0.5) * step - 1.0;
    // Moments of one row in x, to be multiplied by powers of y.
    std::array<double, 5> row{};
    std::array<double, 3> row_depth{};
    std::array<double, 3> row_area{};
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      double area = cells[cell].coverage;
      if (area <= 0.0) {
        continue;
      }
      const double depth = cells[cell].depth;
      const double x = (static_cast<double>(i) + 0.5) * step - 1.0;
      const double deep = std::max(depth, 0.0) / largest;
      sums.squares += area * deep * deep;
      sums.of_middle += area * deep * deep * glm::dvec2(x, y);
      double power = area * weight_of(depth / largest);
      for (std::size_t p = 0; p < row.size(); ++p) {
        row[p] += power;
        if (p < row_depth.size()) {
          row_depth[p] += power * depth;
          row_area[p] += area;
        }
        power *= x;
        area *= x;
      }
    }
    double power = 1.0;
    for (int q = 0; q <= 4; ++q) {
      for (int p = 0; p + q <= 4; ++p) {
        sums.of_place[moment(p, q)] += power * row[static_cast<std::size_t>(p)];
        if (p + q <= 2) {
          sums.of_depth[moment(p, q)] += power * row_depth[static_cast<std::size_t>(p)];
          sums.of_area[moment(p, q)] += power * row_area[static_cast<std::size_t>(p)];
        }
      }
      power *= y;
    }
  }
  return sums;
}

/// Coefficients of 1, x, y, x^2, x y, y^2.
Vector6 solve(const PlaceMoments& sums) {
  constexpr std::array<std::array<int, 2>, 6> kPowers{
      {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  Matrix6 matrix;
  Vector6 right;
  for (int a = 0; a < 6; ++a) {
    const auto& pa = kPowers[static_cast<std::size_t>(a)];
    right(a) = sums.of_depth[static_cast<std::size_t>(moment(pa[0], pa[1]))];
    for (int b = 0; b < 6; ++b) {
      const auto& pb = kPowers[static_cast<std::size_t>(b)];
      matrix(a, b) = sums.of_place[moment(pa[0] + pb[0], pa[1] + pb[1])];
    }
  }
  // Few cells, or cells in a line, leave some coefficients undetermined: those stay near zero.
  matrix.diagonal().array() += 1e-12 * matrix(0, 0);
  return solve_ldlt(matrix, right);
}

/// Depth over a place.
struct Paraboloid {
  double height = 0.0;        // m
  Eigen::Vector2d gradient;   // 1
  Eigen::Matrix2d curvature;  // 1/m

  [[nodiscard]] double at(const Eigen::Vector2d& place) const {
    return height + gradient.dot(place) - 0.5 * place.dot(curvature * place);
  }
};

/// The covered area's middle, m, and the variances of its place, m^2.
struct Area {
  Eigen::Vector2d center;
  Eigen::Matrix2d spread;
};

Area area_of(const PlaceMoments& sums, std::uint32_t side, const glm::dvec2& scale) {
  const auto mean = [&sums](int p, int q) {
    return sums.of_area[moment(p, q)] / sums.of_area[0];
  };
  // A cell's own second moment is a twelfth of its side's square.
  const double own = 1.0 / (3.0 * static_cast<double>(side) * static_cast<double>(side));
  const double mixed = mean(1, 1) * scale.x * scale.y;
  Area area;
  area.center = {mean(1, 0) * scale.x, mean(0, 1) * scale.y};
  area.spread << (mean(2, 0) + own) * scale.x * scale.x, mixed, mixed,
      (mean(0, 2) + own) * scale.y * scale.y;
  area.spread -= area.center * area.center.transpose();
  return area;
}

/// What the cells show along a principal axis of the paraboloid.
struct PrincipalAxis {
  Eigen::Vector2d direction;
  double known = 0.0;   // apex_share
  double top = 0.0;     // m: its apex, where known
  double extent = 0.0;  // m
};

/// How well the cells show the apex along a principal axis, 0 to 1. The depth of a whole paraboloid
/// falls by 2 bend spread = the depth of its apex from there to its rim. That of a flat contact,
/// which ends at an edge, does not fall, and gradient / bend would be arbitrary.
/// @param bend    1/m, curvature
/// @param spread  m^2, variance of the place over the area
double apex_share(double bend, double spread, double depth) {
  constexpr double kShown = 0.7;  // of the fall; a ball cut in the middle has 0.3 across the cut
  constexpr double kUnknown = 0.2;
  return smooth_step((2.0 * bend * spread / depth - kUnknown) / (kShown - kUnknown));
}

// How far the force of a tilted flat punch moves, over what the squares of the depth give. Flat and
// round: (2/3) a^2 over a^2 / 2 (Johnson, 1985, 3.5). For a cylinder between two edges the squares
// give 5/3 of Winkler's foundation; `patch` gives 1.3 of it where the contact is 10 times as long
// as wide, 1.4 where 5 times.
constexpr double kFlatStamp = 4.0 / 3.0;
constexpr double kCylinder = 0.8;

/// The apex of a paraboloid two cells wide is a quarter deeper than the nearest centres.
constexpr double kBetweenCells = 1.25;

}  // namespace

ContactShape fit_contact_shape(const RegionFrame& frame, std::uint32_t side,
                               std::span<const CellGeometry> cells) {
  ContactShape shape;
  const double largest = largest_depth(cells);
  if (largest <= 0.0) {
    return shape;
  }
  const PlaceMoments sums = add_cells(side, cells, largest);
  const Vector6 c = solve(sums);
  const glm::dvec2 scale = frame.half_size;
  // depth = c0 + g . x - x' K x / 2
  Paraboloid fit;
  fit.height = c(0);
  fit.gradient = {c(1) / scale.x, c(2) / scale.y};
  fit.curvature << -2.0 * c(3) / (scale.x * scale.x), -c(4) / (scale.x * scale.y),
      -c(4) / (scale.x * scale.y), -2.0 * c(5) / (scale.y * scale.y);
  const glm::dvec2 weighted = sums.of_middle / sums.squares * scale;
  const Eigen::Vector2d middle(weighted.x, weighted.y);
  const Area area = area_of(sums, side, scale);
  const double depth = std::max(fit.at(middle), 1e-300);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal;
  principal.computeDirect(fit.curvature);
  std::array<PrincipalAxis, 2> axes;
  for (int k = 0; k < 2; ++k) {
    PrincipalAxis& axis = axes[static_cast<std::size_t>(k)];
    axis.direction = principal.eigenvectors().col(k);
    const double spread = axis.direction.dot(area.spread * axis.direction);
    const double bend = std::max(principal.eigenvalues()(k), 0.0);
    axis.known = apex_share(bend, spread, depth);
    axis.extent = 2.0 * std::sqrt(std::max(spread, 0.0));
    const double center = axis.direction.dot(area.center);
    axis.top = axis.known > 0.0 ? std::clamp(axis.direction.dot(fit.gradient) / bend,
                                             center - axis.extent, center + axis.extent)
                                : 0.0;
  }
  Eigen::Vector2d apex = Eigen::Vector2d::Zero();
  Eigen::Vector2d deepest = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < 2; ++k) {
    const PrincipalAxis& axis = axes[k];
    const double center = axis.direction.dot(area.center);
    const double stamp = std::lerp(kFlatStamp, kCylinder, axes[1 - k].known);
    const double flat = center + stamp * (axis.direction.dot(middle) - center);
    apex += axis.direction * std::lerp(flat, axis.top, axis.known);
    deepest += axis.direction * std::lerp(center, axis.top, axis.known);
  }
  shape.extent_1 = axes[0].extent;
  shape.extent_2 = axes[1].extent;
  shape.curvature_1 = std::max(principal.eigenvalues()(0), 0.0);
  shape.curvature_2 = std::max(principal.eigenvalues()(1), 0.0);
  shape.apex = {apex.x(), apex.y()};
  // Where the cells show little (a thin contact lies across them) the paraboloid may do anything
  // outside of them, but its depth is limited to what may lie between two cells.
  shape.depth = std::min(fit.at(deepest), kBetweenCells * largest);
  return shape;
}

namespace {

using std::numbers::pi;

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
  if (shape.depth <= 0.0 || overlap.area <= 0.0) {
    return contact;
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
  const double axes = std::clamp(across / along, 0.01, 1.0);
  const EllipseShares shares = axes < 1.0 ? ellipse_shares(axes) : EllipseShares{};
  const double of_stamp = 2.0 * elasticity.contact_modulus() * contact.radius * shape.depth;
  contact.force = of_stamp * shares.force * (1.0 - round_share / 3.0);
  contact.pressure.flat_share = (1.0 - round_share) / (1.0 - round_share / 3.0);
  set_stiffnesses(axes, shares, round_share, elasticity.poisson_ratio, contact);
  return contact;
}

/// Mixes the two where the shapes determine only part of the contact.
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
