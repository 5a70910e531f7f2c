#include "systems/patch/passes.hpp"

#include <cmath>

#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

/// What a row adds to the product with the local inverse, at eight cells.
struct InverseOfRow {
  Wide here;    // in the row itself
  Wide beside;  // in the rows below and above
};

/// @param values  at the first of the cells
TORSION_LANES InverseOfRow apply_row(const LocalInverse& inverse, const double* values) {
  const Wide middle = lanes_at(values).all;
  // Sums in pairs, so that a mirror image has the same bits.
  const Wide sides = lanes_at(values - 1).all + lanes_at(values + 1).all;
  return {inverse.here * middle + inverse.along_x * sides,
          inverse.along_y * middle + inverse.corner * sides};
}

/// The product with the local inverse at eight columns of all rows.
TORSION_LANES void apply_columns(const LocalInverse& inverse, std::uint32_t side,
                                 const double* values, double* product) {
  const std::size_t width = std::size_t{side} + 2;
  InverseOfRow low = apply_row(inverse, values - width);
  InverseOfRow middle = apply_row(inverse, values);
  for (std::size_t row = 0; row < side; ++row) {
    const InverseOfRow high = apply_row(inverse, values + (row + 1) * width);
    lanes_at(product + row * side).all = middle.here + (low.beside + high.beside);
    low = middle;
    middle = high;
  }
}

LocalInverse scaled(const LocalInverse& inverse, double scale) {
  return {inverse.here * scale, inverse.along_x * scale, inverse.along_y * scale,
          inverse.corner * scale};
}

}  // namespace

TORSION_WIDEST
double dot(std::size_t count, const double* a, const double* b) {
  Wide sums{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    sums += lanes_at(a + k).all * lanes_at(b + k).all;
  }
  return sum_of(sums);
}

TORSION_WIDEST
double dot(std::size_t count, const double* a_x, const double* a_y, const double* b_x,
           const double* b_y) {
  Wide sums{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    sums += lanes_at(a_x + k).all * lanes_at(b_x + k).all +
            lanes_at(a_y + k).all * lanes_at(b_y + k).all;
  }
  return sum_of(sums);
}

