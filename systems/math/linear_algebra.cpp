#include "systems/math/linear_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include "systems/math/lanes.hpp"

namespace torsion::engine {
EigenSystem6 eigen_system(const Matrix6& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Vector6 solve_ldlt(const Matrix6& symmetric, const Vector6& right) {
  return symmetric.ldlt().solve(right);
}

Vector6 solve_lu(const Matrix6& matrix, const Vector6& right) {
  return matrix.partialPivLu().solve(right);
}

namespace {

/// to -= factor * from.
inline void subtract(std::size_t count, double factor, const double* __restrict from,
                     double* __restrict to) {
  for (std::size_t i = 0; i < count; ++i) {
    to[i] -= factor * from[i];
  }
}

}  // namespace

TORSION_WIDEST
double solve_symmetric(std::size_t n, std::size_t stride, double* upper, std::size_t width,
                       double* right, double least_pivot) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k) {
    double* const row = upper + k * stride;
    smallest = std::min(smallest, row[k]);
    row[k] = 1.0 / std::max(row[k], least_pivot);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = row[i] * row[k];
      subtract(n - i, factor, row + i, upper + i * stride + i);
      subtract(width, factor, right + k * width, right + i * width);
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    const double* const row = upper + k * stride;
    double* const found = right + k * width;
    for (std::size_t j = k + 1; j < n; ++j) {
      subtract(width, row[j], right + j * width, found);
    }
    for (std::size_t c = 0; c < width; ++c) {
      found[c] *= row[k];
    }
  }
  return smallest;
}

TORSION_WIDEST
void solve_general(std::size_t n, double* matrix, double* right) {
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t largest = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(matrix[i * n + k]) > std::abs(matrix[largest * n + k])) {
        largest = i;
      }
    }
    if (largest != k) {
      std::swap_ranges(matrix + k * n + k, matrix + (k + 1) * n, matrix + largest * n + k);
      std::swap(right[k], right[largest]);
    }
    const double* const row = matrix + k * n;
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = matrix[i * n + k] / row[k];
      subtract(n - k, factor, row + k, matrix + i * n + k);
      right[i] -= factor * right[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) {
      right[k] -= matrix[k * n + j] * right[j];
    }
    right[k] /= matrix[k * n + k];
  }
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.householderQr().solve(right);
}

Eigen::MatrixXd least_norm_solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.completeOrthogonalDecomposition().solve(right);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace torsion::engine
