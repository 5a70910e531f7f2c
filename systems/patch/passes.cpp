#include "systems/patch/passes.hpp"

#include <cmath>

#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

/// What a row adds to the product with the local inverse, at eight cells.
template <class Wide>
struct InverseOfRow {
  Wide here;    // in the row itself
  Wide beside;  // in the rows below and above
};

/// @param values  at the first of the cells
template <class Wide>
TORSION_LANES InverseOfRow<Wide> apply_row(const LocalInverse& inverse, const double* values) {
  const Wide middle = lanes_at<Wide>(values);
  // Sums in pairs, so that a mirror image has the same bits.
  const Wide sides = lanes_at<Wide>(values - 1) + lanes_at<Wide>(values + 1);
  return {inverse.here * middle + inverse.along_x * sides,
          inverse.along_y * middle + inverse.corner * sides};
}

/// The product with the local inverse at eight columns of all rows.
template <class Wide>
TORSION_LANES void apply_columns(const LocalInverse& inverse, std::uint32_t side,
                                 const double* values, double* product) {
  const std::size_t width = std::size_t{side} + 2;
  InverseOfRow<Wide> low = apply_row<Wide>(inverse, values - width);
  InverseOfRow<Wide> middle = apply_row<Wide>(inverse, values);
  for (std::size_t row = 0; row < side; ++row) {
    const InverseOfRow<Wide> high = apply_row<Wide>(inverse, values + (row + 1) * width);
    store_lanes(middle.here + (low.beside + high.beside), product + row * side);
    low = middle;
    middle = high;
  }
}

LocalInverse scaled(const LocalInverse& inverse, double scale) {
  return {inverse.here * scale, inverse.along_x * scale, inverse.along_y * scale,
          inverse.corner * scale};
}

template <class Wide>
TORSION_LANES double wide_dot(std::size_t count, const double* a, const double* b) {
  Wide sums{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    sums += lanes_at<Wide>(a + k) * lanes_at<Wide>(b + k);
  }
  return sum_of(sums);
}

template <class Wide>
TORSION_LANES double wide_dot_of_pairs(std::size_t count, const double* a_x, const double* a_y,
                                       const double* b_x, const double* b_y) {
  Wide sums{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    sums += lanes_at<Wide>(a_x + k) * lanes_at<Wide>(b_x + k) +
            lanes_at<Wide>(a_y + k) * lanes_at<Wide>(b_y + k);
  }
  return sum_of(sums);
}

template <class Wide>
TORSION_LANES double wide_largest(std::size_t count, const double* values) {
  Wide most{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide value = lanes_at<Wide>(values + k);
    most = choose(value > most, value, most);
  }
  return largest_of(most);
}

template <class Wide>
TORSION_LANES void wide_to_border(std::uint32_t side, const double* __restrict cells,
                                  double* __restrict bordered) {
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
      store_lanes(lanes_at<Wide>(from + at), to + at);
    }
  }
}

template <class Wide>
TORSION_LANES void wide_apply_local_inverse(const LocalInverse& inverse, double scale,
                                            std::uint32_t side, const double* __restrict residual,
                                            double* __restrict preconditioned) {
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
    apply_columns<Wide>(by, side, residual + width + 1 + at, preconditioned + at);
  }
}

template <class Wide>
TORSION_LANES double wide_quadratic_form(const LocalInverse& inverse, double scale,
                                         std::uint32_t side,
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
    sums += lanes_at<Wide>(at) *
            (here * lanes_at<Wide>(at) + along_x * lanes_at<Wide>(at + 1) +
             along_y * lanes_at<Wide>(at + width) +
             corner * (lanes_at<Wide>(at + width - 1) + lanes_at<Wide>(at + width + 1)));
  }
  return 2.0 * scale * sum_of(sums);
}

template <class Wide>
TORSION_LANES PressureResidual wide_pressure_residual(std::size_t count,
                                                      const double* __restrict depth,
                                                      const double* __restrict depression,
                                                      const double* __restrict pressure) {
  Wide lacking{};
  Wide scale{};
  const Wide none{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide has = lanes_at<Wide>(pressure + k);
    const Wide all = lanes_at<Wide>(depth + k);
    const Wide deep = choose(all > 0.0, all, none);
    const Wide overlap = all - lanes_at<Wide>(depression + k);
    const Wide positive = choose(overlap > 0.0, overlap, none);
    const Wide left = choose(has > 0.0, overlap, positive);
    lacking += left * left;
    scale += deep * deep;
  }
  return {sum_of(lacking), sum_of(scale)};
}

template <class Wide>
TORSION_LANES double wide_mask_preconditioned(std::size_t count, const double* __restrict residual,
                                              double* __restrict preconditioned) {
  Wide sums{};
  const Wide none{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide left = lanes_at<Wide>(residual + k);
    const Wide all = lanes_at<Wide>(preconditioned + k);
    const Wide counted = choose(left != 0.0, all, none);
    store_lanes(counted, preconditioned + k);
    sums += left * counted;
  }
  return sum_of(sums);
}

template <class Wide>
TORSION_LANES double wide_next_pressure_direction(std::size_t count,
                                                  const double* __restrict residual,
                                                  const double* __restrict preconditioned,
                                                  double beta, double* __restrict direction) {
  Wide sums{};
  const Wide none{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide z = lanes_at<Wide>(preconditioned + k);
    const Wide mixed = z + beta * lanes_at<Wide>(direction + k);
    const Wide way = choose(z != 0.0, mixed, none);
    store_lanes(way, direction + k);
    sums += lanes_at<Wide>(residual + k) * way;
  }
  return sum_of(sums);
}

