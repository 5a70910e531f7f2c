#include <cmath>

#include "systems/math/lanes.hpp"
#include "systems/patch/passes.hpp"

namespace torsion::engine {
namespace {

constexpr double kLeastSum = 1e-300;    // keeps 0 / 0 away
constexpr double kInside = 1.0 + 1e-9;  // of a limit's square

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
    const double held =
        traction_x[k] * traction_x[k] + traction_y[k] * traction_y[k] - 0.25 * limit * limit;
    const double x = held > 0.0 ? traction_x[k] : trial_x;
    const double y = held > 0.0 ? traction_y[k] : trial_y;
    const double inverse = 1.0 / std::sqrt(larger(x * x + y * y, kLeastSum));
    const double unit_x = x * inverse;
    const double unit_y = y * inverse;
    const double outward = left_x * unit_x + left_y * unit_y;
    const double slip = larger(outward, 0.0);
    // What is to move against the friction that it has does not slip, however far.
    const bool at_limit = ((trial_x * trial_x + trial_y * trial_y > limit * limit) &
                           !((held > 0.0) & (outward < 0.0))) |
                          (limit <= 0.0);
    // sqrt(limit / (limit + slip stiffness)): 0 where the limit is
    const double soft = std::sqrt(limit / (larger(limit, kLeastSum) + slip * stiffness));
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

/// The result of every cell, and whether it lies on the rim of its disc.
TORSION_WIDEST
void mix_directions(std::size_t count, const DirectionShares& shares,
                    const double* __restrict traction_x, const double* __restrict traction_y,
                    const double* __restrict limits, const double* __restrict slips,
                    const double* __restrict preconditioned_x,
                    const double* __restrict preconditioned_y, const double* __restrict along_x,
                    const double* __restrict along_y, const double* __restrict softened,
                    double* __restrict direction_x, double* __restrict direction_y,
                    double* __restrict clips) {
  const double share = shares.share;
  const double beta = shares.beta;
  for (std::size_t k = 0; k < count; ++k) {
    const bool slip = slips[k] != 0.0;
    const double limit = limits[k];
    const double new_x = share * preconditioned_x[k];
    const double new_y = share * preconditioned_y[k];
    const double across = softened[k] * (along_x[k] * new_y - along_y[k] * new_x) +
                          beta * (along_x[k] * direction_y[k] - along_y[k] * direction_x[k]);
    const double from_x = slip ? limit * along_x[k] - across * along_y[k]
                               : traction_x[k] + (new_x + beta * direction_x[k]);
    const double from_y = slip ? limit * along_y[k] + across * along_x[k]
                               : traction_y[k] + (new_y + beta * direction_y[k]);
    const double square = from_x * from_x + from_y * from_y;
    const bool outside = square > limit * limit;
    const double scale = limit / std::sqrt(larger(square, kLeastSum));
    const double to_x = (slip | outside) ? from_x * scale : from_x;
    const double to_y = (slip | outside) ? from_y * scale : from_y;
    direction_x[k] = to_x - traction_x[k];
    direction_y[k] = to_y - traction_y[k];
    clips[k] = outside ? 1.0 : 0.0;
  }
}

template <class Wide>
TORSION_LANES void add_up_step(const TractionColumns& cells, TractionStep& __restrict step) {
  Wide slope{};
  Wide slipped{};
  Wide clipped{};
  const Wide none{};
  for (std::size_t k = 0; k < cells.count; k += kLanes) {
    const Wide left_x = lanes_at<Wide>(cells.target_x + k) - lanes_at<Wide>(cells.moved_x + k);
    const Wide left_y = lanes_at<Wide>(cells.target_y + k) - lanes_at<Wide>(cells.moved_y + k);
    const Wide slips = lanes_at<Wide>(cells.slips + k);
    const Wide clips = lanes_at<Wide>(cells.clips + k);
    const Wide has_converged = choose(slips > clips, slips, clips);
    slope += left_x * lanes_at<Wide>(cells.direction_x + k) +
             left_y * lanes_at<Wide>(cells.direction_y + k);
    slipped += choose(lanes_at<Wide>(cells.limit + k) > 0.0, has_converged, none);
    clipped += (1.0 - slips) * clips;
  }
  step = {sum_of(slope), sum_of(slipped), sum_of(clipped)};
}

template <class Wide>
TORSION_LANES double slope_of(const TractionColumns& cells, const double* x, const double* y) {
  Wide slope{};
  for (std::size_t k = 0; k < cells.count; k += kLanes) {
    // The remaining distance is small beside the distance: subtract first.
    const Wide left_x = lanes_at<Wide>(cells.target_x + k) - lanes_at<Wide>(cells.moved_x + k);
    const Wide left_y = lanes_at<Wide>(cells.target_y + k) - lanes_at<Wide>(cells.moved_y + k);
    slope += left_x * lanes_at<Wide>(x + k) + left_y * lanes_at<Wide>(y + k);
  }
  return sum_of(slope);
}

/// @return the largest excess of a traction's square over its limit's square, Pa^2
template <class Wide>
TORSION_LANES double limits(std::size_t count, const double* __restrict pressure,
                            const double* __restrict friction, const double* __restrict traction_x,
                            const double* __restrict traction_y, double* __restrict limit) {
  Wide most{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide x = lanes_at<Wide>(traction_x + k);
    const Wide y = lanes_at<Wide>(traction_y + k);
    const Wide radius = lanes_at<Wide>(friction + k) * lanes_at<Wide>(pressure + k);
    const Wide over = (x * x + y * y) - kInside * radius * radius;
    store_lanes(radius, limit + k);
    most = choose(over > most, over, most);
  }
  return largest_of(most);
}

template <class Wide>
TORSION_LANES void change_both(const TractionColumns& cells, double alpha,
                               IterationChange& __restrict change) {
  Wide most{};
  Wide sums{};
  const auto go = [&most, &sums, alpha ](double* step, double* to) __attribute__((always_inline)) {
    const Wide way = alpha * lanes_at<Wide>(step);
    store_lanes(way, step);
    store_lanes(lanes_at<Wide>(to) + way, to);
    const Wide size = choose(way < 0.0, -way, way);
    most = choose(size > most, size, most);
    sums += size;
  };
  for (std::size_t k = 0; k < cells.count; k += kLanes) {
    go(cells.direction_x + k, cells.traction_x + k);
    go(cells.direction_y + k, cells.traction_y + k);
  }
  change = {largest_of(most), sum_of(sums)};
}

TORSION_WIDEST
void keep_slips(std::size_t count, const double* __restrict traction_x,
                const double* __restrict traction_y, const double* __restrict target_x,
                const double* __restrict target_y, const double* __restrict moved_x,
                const double* __restrict moved_y, double* __restrict slips) {
  for (std::size_t k = 0; k < count; ++k) {
    const double along =
        traction_x[k] * (target_x[k] - moved_x[k]) + traction_y[k] * (target_y[k] - moved_y[k]);
    slips[k] = along < 0.0 ? 0.0 : slips[k];
  }
}

/// (q - P(q + k s)) / k: how far a cell's traction deviates from what its slip requires.
TORSION_WIDEST
void find_lacking(std::size_t count, double stiffness, const double* __restrict limits,
                  const double* __restrict traction_x, const double* __restrict traction_y,
                  const double* __restrict target_x, const double* __restrict target_y,
                  const double* __restrict moved_x, const double* __restrict moved_y,
                  double* __restrict lacking_x, double* __restrict lacking_y) {
  const double compliance = 1.0 / stiffness;
  for (std::size_t k = 0; k < count; ++k) {
    const double trial_x = traction_x[k] + stiffness * (target_x[k] - moved_x[k]);
    const double trial_y = traction_y[k] + stiffness * (target_y[k] - moved_y[k]);
    const double square = trial_x * trial_x + trial_y * trial_y;
    const double limit = limits[k];
    const double rim = limit / std::sqrt(larger(square, kLeastSum));
    const double share = square > limit * limit ? rim : 1.0;
    lacking_x[k] = compliance * (traction_x[k] - share * trial_x);
    lacking_y[k] = compliance * (traction_y[k] - share * trial_y);
  }
}

/// Sum of (friction's coefficient times depth)^2 over the cells with pressure.
template <class Wide>
TORSION_LANES double slip_scale(std::size_t count, const double* __restrict pressure,
                                const double* __restrict friction, const double* __restrict depth) {
  Wide sums{};
  const Wide none{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide deep = choose(lanes_at<Wide>(pressure + k) > 0.0, lanes_at<Wide>(depth + k), none);
    const Wide slip = lanes_at<Wide>(friction + k) * deep;
    sums += slip * slip;
  }
  return sum_of(sums);
}

}  // namespace

bool find_limits(const TractionColumns& cells) {
  return TORSION_IN_WIDEST(limits, cells.count, cells.pressure, cells.friction, cells.traction_x,
                           cells.traction_y, cells.limit) > 0.0;
}

void find_residuals(const TractionColumns& cells, double stiffness) {
  ways(cells.count, stiffness, cells.traction_x, cells.traction_y, cells.target_x, cells.target_y,
       cells.moved_x, cells.moved_y, cells.limit, cells.slips, cells.residual_x, cells.residual_y,
       cells.along_x, cells.along_y, cells.softened);
}

void project_on_tangents(const TractionColumns& cells, double* x, double* y) {
  across(cells.count, cells.slips, cells.along_x, cells.along_y, cells.softened, x, y);
}

TractionStep next_traction_direction(const TractionColumns& cells, const DirectionShares& shares) {
  mix_directions(cells.count, shares, cells.traction_x, cells.traction_y, cells.limit, cells.slips,
                 cells.preconditioned_x, cells.preconditioned_y, cells.along_x, cells.along_y,
                 cells.softened, cells.direction_x, cells.direction_y, cells.clips);
  TractionStep step;
  TORSION_IN_WIDEST(add_up_step, cells, step);
  return step;
}

double slope_along(const TractionColumns& cells, const double* x, const double* y) {
  return TORSION_IN_WIDEST(slope_of, cells, x, y);
}

IterationChange step_tractions(const TractionColumns& cells, double alpha) {
  IterationChange change;
  TORSION_IN_WIDEST(change_both, cells, alpha, change);
  add_scaled(cells.count, alpha, cells.response_x, cells.moved_x);
  add_scaled(cells.count, alpha, cells.response_y, cells.moved_y);
  return change;
}

TractionResidual traction_residual(const TractionColumns& cells, const double* depth,
                                   double stiffness) {
  find_lacking(cells.count, stiffness, cells.limit, cells.traction_x, cells.traction_y,
               cells.target_x, cells.target_y, cells.moved_x, cells.moved_y, cells.residual_x,
               cells.residual_y);
  return {dot(cells.count, cells.residual_x, cells.residual_y, cells.residual_x, cells.residual_y),
          TORSION_IN_WIDEST(slip_scale, cells.count, cells.pressure, cells.friction, depth)};
}

void clear_false_slip(const TractionColumns& cells) {
  keep_slips(cells.count, cells.traction_x, cells.traction_y, cells.target_x, cells.target_y,
             cells.moved_x, cells.moved_y, cells.slips);
}

}  // namespace torsion::engine
