#include "systems/contact_models/patch_passes.hpp"

#include <array>
#include <cmath>

#include "systems/distance_shapes.hpp"
#include "systems/widest.hpp"

namespace torsion {
namespace {

constexpr double kLeast = 1e-300;  // keeps 0 / 0 away

using Lanes = std::array<double, kPatchLanes>;

double sum(const Lanes& lanes) {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) +
         ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

double largest(const Lanes& lanes) {
  double most = 0.0;
  for (const double lane : lanes) {
    most = larger(most, lane);
  }
  return most;
}

TORSION_WIDEST
void sum_products(std::size_t count, const double* __restrict a, const double* __restrict b,
                  Lanes& __restrict lanes) {
  Lanes sums{};
  for (std::size_t first = 0; first < count; first += kPatchLanes) {
    for (std::size_t lane = 0; lane < kPatchLanes; ++lane) {
      sums[lane] += a[first + lane] * b[first + lane];
    }
  }
  lanes = sums;
}

TORSION_WIDEST
void add_to(std::size_t count, double scale, const double* __restrict values,
            double* __restrict to) {
  for (std::size_t k = 0; k < count; ++k) {
    to[k] += scale * values[k];
  }
}

/// Rows [first, end) of bordered columns.
TORSION_WIDEST
void ask_neighbours(const LocalInverse& inverse, std::size_t width, std::size_t first,
                    std::size_t end, const double* __restrict wanted, double* __restrict asked) {
  const double here = inverse.here;
  const double along_x = inverse.along_x;
  const double along_y = inverse.along_y;
  const double corner = inverse.corner;
  const double* const low = wanted - width;
  const double* const high = wanted + width;
  for (std::size_t k = first; k < end; ++k) {
    // Sums in pairs, so that a mirror image has the same bits.
    asked[k] = here * wanted[k] + along_x * (wanted[k - 1] + wanted[k + 1]) +
               along_y * (low[k] + high[k]) +
               corner * ((low[k - 1] + high[k + 1]) + (low[k + 1] + high[k - 1]));
  }
}

TORSION_WIDEST
void overlaps(std::size_t count, const double* __restrict depth,
              const double* __restrict depression, const double* __restrict pressure,
              double* __restrict residual) {
  for (std::size_t k = 0; k < count; ++k) {
    const double overlap = depth[k] - depression[k];
    residual[k] = larger(pressure[k], overlap) > 0.0 ? overlap : 0.0;
  }
}

TORSION_WIDEST
void find_largest(std::size_t count, const double* __restrict values, Lanes& __restrict most) {
  Lanes high{};
  for (std::size_t first = 0; first < count; first += kPatchLanes) {
    for (std::size_t lane = 0; lane < kPatchLanes; ++lane) {
      high[lane] = larger(values[first + lane], high[lane]);
    }
  }
  most = high;
}

/// @param squares  residual times asked, out
TORSION_WIDEST
void keep(std::size_t count, const double* __restrict residual, double* __restrict asked,
          Lanes& __restrict squares) {
  Lanes sums{};
  for (std::size_t first = 0; first < count; first += kPatchLanes) {
    for (std::size_t lane = 0; lane < kPatchLanes; ++lane) {
      const std::size_t k = first + lane;
      const double kept = residual[k] != 0.0 ? asked[k] : 0.0;
      asked[k] = kept;
      sums[lane] += residual[k] * kept;
    }
  }
  squares = sums;
}

/// @param slopes  residual times step, out
TORSION_WIDEST
void mix_steps(std::size_t count, const double* __restrict residual, const double* __restrict asked,
               double kept, double* __restrict step, Lanes& __restrict slopes) {
  Lanes sums{};
  for (std::size_t first = 0; first < count; first += kPatchLanes) {
    for (std::size_t lane = 0; lane < kPatchLanes; ++lane) {
      const std::size_t k = first + lane;
      const double mixed = asked[k] + kept * step[k];
      const double way = asked[k] != 0.0 ? mixed : 0.0;
      step[k] = way;
      sums[lane] += residual[k] * way;
    }
  }
  slopes = sums;
}

/// Goes `length` of a step of the pressures.
/// @param most, sums  of the changes' sizes, out
/// @param pulls       the largest negative pressures, out
TORSION_WIDEST
void change(std::size_t count, double length, const double* __restrict moves,
            double* __restrict step, double* __restrict pressure, double* __restrict depression,
            Lanes& __restrict most, Lanes& __restrict sums, Lanes& __restrict pulls) {
  Lanes high{};
  Lanes total{};
  Lanes pull{};
  for (std::size_t first = 0; first < count; first += kPatchLanes) {
    for (std::size_t lane = 0; lane < kPatchLanes; ++lane) {
      const std::size_t k = first + lane;
      const double way = length * step[k];
      const double to = pressure[k] + way;
      step[k] = way;
      pressure[k] = to;
      depression[k] += length * moves[k];
      high[lane] = larger(std::abs(way), high[lane]);
      total[lane] += std::abs(way);
      pull[lane] = larger(-to, pull[lane]);
    }
  }
  most = high;
  sums = total;
  pulls = pull;
}

/// Goes `length` of a step of the tractions.
TORSION_WIDEST
void change_both(const TractionColumns& cells, double length, Lanes& __restrict most,
                 Lanes& __restrict sums) {
  Lanes high{};
  Lanes total{};
  const double* __restrict const moves_x = cells.moves_x;
  const double* __restrict const moves_y = cells.moves_y;
  double* __restrict const step_x = cells.step_x;
  double* __restrict const step_y = cells.step_y;
  double* __restrict const traction_x = cells.traction_x;
  double* __restrict const traction_y = cells.traction_y;
  double* __restrict const moved_x = cells.moved_x;
  double* __restrict const moved_y = cells.moved_y;
  for (std::size_t first = 0; first < cells.count; first += kPatchLanes) {
    for (std::size_t lane = 0; lane < kPatchLanes; ++lane) {
      const std::size_t k = first + lane;
      const double way_x = length * step_x[k];
      const double way_y = length * step_y[k];
      step_x[k] = way_x;
      step_y[k] = way_y;
      traction_x[k] += way_x;
      traction_y[k] += way_y;
      moved_x[k] += length * moves_x[k];
      moved_y[k] += length * moves_y[k];
      high[lane] = larger(larger(std::abs(way_x), std::abs(way_y)), high[lane]);
      total[lane] += std::abs(way_x) + std::abs(way_y);
    }
  }
  most = high;
  sums = total;
}

/// 1 for cells that can carry a load or have to lose one, else 0.
TORSION_WIDEST
void loads(std::size_t count, const double* __restrict friction, const double* __restrict pressure,
           const double* __restrict traction_x, const double* __restrict traction_y,
           double* __restrict loaded) {
  for (std::size_t k = 0; k < count; ++k) {
    const double traction = larger(std::abs(traction_x[k]), std::abs(traction_y[k]));
    loaded[k] = larger(friction[k] * pressure[k], traction) > 0.0 ? 1.0 : 0.0;
  }
}

TORSION_WIDEST
void pulls(std::size_t count, const double* __restrict pressure, double* __restrict step) {
  for (std::size_t k = 0; k < count; ++k) {
    step[k] = larger(-pressure[k], 0.0);
  }
}

TORSION_WIDEST
void lose(std::size_t count, double least_depth, const double* __restrict depth,
          double* __restrict pressure, double* __restrict traction_x, double* __restrict traction_y,
          double* __restrict change_pressure, double* __restrict change_x,
          double* __restrict change_y) {
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

TORSION_WIDEST
void ways(std::size_t count, double stiffness, const double* __restrict traction_x,
          const double* __restrict traction_y, const double* __restrict target_x,
          const double* __restrict target_y, const double* __restrict moved_x,
          const double* __restrict moved_y, const double* __restrict limits,
          double* __restrict slips, double* __restrict residual_x, double* __restrict residual_y,
          double* __restrict along_x, double* __restrict along_y, double* __restrict softened) {
  for (std::size_t k = 0; k < count; ++k) {
    const double left_x = target_x[k] - moved_x[k];
    const double left_y = target_y[k] - moved_y[k];
    const double trial_x = traction_x[k] + stiffness * left_x;
    const double trial_y = traction_y[k] + stiffness * left_y;
    const double limit = limits[k];
    const bool at_limit = trial_x * trial_x + trial_y * trial_y > limit * limit;
    const double held =
        traction_x[k] * traction_x[k] + traction_y[k] * traction_y[k] - 0.25 * limit * limit;
    const double x = held > 0.0 ? traction_x[k] : trial_x;
    const double y = held > 0.0 ? traction_y[k] : trial_y;
    const double inverse = 1.0 / std::sqrt(larger(x * x + y * y, kLeast));
    const double unit_x = x * inverse;
    const double unit_y = y * inverse;
    const double slip = larger(left_x * unit_x + left_y * unit_y, 0.0);
    // sqrt(limit / (limit + slip stiffness)): 0 where the limit is
    const double soft = std::sqrt(limit / (larger(limit, kLeast) + slip * stiffness));
    const double across = (unit_x * left_y - unit_y * left_x) * soft;
    slips[k] = at_limit ? 1.0 : 0.0;
    residual_x[k] = at_limit ? -across * unit_y : left_x;
    residual_y[k] = at_limit ? across * unit_x : left_y;
    along_x[k] = unit_x;
    along_y[k] = unit_y;
    softened[k] = at_limit ? soft : 1.0;
  }
}

TORSION_WIDEST
void across(std::size_t count, const double* __restrict slips, const double* __restrict along_x,
            const double* __restrict along_y, const double* __restrict softened,
            double* __restrict x, double* __restrict y) {
  for (std::size_t k = 0; k < count; ++k) {
    const bool slip = slips[k] != 0.0;
    const double answer = softened[k] * (along_x[k] * y[k] - along_y[k] * x[k]);
    const double answer_x = -answer * along_y[k];
    const double answer_y = answer * along_x[k];
    x[k] = slip ? answer_x : x[k];
    y[k] = slip ? answer_y : y[k];
  }
}

/// What every cell comes to, and whether that is on the rim of its disc.
TORSION_WIDEST
void mix_ways(std::size_t count, const Mix& mix, const double* __restrict traction_x,
              const double* __restrict traction_y, const double* __restrict limits,
              const double* __restrict slips, const double* __restrict asked_x,
              const double* __restrict asked_y, const double* __restrict along_x,
              const double* __restrict along_y, const double* __restrict softened,
              double* __restrict step_x, double* __restrict step_y, double* __restrict clips) {
  const double share = mix.asked;
  const double kept = mix.kept;
  for (std::size_t k = 0; k < count; ++k) {
    const bool slip = slips[k] != 0.0;
    const double limit = limits[k];
    const double new_x = share * asked_x[k];
    const double new_y = share * asked_y[k];
    const double across = softened[k] * (along_x[k] * new_y - along_y[k] * new_x) +
                          kept * (along_x[k] * step_y[k] - along_y[k] * step_x[k]);
    const double from_x = slip ? limit * along_x[k] - across * along_y[k]
                               : traction_x[k] + (new_x + kept * step_x[k]);
    const double from_y = slip ? limit * along_y[k] + across * along_x[k]
                               : traction_y[k] + (new_y + kept * step_y[k]);
    const double square = from_x * from_x + from_y * from_y;
    const bool outside = square > limit * limit;
    const double scale = limit / std::sqrt(larger(square, kLeast));
    const double to_x = (slip | outside) ? from_x * scale : from_x;
    const double to_y = (slip | outside) ? from_y * scale : from_y;
    step_x[k] = to_x - traction_x[k];
    step_y[k] = to_y - traction_y[k];
    clips[k] = outside ? 1.0 : 0.0;
  }
}

TORSION_WIDEST
void add_up_step(const TractionColumns& cells, const double* __restrict clips,
                 Lanes& __restrict slopes, Lanes& __restrict slipped, Lanes& __restrict clipped) {
  Lanes slope{};
  Lanes slip{};
  Lanes clip{};
  const double* __restrict const target_x = cells.target_x;
  const double* __restrict const target_y = cells.target_y;
  const double* __restrict const moved_x = cells.moved_x;
  const double* __restrict const moved_y = cells.moved_y;
  const double* __restrict const step_x = cells.step_x;
  const double* __restrict const step_y = cells.step_y;
  const double* __restrict const slips = cells.slips;
  for (std::size_t first = 0; first < cells.count; first += kPatchLanes) {
    for (std::size_t lane = 0; lane < kPatchLanes; ++lane) {
      const std::size_t k = first + lane;
      slope[lane] +=
          (target_x[k] - moved_x[k]) * step_x[k] + (target_y[k] - moved_y[k]) * step_y[k];
      slip[lane] += larger(slips[k], clips[k]);
      clip[lane] += (1.0 - slips[k]) * clips[k];
    }
  }
  slopes = slope;
  slipped = slip;
  clipped = clip;
}

}  // namespace

double dot(std::size_t count, const double* a, const double* b) {
  Lanes lanes;
  sum_products(count, a, b, lanes);
  return sum(lanes);
}

double largest(std::size_t count, const double* values) {
  Lanes most;
  find_largest(count, values, most);
  return largest(most);
}

void add_scaled(std::size_t count, double scale, const double* values, double* to) {
  add_to(count, scale, values, to);
}

void apply_local_inverse(const LocalInverse& inverse, double scale, std::uint32_t side,
                         const double* wanted, double* asked) {
  const std::size_t width = std::size_t{side} + 2;
  const LocalInverse scaled{inverse.here * scale, inverse.along_x * scale, inverse.along_y * scale,
                            inverse.corner * scale};
  ask_neighbours(scaled, width, width + 1, width * (side + 1) - 1, wanted, asked);
}

void find_overlaps(std::size_t count, const double* depth, const double* depression,
                   const double* pressure, double* residual) {
  overlaps(count, depth, depression, pressure, residual);
}

double keep_asked(std::size_t count, const double* residual, double* asked) {
  Lanes squares;
  keep(count, residual, asked, squares);
  return sum(squares);
}

double mix_pressures(std::size_t count, const double* residual, const double* asked, double kept,
                     double* step) {
  Lanes slopes;
  mix_steps(count, residual, asked, kept, step, slopes);
  return sum(slopes);
}

SweepChange change_pressures(std::size_t count, double length, const double* moves, double* step,
                             double* pressure, double* depression, double& pull) {
  Lanes most;
  Lanes sums;
  Lanes pulls;
  change(count, length, moves, step, pressure, depression, most, sums, pulls);
  pull = largest(pulls);
  return {largest(most), sum(sums)};
}

void find_pulls(std::size_t count, const double* pressure, double* step) {
  pulls(count, pressure, step);
}

void lose_cells(std::size_t count, double least_depth, const double* depth, double* pressure,
                double* traction_x, double* traction_y, double* change_pressure, double* change_x,
                double* change_y) {
  lose(count, least_depth, depth, pressure, traction_x, traction_y, change_pressure, change_x,
       change_y);
}

void keep_answered(const TractionColumns& cells, double* x, double* y) {
  across(cells.count, cells.slips, cells.along_x, cells.along_y, cells.softened, x, y);
}

void find_ways(const TractionColumns& cells, double stiffness) {
  ways(cells.count, stiffness, cells.traction_x, cells.traction_y, cells.target_x, cells.target_y,
       cells.moved_x, cells.moved_y, cells.limit, cells.slips, cells.residual_x, cells.residual_y,
       cells.along_x, cells.along_y, cells.softened);
}

TractionStep mix_tractions(const TractionColumns& cells, const Mix& mix) {
  mix_ways(cells.count, mix, cells.traction_x, cells.traction_y, cells.limit, cells.slips,
           cells.asked_x, cells.asked_y, cells.along_x, cells.along_y, cells.softened, cells.step_x,
           cells.step_y, cells.clips);
  Lanes slopes;
  Lanes slipped;
  Lanes clipped;
  add_up_step(cells, cells.clips, slopes, slipped, clipped);
  return {sum(slopes), sum(slipped), sum(clipped)};
}

SweepChange change_tractions(const TractionColumns& cells, double length) {
  Lanes most;
  Lanes sums;
  change_both(cells, length, most, sums);
  return {largest(most), sum(sums)};
}

void find_loads(std::size_t count, const double* friction, const double* pressure,
                const double* traction_x, const double* traction_y, double* loaded) {
  loads(count, friction, pressure, traction_x, traction_y, loaded);
}

}  // namespace torsion
