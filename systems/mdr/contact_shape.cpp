#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <glm/vec2.hpp>

#include "systems/math/linear_algebra.hpp"
#include "systems/math/smooth_step.hpp"
#include "systems/mdr/round_contact.hpp"

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
  double depths = 0.0;            // of the largest depth
  double squares = 0.0;           // of its square
  double weighted_squares = 0.0;  // m^2: of the depth, with weight_of
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
      sums.depths += area * deep;
      sums.squares += area * deep * deep;
      sums.of_middle += area * deep * deep * glm::dvec2(x, y);
      double power = area * weight_of(depth / largest);
      sums.weighted_squares += power * depth * depth;
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
/// @param misfit  out: root mean square of what they leave of the depth, over that of the depth
Vector6 solve(const PlaceMoments& sums, double& misfit) {
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
  Vector6 coefficients = solve_ldlt(matrix, right);
  misfit = std::sqrt(std::max(1.0 - coefficients.dot(right) / sums.weighted_squares, 0.0));
  return coefficients;
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
  double bend = 0.0;    // 1/m, >= 0
  double known = 0.0;   // apex_share
  double top = 0.0;     // m: its apex, where known
  double extent = 0.0;  // m
};

// Of the fall of a whole paraboloid's depth from its apex to its rim: so much shows where the apex
// is; a ball cut in the middle has 0.3 across the cut.
constexpr double kShown = 0.7;
constexpr double kUnknown = 0.2;

/// How well the cells show the apex along a principal axis, 0 to 1. The depth of a whole paraboloid
/// falls by 2 bend spread = the depth of its apex from there to its rim. That of a flat contact,
/// which ends at an edge, does not fall, and gradient / bend would be arbitrary.
/// @param bend    1/m, curvature
/// @param spread  m^2, variance of the place over the area
double apex_share(double bend, double spread, double depth) {
  return smooth_step((2.0 * bend * spread / depth - kUnknown) / (kShown - kUnknown));
}

/// What the axes of a contact are taken from: the curvature. Of a flat face it is that of rounding
/// errors, and another pair of axes each step; there the covered area decides, by a small part of
/// the curvature with which the depth would end at the area's rim.
Eigen::Matrix2d axes_from(const Eigen::Matrix2d& curvature, const Eigen::Matrix2d& spread,
                          double depth) {
  constexpr double kAreaShare = 0.01;
  const double falls = 2.0 * (curvature * spread).trace() / depth;
  const double flat = 1.0 - smooth_step(falls / kUnknown);
  return flat > 0.0
             ? Eigen::Matrix2d(curvature + flat * kAreaShare * 0.5 * depth * spread.inverse())
             : curvature;
}

// How far the force of a tilted flat punch moves, over what the squares of the depth give. Flat and
// round: (2/3) a^2 over a^2 / 2 (Johnson, 1985, 3.5). For a cylinder between two edges the squares
// give 5/3 of Winkler's foundation; `patch` gives 1.3 of it where the contact is 10 times as long
// as wide, 1.4 where 5 times.
constexpr double kFlatStamp = 4.0 / 3.0;
constexpr double kCylinder = 0.8;

/// The apex of a paraboloid two cells wide is a quarter deeper than the nearest centres.
constexpr double kBetweenCells = 1.25;

/// The part of the shape that sums over the overlap tell.
void set_sums(const PlaceMoments& sums, const Area& area, const Eigen::Vector2d& middle,
              double largest, ContactShape& shape) {
  shape.mean_depth = largest * sums.depths / sums.of_area[0];
  const Eigen::Vector2d stamp = area.center + kFlatStamp * (middle - area.center);
  shape.stamp = {stamp.x(), stamp.y()};
  const double ratio = sums.squares * sums.of_area[0] / (sums.depths * sums.depths);
  shape.peak = std::clamp(3.0 * (ratio - 1.0), 0.0, 1.0);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread;
  spread.computeDirect(area.spread);
  const Eigen::Vector2d squares = spread.eigenvalues().cwiseMax(0.0);
  shape.axes = squares(1) > 0.0 ? std::sqrt(squares(0) / squares(1)) : 1.0;
}

}  // namespace

ContactShape fit_contact_shape(const RegionFrame& frame, std::uint32_t side,
                               std::span<const CellGeometry> cells) {
  ContactShape shape;
  const double largest = largest_depth(cells);
  if (largest <= 0.0) {
    return shape;
  }
  const PlaceMoments sums = add_cells(side, cells, largest);
  const Vector6 c = solve(sums, shape.misfit);
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
  set_sums(sums, area, middle, largest, shape);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal;
  principal.computeDirect(axes_from(fit.curvature, area.spread, depth));
  std::array<PrincipalAxis, 2> axes;
  for (int k = 0; k < 2; ++k) {
    PrincipalAxis& axis = axes[static_cast<std::size_t>(k)];
    axis.direction = principal.eigenvectors().col(k);
    const double spread = axis.direction.dot(area.spread * axis.direction);
    axis.bend = std::max(axis.direction.dot(fit.curvature * axis.direction), 0.0);
    axis.known = apex_share(axis.bend, spread, depth);
    axis.extent = 2.0 * std::sqrt(std::max(spread, 0.0));
    const double center = axis.direction.dot(area.center);
    axis.top = axis.known > 0.0 ? std::clamp(axis.direction.dot(fit.gradient) / axis.bend,
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
  shape.curvature_1 = axes[0].bend;
  shape.curvature_2 = axes[1].bend;
  shape.apex = {apex.x(), apex.y()};
  // Where the cells show little (a thin contact lies across them) the paraboloid may do anything
  // outside of them, but its depth is limited to what may lie between two cells.
  shape.depth = std::min(fit.at(deepest), kBetweenCells * largest);
  return shape;
}

}  // namespace torsion::engine
