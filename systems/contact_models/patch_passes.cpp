#include "systems/contact_models/patch_passes.hpp"

#include <cmath>

#include "systems/distance_shapes.hpp"
#include "systems/widest.hpp"

namespace torsion {
namespace {

/// The inverse at eight cells.
/// @param wanted  at the first of them
TORSION_LANES void ask_neighbours(const LocalInverse& inverse, const double* wanted,
                                  std::size_t width, double* asked) {
  const double* const low = wanted - width;
  const double* const high = wanted + width;
  // Sums in pairs, so that a mirror image has the same bits.
  lanes_at(asked) = inverse.here * lanes_at(wanted) +
                    inverse.along_x * (lanes_at(wanted - 1) + lanes_at(wanted + 1)) +
                    inverse.along_y * (lanes_at(low) + lanes_at(high)) +
                    inverse.corner * ((lanes_at(low - 1) + lanes_at(high + 1)) +
                                      (lanes_at(low + 1) + lanes_at(high - 1)));
}

}  // namespace

TORSION_WIDEST
double dot(std::size_t count, const double* a, const double* b) {
  Wide sums{};
  for (std::size_t k = 0; k < count; k += kPatchLanes) {
    sums += lanes_at(a + k) * lanes_at(b + k);
  }
  return sum_of(sums);
}

TORSION_WIDEST
double dot(std::size_t count, const double* a_x, const double* a_y, const double* b_x,
           const double* b_y) {
  Wide sums{};
  for (std::size_t k = 0; k < count; k += kPatchLanes) {
    sums += lanes_at(a_x + k) * lanes_at(b_x + k) + lanes_at(a_y + k) * lanes_at(b_y + k);
  }
  return sum_of(sums);
}

TORSION_WIDEST
double largest(std::size_t count, const double* values) {
  Wide most{};
  for (std::size_t k = 0; k < count; k += kPatchLanes) {
    const Wide value = lanes_at(values + k);
    most = value > most ? value : most;
  }
  return largest_of(most);
}

TORSION_WIDEST
void add_scaled(std::size_t count, double scale, const double* __restrict values,
                double* __restrict to) {
  for (std::size_t k = 0; k < count; ++k) {
    to[k] += scale * values[k];
  }
}

TORSION_WIDEST
void to_border(std::uint32_t side, const double* __restrict cells, double* __restrict bordered) {
  const std::size_t width = std::size_t{side} + 2;
  for (std::size_t row = 0; row < side; ++row) {
    const double* const from = cells + row * side;
    double* const to = bordered + (row + 1) * width + 1;
    if (side < kPatchLanes) {
      for (std::size_t i = 0; i < side; ++i) {
        to[i] = from[i];
      }
      continue;
    }
    for (std::size_t i = 0; i < side; i += kPatchLanes) {
      // The last eight end with the row: some are copied twice.
      const std::size_t at = i + kPatchLanes <= side ? i : side - kPatchLanes;
      lanes_at(to + at) = lanes_at(from + at);
    }
  }
}

TORSION_WIDEST
void apply_local_inverse(const LocalInverse& inverse, double scale, std::uint32_t side,
                         const double* __restrict wanted, double* __restrict asked) {
  const std::size_t width = std::size_t{side} + 2;
  const LocalInverse scaled{inverse.here * scale, inverse.along_x * scale, inverse.along_y * scale,
                            inverse.corner * scale};
  for (std::size_t row = 0; row < side; ++row) {
    const double* const from = wanted + (row + 1) * width + 1;
    double* const to = asked + row * side;
    if (side < kPatchLanes) {
      for (std::size_t i = 0; i < side; ++i) {
        to[i] = scaled.here * from[i] + scaled.along_x * (from[i - 1] + from[i + 1]) +
                scaled.along_y * (from[i - width] + from[i + width]) +
                scaled.corner * ((from[i - width - 1] + from[i + width + 1]) +
                                 (from[i - width + 1] + from[i + width - 1]));
      }
      continue;
    }
    for (std::size_t i = 0; i < side; i += kPatchLanes) {
      const std::size_t at = i + kPatchLanes <= side ? i : side - kPatchLanes;
      ask_neighbours(scaled, from + at, width, to + at);
    }
  }
}

TORSION_WIDEST
void find_overlaps(std::size_t count, const double* __restrict depth,
                   const double* __restrict depression, const double* __restrict pressure,
                   double* __restrict residual) {
  for (std::size_t k = 0; k < count; ++k) {
    const double overlap = depth[k] - depression[k];
    residual[k] = larger(pressure[k], overlap) > 0.0 ? overlap : 0.0;
  }
}

TORSION_WIDEST
double keep_asked(std::size_t count, const double* __restrict residual, double* __restrict asked) {
  Wide sums{};
  const Wide none{};
  for (std::size_t k = 0; k < count; k += kPatchLanes) {
    const Wide left = lanes_at(residual + k);
    const Wide all = lanes_at(asked + k);
    const Wide kept = left != 0.0 ? all : none;
    lanes_at(asked + k) = kept;
    sums += left * kept;
  }
  return sum_of(sums);
}

TORSION_WIDEST
double mix_pressures(std::size_t count, const double* __restrict residual,
                     const double* __restrict asked, double kept, double* __restrict step) {
  Wide sums{};
  const Wide none{};
  for (std::size_t k = 0; k < count; k += kPatchLanes) {
    const Wide wants = lanes_at(asked + k);
    const Wide mixed = wants + kept * lanes_at(step + k);
    const Wide way = wants != 0.0 ? mixed : none;
    lanes_at(step + k) = way;
    sums += lanes_at(residual + k) * way;
  }
  return sum_of(sums);
}

TORSION_WIDEST
SweepChange change_pressures(std::size_t count, double length, const double* __restrict moves,
                             double* __restrict step, double* __restrict pressure,
                             double* __restrict depression, double& pull) {
  Wide most{};
  Wide sums{};
  Wide least{};
  for (std::size_t k = 0; k < count; k += kPatchLanes) {
    const Wide way = length * lanes_at(step + k);
    const Wide to = lanes_at(pressure + k) + way;
    lanes_at(step + k) = way;
    lanes_at(pressure + k) = to;
    lanes_at(depression + k) += length * lanes_at(moves + k);
    const Wide size = way < 0.0 ? -way : way;
    most = size > most ? size : most;
    sums += size;
    least = to < least ? to : least;
  }
  pull = largest_of(-least);
  return {largest_of(most), sum_of(sums)};
}

TORSION_WIDEST
void find_pulls(std::size_t count, const double* __restrict pressure, double* __restrict step) {
  for (std::size_t k = 0; k < count; ++k) {
    step[k] = larger(-pressure[k], 0.0);
  }
}

TORSION_WIDEST
void lose_cells(std::size_t count, double least_depth, const double* __restrict depth,
                double* __restrict pressure, double* __restrict traction_x,
                double* __restrict traction_y, double* __restrict change_pressure,
                double* __restrict change_x, double* __restrict change_y) {
  for (std::size_t k = 0; k < count; ++k) {
    const double kept = pressure[k] > 0.0 ? 1.0 : 0.0;
    const double keeps = depth[k] > least_depth ? kept : 0.0;
    const double gone = keeps - 1.0;
    change_pressure[k] = gone * pressure[k];
    change_x[k] = gone * traction_x[k];
    change_y[k] = gone * traction_y[k];
    pressure[k] *= keeps;
    traction_x[k] *= keeps;
    traction_y[k] *= keeps;
  }
}

}  // namespace torsion