template <class Wide>
TORSION_LANES IterationChange wide_step_pressures(std::size_t count, double alpha,
                                                  const double* __restrict response,
                                                  double* __restrict direction,
                                                  double* __restrict pressure,
                                                  double* __restrict depression, double& tension) {
  Wide most{};
  Wide sums{};
  Wide least{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide way = alpha * lanes_at<Wide>(direction + k);
    const Wide to = lanes_at<Wide>(pressure + k) + way;
    store_lanes(way, direction + k);
    store_lanes(to, pressure + k);
    store_lanes(lanes_at<Wide>(depression + k) + alpha * lanes_at<Wide>(response + k),
                depression + k);
    const Wide size = choose(way < 0.0, -way, way);
    most = choose(size > most, size, most);
    sums += size;
    least = choose(to < least, to, least);
  }
  tension = largest_of(-least);
  return {largest_of(most), sum_of(sums)};
}

template <class Wide>
TORSION_LANES bool wide_release_unloaded(std::size_t count, double least_depth,
                                         const double* __restrict depth,
                                         double* __restrict pressure, double* __restrict traction_x,
                                         double* __restrict traction_y,
                                         double* __restrict change_pressure,
                                         double* __restrict change_x, double* __restrict change_y) {
  const Wide none{};
  Wide lost{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide has = lanes_at<Wide>(pressure + k);
    const Wide has_x = lanes_at<Wide>(traction_x + k);
    const Wide has_y = lanes_at<Wide>(traction_y + k);
    const Wide deep = choose(lanes_at<Wide>(depth + k) > least_depth, has, none);
    const Wide keeps = choose(deep > 0.0, none + 1.0, none);
    store_lanes(has * keeps, pressure + k);
    store_lanes(has_x * keeps, traction_x + k);
    store_lanes(has_y * keeps, traction_y + k);
    store_lanes(has * (keeps - 1.0), change_pressure + k);
    store_lanes(has_x * (keeps - 1.0), change_x + k);
    store_lanes(has_y * (keeps - 1.0), change_y + k);
    lost += (1.0 - keeps) * (has * has + has_x * has_x + has_y * has_y);
  }
  return sum_of(lost) > 0.0;
}

}  // namespace

double dot(std::size_t count, const double* a, const double* b) {
  return TORSION_IN_WIDEST(wide_dot, count, a, b);
}

double dot(std::size_t count, const double* a_x, const double* a_y, const double* b_x,
           const double* b_y) {
  return TORSION_IN_WIDEST(wide_dot_of_pairs, count, a_x, a_y, b_x, b_y);
}

double largest(std::size_t count, const double* values) {
  return TORSION_IN_WIDEST(wide_largest, count, values);
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

void to_border(std::uint32_t side, const double* __restrict cells, double* __restrict bordered) {
  TORSION_IN_WIDEST(wide_to_border, side, cells, bordered);
}

void apply_local_inverse(const LocalInverse& inverse, double scale, std::uint32_t side,
                         const double* __restrict residual, double* __restrict preconditioned) {
  TORSION_IN_WIDEST(wide_apply_local_inverse, inverse, scale, side, residual, preconditioned);
}

double quadratic_form(const LocalInverse& inverse, double scale, std::uint32_t side,
                      const double* __restrict displacement) {
  return TORSION_IN_WIDEST(wide_quadratic_form, inverse, scale, side, displacement);
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

PressureResidual pressure_residual(std::size_t count, const double* __restrict depth,
                                   const double* __restrict depression,
                                   const double* __restrict pressure) {
  return TORSION_IN_WIDEST(wide_pressure_residual, count, depth, depression, pressure);
}

double mask_preconditioned(std::size_t count, const double* __restrict residual,
                           double* __restrict preconditioned) {
  return TORSION_IN_WIDEST(wide_mask_preconditioned, count, residual, preconditioned);
}

double next_pressure_direction(std::size_t count, const double* __restrict residual,
                               const double* __restrict preconditioned, double beta,
                               double* __restrict direction) {
  return TORSION_IN_WIDEST(wide_next_pressure_direction, count, residual, preconditioned, beta,
                           direction);
}

IterationChange step_pressures(std::size_t count, double alpha, const double* __restrict response,
                               double* __restrict direction, double* __restrict pressure,
                               double* __restrict depression, double& tension) {
  return TORSION_IN_WIDEST(wide_step_pressures, count, alpha, response, direction, pressure,
                           depression, tension);
}

TORSION_WIDEST
void find_tension(std::size_t count, const double* __restrict pressure,
                  double* __restrict direction) {
  for (std::size_t k = 0; k < count; ++k) {
    direction[k] = larger(-pressure[k], 0.0);
  }
}

bool release_unloaded(std::size_t count, double least_depth, const double* __restrict depth,
                      double* __restrict pressure, double* __restrict traction_x,
                      double* __restrict traction_y, double* __restrict change_pressure,
                      double* __restrict change_x, double* __restrict change_y) {
  return TORSION_IN_WIDEST(wide_release_unloaded, count, least_depth, depth, pressure, traction_x,
                           traction_y, change_pressure, change_x, change_y);
}

}  // namespace torsion::engine