TORSION_WIDEST
double largest(std::size_t count, const double* values) {
  Wide most{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide value = lanes_at(values + k).all;
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
void multiply(std::size_t count, const double* a, const double* b, double* product) {
  for (std::size_t k = 0; k < count; ++k) {
    product[k] = a[k] * b[k];
  }
}

TORSION_WIDEST
void to_border(std::uint32_t side, const double* __restrict cells, double* __restrict bordered) {
  const std::size_t width = std::size_t{side} + 2;
  for (std::size_t row = 0; row < side; ++row) {
    const double* const from = cells + row * side;
    double* const to = bordered + (row + 1) * width + 1;
    if (side < kLanes) {
      for (std::size_t i = 0; i < side; ++i) {
        to[i] = from[i];
      }
      continue;
    }
    for (std::size_t i = 0; i < side; i += kLanes) {
      // The last eight end with the row: some are copied twice.
      const std::size_t at = i + kLanes <= side ? i : side - kLanes;
      lanes_at(to + at).all = lanes_at(from + at).all;
    }
  }
}

TORSION_WIDEST
void apply_local_inverse(const LocalInverse& inverse, double scale, std::uint32_t side,
                         const double* __restrict residual, double* __restrict preconditioned) {
  const std::size_t width = std::size_t{side} + 2;
  const LocalInverse by = scaled(inverse, scale);
  for (std::size_t row = 0; side < kLanes && row < side; ++row) {
    const double* const low = residual + row * width;
    const double* const middle = low + width;
    const double* const high = middle + width;
    double* const to = preconditioned + row * side;
    for (std::size_t i = 0; i < side; ++i) {
      to[i] = by.here * middle[i + 1] + by.along_x * (middle[i] + middle[i + 2]) +
              by.along_y * (low[i + 1] + high[i + 1]) +
              by.corner * ((low[i] + high[i + 2]) + (low[i + 2] + high[i]));
    }
  }
  for (std::size_t i = 0; side >= kLanes && i < side; i += kLanes) {
    // The last eight end with the row: some are computed twice, with the same result.
    const std::size_t at = i + kLanes <= side ? i : side - kLanes;
    apply_columns(by, side, residual + width + 1 + at, preconditioned + at);
  }
}

TORSION_WIDEST
double quadratic_form(const LocalInverse& inverse, double scale, std::uint32_t side,
                      const double* __restrict displacement) {
  const std::size_t width = std::size_t{side} + 2;
  const std::size_t count = whole_lanes(side * width);
  // Every pair of neighbours once, and half of each cell itself. The border is zero, so the end of
  // a row and the beginning of the next do not interact.
  const double here = 0.5 * inverse.here;
  const double along_x = inverse.along_x;
  const double along_y = inverse.along_y;
  const double corner = inverse.corner;
  Wide sums{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const double* const at = displacement + width + k;
    sums +=
        lanes_at(at).all * (here * lanes_at(at).all + along_x * lanes_at(at + 1).all +
                            along_y * lanes_at(at + width).all +
                            corner * (lanes_at(at + width - 1).all + lanes_at(at + width + 1).all));
  }
  return 2.0 * scale * sum_of(sums);
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
PressureResidual pressure_residual(std::size_t count, const double* __restrict depth,
                                   const double* __restrict depression,
                                   const double* __restrict pressure) {
  Wide lacking{};
  Wide scale{};
  const Wide none{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide has = lanes_at(pressure + k).all;
    const Wide all = lanes_at(depth + k).all;
    const Wide deep = all > 0.0 ? all : none;
    const Wide overlap = all - lanes_at(depression + k).all;
    const Wide positive = overlap > 0.0 ? overlap : none;
    const Wide left = has > 0.0 ? overlap : positive;
    lacking += left * left;
    scale += deep * deep;
  }
  return {sum_of(lacking), sum_of(scale)};
}

TORSION_WIDEST
double mask_preconditioned(std::size_t count, const double* __restrict residual,
                           double* __restrict preconditioned) {
  Wide sums{};
  const Wide none{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide left = lanes_at(residual + k).all;
    const Wide all = lanes_at(preconditioned + k).all;
    const Wide counted = left != 0.0 ? all : none;
    lanes_at(preconditioned + k).all = counted;
    sums += left * counted;
  }
  return sum_of(sums);
}

TORSION_WIDEST
double next_pressure_direction(std::size_t count, const double* __restrict residual,
                               const double* __restrict preconditioned, double beta,
                               double* __restrict direction) {
  Wide sums{};
  const Wide none{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide z = lanes_at(preconditioned + k).all;
    const Wide mixed = z + beta * lanes_at(direction + k).all;
    const Wide way = z != 0.0 ? mixed : none;
    lanes_at(direction + k).all = way;
    sums += lanes_at(residual + k).all * way;
  }
  return sum_of(sums);
}

TORSION_WIDEST
IterationChange step_pressures(std::size_t count, double alpha, const double* __restrict response,
                               double* __restrict direction, double* __restrict pressure,
                               double* __restrict depression, double& tension) {
  Wide most{};
  Wide sums{};
  Wide least{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide way = alpha * lanes_at(direction + k).all;
    const Wide to = lanes_at(pressure + k).all + way;
    lanes_at(direction + k).all = way;
    lanes_at(pressure + k).all = to;
    lanes_at(depression + k).all += alpha * lanes_at(response + k).all;
    const Wide size = way < 0.0 ? -way : way;
    most = size > most ? size : most;
    sums += size;
    least = to < least ? to : least;
  }
  tension = largest_of(-least);
  return {largest_of(most), sum_of(sums)};
}

TORSION_WIDEST
void find_tension(std::size_t count, const double* __restrict pressure,
                  double* __restrict direction) {
  for (std::size_t k = 0; k < count; ++k) {
    direction[k] = larger(-pressure[k], 0.0);
  }
}

TORSION_WIDEST
bool release_unloaded(std::size_t count, double least_depth, const double* __restrict depth,
                      double* __restrict pressure, double* __restrict traction_x,
                      double* __restrict traction_y, double* __restrict change_pressure,
                      double* __restrict change_x, double* __restrict change_y) {
  const Wide none{};
  Wide lost{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide has = lanes_at(pressure + k).all;
    const Wide has_x = lanes_at(traction_x + k).all;
    const Wide has_y = lanes_at(traction_y + k).all;
    const Wide deep = lanes_at(depth + k).all > least_depth ? has : none;
    const Wide keeps = deep > 0.0 ? none + 1.0 : none;
    lanes_at(pressure + k).all = has * keeps;
    lanes_at(traction_x + k).all = has_x * keeps;
    lanes_at(traction_y + k).all = has_y * keeps;
    lanes_at(change_pressure + k).all = has * (keeps - 1.0);
    lanes_at(change_x + k).all = has_x * (keeps - 1.0);
    lanes_at(change_y + k).all = has_y * (keeps - 1.0);
    lost += (1.0 - keeps) * (has * has + has_x * has_x + has_y * has_y);
  }
  return sum_of(lost) > 0.0;
}

}  // namespace torsion::engine
