#include "systems/contact_models/contact_shape.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "systems/frames.hpp"

namespace torsion {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kMoments = 15;  // of x^p y^q with p + q <= 4

/// Where x^p y^q is in the list of moments: by degree, then by q.
constexpr int moment(int p, int q) {
  const int degree = p + q;
  return degree * (degree + 1) / 2 + q;
}

/// Weighted moments of the cells' places and of their depths; places in half grid sizes.
struct Moments {
  std::array<double, kMoments> of_place{};
  std::array<double, 6> of_depth{};
};

Moments add_cells(std::uint32_t side, std::span<const CellGeometry> cells) {
  Moments sums;
  const double step = 2.0 / static_cast<double>(side);
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    const double y = (static_cast<double>(j) + 0.5) * step - 1.0;
    // Moments of one row in x, which y then multiplies.
    std::array<double, 5> row{};
    std::array<double, 3> row_depth{};
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      const double depth = cells[cell].coverage >= 0.5 ? std::max(cells[cell].depth, 0.0) : 0.0;
      const double x = (static_cast<double>(i) + 0.5) * step - 1.0;
      double power = depth * depth;
      for (std::size_t p = 0; p < row.size(); ++p) {
        row[p] += power;
        if (p < row_depth.size()) {
          row_depth[p] += power * depth;
        }
        power *= x;
      }
    }
    double power = 1.0;
    for (int q = 0; q <= 4; ++q) {
      for (int p = 0; p + q <= 4; ++p) {
        sums.of_place[static_cast<std::size_t>(moment(p, q))] +=
            power * row[static_cast<std::size_t>(p)];
        if (p + q <= 2) {
          sums.of_depth[static_cast<std::size_t>(moment(p, q))] +=
              power * row_depth[static_cast<std::size_t>(p)];
        }
      }
      power *= y;
    }
  }
  return sums;
}

/// Coefficients of 1, x, y, x^2, x y, y^2.
Vector6 solve(const Moments& sums) {
  constexpr std::array<std::array<int, 2>, 6> kPowers{
      {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  Matrix6 matrix;
  Vector6 right;
  for (int a = 0; a < 6; ++a) {
    const auto& pa = kPowers[static_cast<std::size_t>(a)];
    right(a) = sums.of_depth[static_cast<std::size_t>(moment(pa[0], pa[1]))];
    for (int b = 0; b < 6; ++b) {
      const auto& pb = kPowers[static_cast<std::size_t>(b)];
      matrix(a, b) = sums.of_place[static_cast<std::size_t>(moment(pa[0] + pb[0], pa[1] + pb[1]))];
    }
  }
  // Few cells, or cells in a row, leave some of it open: those stay near zero.
  matrix.diagonal().array() += 1e-12 * matrix(0, 0);
  return matrix.ldlt().solve(right);
}

}  // namespace

ContactShape fit_contact_shape(const RegionFrame& frame, std::uint32_t side,
                               std::span<const CellGeometry> cells) {
  ContactShape shape;
  const Moments sums = add_cells(side, cells);
  const double weight = sums.of_place[0];
  if (weight <= 0.0) {
    return shape;
  }
  const Vector6 c = solve(sums);
  const glm::dvec2 scale = frame.half_size;
  // depth = c0 + g . x - x' K x / 2
  const Eigen::Vector2d gradient(c(1) / scale.x, c(2) / scale.y);
  Eigen::Matrix2d curvature;
  curvature << -2.0 * c(3) / (scale.x * scale.x), -c(4) / (scale.x * scale.y),
      -c(4) / (scale.x * scale.y), -2.0 * c(5) / (scale.y * scale.y);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal;
  principal.computeDirect(curvature);
  const Eigen::Vector2d middle(sums.of_place[1] / weight * scale.x,
                               sums.of_place[2] / weight * scale.y);
  // Curvatures that a grid's depths cannot show count as none.
  const double size = std::max(scale.x, scale.y);
  const double least = 1e-3 * std::abs(c(0)) / (size * size);
  Eigen::Vector2d apex = Eigen::Vector2d::Zero();
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d axis = principal.eigenvectors().col(k);
    const double bend = principal.eigenvalues()(k);
    const double along = bend > least ? axis.dot(gradient) / bend : axis.dot(middle);
    apex += axis * std::clamp(along, -size, size);
  }
  shape.curvature_1 = principal.eigenvalues()(0) > least ? principal.eigenvalues()(0) : 0.0;
  shape.curvature_2 = principal.eigenvalues()(1) > least ? principal.eigenvalues()(1) : 0.0;
  shape.apex = {apex.x(), apex.y()};
  shape.depth = c(0) + gradient.dot(apex) - 0.5 * apex.dot(curvature * apex);
  return shape;
}

}  // namespace torsion
