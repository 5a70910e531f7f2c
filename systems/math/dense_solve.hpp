#pragma once

#include <cstddef>

namespace torsion {

/// Solves A X = B for a symmetric, positive definite A by Gauss' elimination without exchanges, in
/// place. Takes nothing from the heap; the same bits on every machine.
/// @param upper  n x n, row-major, `stride` apart: the diagonal and what is right of it are read;
///               overwritten
/// @param right  n x width, row-major: B, then X
/// @param least_pivot  taken in place of smaller ones: what is found then solves other equations
/// @return the smallest pivot that there was
double solve_symmetric(std::size_t n, std::size_t stride, double* upper, std::size_t width,
                       double* right, double least_pivot);

/// Solves A x = b for any A by Gauss' elimination with exchanges of rows, in place, likewise. What
/// it finds of a singular A is not finite.
/// @param matrix  n x n, row-major; overwritten
/// @param right   n: b, then x
void solve_general(std::size_t n, double* matrix, double* right);

}  // namespace torsion
