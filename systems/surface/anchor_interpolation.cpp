#include "systems/surface/anchor_interpolation.hpp"

#include <cmath>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/math/lanes.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {

std::vector<InterpolationRow> invert_interpolation(std::span<const glm::dvec3> centers) {
  constexpr std::size_t kFewest = 5;
  if (centers.size() < kFewest) {
    return {};
  }
  const auto count = static_cast<Eigen::Index>(centers.size());
  const Eigen::Index side = count + 4;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(side, side);
  for (Eigen::Index i = 0; i < count; ++i) {
    const glm::dvec3& center = centers[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < count; ++j) {
      matrix(i, j) = glm::distance(center, centers[static_cast<std::size_t>(j)]);
    }
    const Eigen::Vector4d affine(1.0, center.x, center.y, center.z);
    matrix.block<1, 4>(i, count) = affine.transpose();
    matrix.block<4, 1>(count, i) = affine;
  }
  // Complete orthogonal decomposition: centers in one plane leave a part of the affine field
  // undetermined, which is set to zero.
  const Eigen::MatrixXd inverse = pseudo_inverse(matrix);
  std::vector<InterpolationRow> rows;
  rows.reserve(static_cast<std::size_t>(side * side));
  for (Eigen::Index i = 0; i < side; ++i) {
    for (Eigen::Index j = 0; j < side; ++j) {
      rows.push_back({inverse(i, j)});
    }
  }
  return rows;
}

void solve_interpolation(std::span<const InterpolationRow> inverse,
                         std::span<const glm::dvec3> centers, std::span<const glm::dvec3> values,
                         InterpolationWeights& weights) {
  const std::size_t count = centers.size();
  const std::size_t side = count + 4;
  weights.centers.resize(count);
  const auto row_times_values = [&](std::size_t row) {
    glm::dvec3 sum(0.0);
    for (std::size_t j = 0; j < count; ++j) {
      sum += values[j] * inverse[row * side + j].value;
    }
    return sum;
  };
  for (std::size_t i = 0; i < count; ++i) {
    weights.centers[i] = {glm::vec3(centers[i]), glm::vec3(row_times_values(i))};
  }
  weights.constant = row_times_values(count);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    weights.slope[axis] = row_times_values(count + 1 + axis);
  }
}

glm::dvec3 interpolate(const InterpolationWeights& weights, const glm::dvec3& point) {
  glm::dvec3 value = weights.constant + weights.slope[0] * point.x + weights.slope[1] * point.y +
                     weights.slope[2] * point.z;
  for (const InterpolationWeights::Center& center : weights.centers) {
    value += glm::dvec3(center.weight) * glm::distance(point, glm::dvec3(center.position));
  }
  return value;
}

TORSION_WIDEST
void interpolate_block(const InterpolationWeights& weights, const BlockVectors& points,
                       BlockVectors& field, std::span<const ScalarColumn> columns) {
  const glm::vec3 constant(weights.constant);
  const glm::vec3 along_x(weights.slope[0]);
  const glm::vec3 along_y(weights.slope[1]);
  const glm::vec3 along_z(weights.slope[2]);
  for (std::size_t i = 0; i < kPointBlock; ++i) {
    const float x = points.x[i];
    const float y = points.y[i];
    const float z = points.z[i];
    field.x[i] = constant.x + along_x.x * x + along_y.x * y + along_z.x * z;
    field.y[i] = constant.y + along_x.y * x + along_y.y * y + along_z.y * z;
    field.z[i] = constant.z + along_x.z * x + along_y.z * y + along_z.z * z;
  }
  for (const ScalarColumn& column : columns) {
    const auto start = static_cast<float>(column.weights->constant);
    const glm::vec3 slope(column.weights->slope);
    for (std::size_t i = 0; i < kPointBlock; ++i) {
      (*column.values)[i] =
          start + slope.x * points.x[i] + slope.y * points.y[i] + slope.z * points.z[i];
    }
  }
  BlockColumn distances;
  for (std::size_t j = 0; j < weights.centers.size(); ++j) {
    const glm::vec3 p = weights.centers[j].position;
    const glm::vec3 w = weights.centers[j].weight;
    for (std::size_t i = 0; i < kPointBlock; ++i) {
      const float dx = points.x[i] - p.x;
      const float dy = points.y[i] - p.y;
      const float dz = points.z[i] - p.z;
      const float distance = std::sqrt(dx * dx + dy * dy + dz * dz);
      distances[i] = distance;
      field.x[i] += w.x * distance;
      field.y[i] += w.y * distance;
      field.z[i] += w.z * distance;
    }
    for (const ScalarColumn& column : columns) {
      const float weight = column.weights->weights[j];
      BlockColumn& values = *column.values;
      for (std::size_t i = 0; i < kPointBlock; ++i) {
        values[i] += weight * distances[i];
      }
    }
  }
}

void solve_interpolation(std::span<const InterpolationRow> inverse, std::span<const double> values,
                         ScalarWeights& weights) {
  const std::size_t count = values.size();
  const std::size_t side = count + 4;
  const auto row_times_values = [&](std::size_t row) {
    double sum = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      sum += values[j] * inverse[row * side + j].value;
    }
    return sum;
  };
  weights.weights.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    weights.weights[i] = static_cast<float>(row_times_values(i));
  }
  weights.constant = row_times_values(count);
  weights.slope = {row_times_values(count + 1), row_times_values(count + 2),
                   row_times_values(count + 3)};
}

double interpolate(const ScalarWeights& weights, std::span<const glm::dvec3> centers,
                   const glm::dvec3& point) {
  double value = weights.constant + glm::dot(weights.slope, point);
  for (std::size_t j = 0; j < centers.size(); ++j) {
    value += static_cast<double>(weights.weights[j]) * glm::distance(point, centers[j]);
  }
  return value;
}

}  // namespace torsion::engine
