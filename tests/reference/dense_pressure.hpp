#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <vector>

namespace torsion::engine::reference {

// Frictionless contact of a rigid shape with an elastic half-space, on a square grid, by the
// plainest method that there is; for shapes that have no closed form.

/// What a rectangle of half sides h about the origin, loaded by a unit pressure, does to the
/// surface at (x, y), times pi E*: the integral of 1 / r. Source: Love, Phil. Trans. R. Soc. A 228
/// (1929) 377; Johnson, Contact Mechanics, 1985, (3.25).
inline double love_integral(double x, double y, double h) {
  // y ln(x + r) + x ln(y + r), with the logarithms as inverse hyperbolic sines: the rest cancels
  // between the corners.
  const auto corner = [](double a, double b) {
    return (a == 0.0 || b == 0.0)
               ? 0.0
               : a * std::asinh(b / std::abs(a)) + b * std::asinh(a / std::abs(b));
  };
  return corner(x + h, y + h) - corner(x - h, y + h) - corner(x + h, y - h) + corner(x - h, y - h);
}

struct DensePressure {
  double force = 0.0;   // N
  double moment = 0.0;  // N m: sum of force times distance from the grid's middle
  double middle = 0.0;  // Pa: largest pressure of the cells in the middle
};

struct DenseCell {
  int i = 0, j = 0;
  double x = 0.0, y = 0.0;  // m
  double depth = 0.0;       // m
  double pressure = 0.0;    // Pa
  double sunk = 0.0;        // m: displacement by all pressures
};

/// Gauss and Seidel's sweeps, no pressure under zero, until none is off by `error`, m.
/// @param influence  displacement at (i, j) cells' distance for a unit pressure, i fastest
inline void solve_pressures(const std::vector<double>& influence, int side, double error,
                            std::vector<DenseCell>& cells) {
  constexpr int kMostSweeps = 2000;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double worst = 0.0;
    for (DenseCell& at : cells) {
      const double next = std::max(at.pressure + (at.depth - at.sunk) / influence[0], 0.0);
      const double change = next - at.pressure;
      worst = std::max(worst, std::abs(change) * influence[0]);
      at.pressure = next;
      if (change == 0.0) {
        continue;
      }
      for (DenseCell& other : cells) {
        const int distance = std::abs(other.j - at.j) * side + std::abs(other.i - at.i);
        other.sunk += change * influence[static_cast<std::size_t>(distance)];
      }
    }
    if (worst < error) {
      return;
    }
  }
}

/// @param modulus  E*, Pa
/// @param half     of the grid's side, m; about the origin
/// @param side     cells along a side
/// @param depth    of (x, y): how deep the shape lies under the rest surface, m
/// Error: that of the grid.
template <class Depth>
DensePressure dense_pressure(double modulus, double half, int side, const Depth& depth) {
  const double cell = 2.0 * half / side;
  std::vector<DenseCell> cells;
  std::vector<double> influence;
  double deepest = 0.0;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      influence.push_back(love_integral(i * cell, j * cell, 0.5 * cell) /
                          (std::numbers::pi * modulus));
      const double x = (i + 0.5) * cell - half;
      const double y = (j + 0.5) * cell - half;
      // Where nothing overlaps nothing presses: the surface sinks, it does not rise.
      if (depth(x, y) > 0.0) {
        cells.push_back({i, j, x, y, depth(x, y)});
        deepest = std::max(deepest, depth(x, y));
      }
    }
  }
  solve_pressures(influence, side, 1e-6 * deepest, cells);
  DensePressure result;
  for (const DenseCell& at : cells) {
    const double force = at.pressure * cell * cell;
    result.force += force;
    result.moment += force * std::hypot(at.x, at.y);
    if (std::max(std::abs(at.x), std::abs(at.y)) < cell) {
      result.middle = std::max(result.middle, at.pressure);
    }
  }
  return result;
}

}  // namespace torsion::engine::reference
