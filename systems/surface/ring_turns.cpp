#include "systems/surface/ring_turns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/math/dense_solve.hpp"
#include "systems/math/lanes.hpp"

namespace torsion {
namespace {

constexpr auto kDiscs = static_cast<double>(kFieldDiscs);

double surface_turn(double r, double s) {
  if (r <= s) {
    return 1.0;
  }
  const double x = s / r;
  return 2.0 / std::numbers::pi * (std::asin(x) - x * std::sqrt(1.0 - x * x));
}

/// Least squares' matrix and right sides: what the rings have, and what the couple is.
struct TurnFit {
  std::array<double, std::size_t{kFieldDiscs} * kFieldDiscs> matrix{};
  std::array<double, std::size_t{kFieldDiscs} * 2> right{};
};

TORSION_WIDEST
void add_rings(const RingProfiles& profiles, const RingTurns& rings, TurnFit& fit) {
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    const double* const turn = profiles.turn[ring].data();
    for (std::size_t j = 0; j < kFieldDiscs; ++j) {
      const double weighted = rings.weight[ring] * turn[j];
      for (std::size_t k = 0; k < kFieldDiscs; ++k) {
        fit.matrix[j * kFieldDiscs + k] += weighted * turn[k];
      }
      fit.right[2 * j] += rings.around[ring] * turn[j];
    }
  }
}

/// Neighbours' differences, and a little of the discs themselves, lest nothing tell two apart.
void add_calm(double weight, TurnFit& fit) {
  constexpr double kOfItself = 1e-6;
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    double* const row = &fit.matrix[j * kFieldDiscs];
    const bool ends = j == 0 || j + 1 == kFieldDiscs;
    row[j] += weight * ((ends ? 1.0 : 2.0) + kOfItself);
    if (j + 1 < kFieldDiscs) {
      row[j + 1] -= weight;  // the solver reads what is right of the diagonal
    }
  }
}

/// Couple of a disc over that of the largest.
double couple_share(std::size_t disc) {
  const double s = static_cast<double>(disc + 1) / kDiscs;
  return s * s * s;
}

}  // namespace

RingProfiles make_ring_profiles() {
  // A ring's points lie to both sides of it, with the weights that RingTurns::add gives them: its
  // profile is the mean over them, where they are spread evenly.
  constexpr int kSlices = 64;
  RingProfiles profiles;
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    double weights = 0.0;
    for (int slice = -kSlices; slice < kSlices; ++slice) {
      const double off = (slice + 0.5) / kSlices;
      const double r = (static_cast<double>(ring) + off) / kDiscs;
      if (r <= 0.0) {
        continue;
      }
      const double weight = (1.0 - std::abs(off)) * r * r * r;
      weights += weight;
      for (std::size_t j = 0; j < kFieldDiscs; ++j) {
        profiles.turn[ring][j] += weight * surface_turn(r, static_cast<double>(j + 1) / kDiscs);
      }
    }
    for (double& turn : profiles.turn[ring]) {
      turn /= weights;
    }
  }
  return profiles;
}

void RingTurns::add(double r, double moved) {
  const double place = r * kDiscs;
  if (place >= static_cast<double>(kRings - 1)) {
    return;
  }
  const auto ring = static_cast<std::size_t>(place);
  const double outer = place - static_cast<double>(ring);
  weight[ring] += (1.0 - outer) * r * r;
  weight[ring + 1] += outer * r * r;
  around[ring] += (1.0 - outer) * r * moved;
  around[ring + 1] += outer * r * moved;
}

void discs_of_ring_turns(const RingProfiles& profiles, const RingTurns& rings, double couple,
                         double calm, std::span<double> turn) {
  TurnFit fit;
  add_rings(profiles, rings, fit);
  double weights = 0.0;
  for (const double weight : rings.weight) {
    weights += weight;
  }
  add_calm(calm * weights, fit);
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    fit.right[2 * j + 1] = couple_share(j);
  }
  solve_symmetric(kFieldDiscs, kFieldDiscs, fit.matrix.data(), 2, fit.right.data(), 1e-12);
  // What the rings ask for, and as much of what raises the couple at the least cost as is lacking.
  double found = 0.0;
  double raised = 0.0;
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    found += couple_share(j) * fit.right[2 * j];
    raised += couple_share(j) * fit.right[2 * j + 1];
  }
  const double lacking = (couple - found) / raised;
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    turn[j] = fit.right[2 * j] + lacking * fit.right[2 * j + 1];
  }
}

}  // namespace torsion
