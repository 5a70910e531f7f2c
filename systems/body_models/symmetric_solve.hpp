#pragma once

#include <cstddef>

namespace torsion {

/// Solves A X = B for a symmetric, positive definite A by Gauss' elimination without exchanges, in
/// place. Takes nothing from the heap; the same bits on every machine.
/// @param upper  n x n, row-major, `stride` apart: the diagonal and what is right of it are read;
///               overwritten
/// @param right  n x width, row-major: B, then X
/// @param least_pivot  taken in place of smaller ones
void solve_symmetric(std::size_t n, std::size_t stride, double* upper, std::size_t width,
                     double* right, double least_pivot);

}  // namespace torsion
