#include "systems/patch/cells.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/rims.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"
#include "systems/patch/cell_sums.hpp"
#include "systems/patch/passes.hpp"
#include "systems/patch/sums.hpp"

namespace torsion::engine {
namespace {

constexpr double kLeastBearing = 0.01;  // with less a cell cannot touch

template <class T>
std::span<double> values_of(std::span<T> rows) {
  static_assert(sizeof(T) == sizeof(double));
  return {&rows.front().value, rows.size()};
}

TORSION_WIDEST
void go_with_tool(std::size_t count, const RegionMotion& motion, const double* __restrict x,
                  const double* __restrict y, const double* __restrict from_x,
                  const double* __restrict from_y, double* __restrict target_x,
                  double* __restrict target_y) {
  const double slide_x = motion.slide.x + motion.spin * motion.pivot.y;
  const double slide_y = motion.slide.y - motion.spin * motion.pivot.x;
  const double spin = motion.spin;
  for (std::size_t cell = 0; cell < count; ++cell) {
    target_x[cell] = from_x[cell] + (slide_x - spin * y[cell]);
    target_y[cell] = from_y[cell] + (slide_y + spin * x[cell]);
  }
}

TORSION_WIDEST
void take_off(std::size_t count, const double* __restrict known, const double* __restrict support,
              double* __restrict target) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    target[cell] -= known[cell] * support[cell];
  }
}

/// The cells' starting values: where they are held, or where they have moved to.
TORSION_WIDEST
void find_starts(std::size_t count, const double* __restrict known, const double* __restrict held,
                 const double* __restrict moved, double* __restrict from) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    from[cell] = known[cell] != 0.0 ? held[cell] : moved[cell];
  }
}

/// to = values + share * their last change.
TORSION_WIDEST
void carry_on(std::size_t count, double share, const double* __restrict values,
              const double* __restrict change, double* __restrict to) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    to[cell] = values[cell] + share * change[cell];
  }
}

/// values = now, change = now - values.
TORSION_WIDEST
void take_over(std::size_t count, const double* __restrict now, double* __restrict values,
               double* __restrict change) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    change[cell] = now[cell] - values[cell];
    values[cell] = now[cell];
  }
}

/// Where friction holds a cell that sticks, or where it has left one that slips.
TORSION_WIDEST
void find_held(std::size_t count, const double* __restrict slips, const double* __restrict target,
               const double* __restrict moved, double* __restrict held) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    held[cell] = slips[cell] == 0.0 ? target[cell] : moved[cell];
  }
}

/// to += share * change.
/// @return the sum of the changes' sizes
template <class Wide>
TORSION_LANES double extrapolate(std::size_t count, double share, const double* __restrict change,
                                 double* __restrict to) {
  Wide total{};
  std::size_t cell = 0;
  for (; cell + kLanes <= count; cell += kLanes) {
    const Wide by = lanes_at<Wide>(change + cell);
    store_lanes(lanes_at<Wide>(to + cell) + share * by, to + cell);
    total += choose(by < 0.0, -by, by);
  }
  double sums[kLanes];
  store_lanes(total, sums);
  for (std::size_t lane = 0; cell < count; ++cell, ++lane) {
    to[cell] += share * change[cell];
    sums[lane] += std::abs(change[cell]);
  }
  return sum_of(lanes_at<Wide>(sums));
}

/// Slope and curvature of the complementary energy along a change.
struct Slope {
  double slope = 0.0;      // Pa m, downhill
  double stiffness = 0.0;  // Pa m
};

template <class Wide>
TORSION_LANES void add_slope(std::size_t count, const double* __restrict target,
                             const double* __restrict moved, const double* __restrict change,
                             const double* __restrict moves, Slope& __restrict along) {
  Wide slope{};
  Wide stiffness{};
  std::size_t cell = 0;
  for (; cell + kLanes <= count; cell += kLanes) {
    const Wide to = lanes_at<Wide>(target + cell);
    const Wide by = lanes_at<Wide>(change + cell);
    slope += by * choose(to > kNoContact, to - lanes_at<Wide>(moved + cell), Wide{});
    stiffness += by * lanes_at<Wide>(moves + cell);
  }
  double slopes[kLanes];
  double stiffnesses[kLanes];
  store_lanes(slope, slopes);
  store_lanes(stiffness, stiffnesses);
  for (std::size_t lane = 0; cell < count; ++cell, ++lane) {
    slopes[lane] += change[cell] * (target[cell] > kNoContact ? target[cell] - moved[cell] : 0.0);
    stiffnesses[lane] += change[cell] * moves[cell];
  }
  along.slope += sum_of(lanes_at<Wide>(slopes));
  along.stiffness += sum_of(lanes_at<Wide>(stiffnesses));
}

/// Adds to the slope along the last step's change.
/// @param target, moved  m: wanted displacement, and the present one
/// @param change, moves  Pa, and the displacement that it causes, m
void add_slope(std::span<const double> target, std::span<const double> moved,
               std::span<const double> change, std::span<const double> moves, Slope& along) {
  TORSION_IN_WIDEST(add_slope, target.size(), target.data(), moved.data(), change.data(),
                    moves.data(), along);
}

/// @return the sum of the changes' sizes
double extrapolate(double share, std::span<const double> change, std::span<double> to) {
  return TORSION_IN_WIDEST(extrapolate, change.size(), share, change.data(), to.data());
}

}  // namespace

PatchRows patch_rows(State& state, Range cells) {
  PatchCellTable& table = state.patch_cells;
  return {state.cells.rows<CellGeometry>(cells),
          state.cells.rows<CellTraction>(cells),
          {values_of(table.rows<PatchMovedX>(cells)), values_of(table.rows<PatchMovedY>(cells)),
           values_of(table.rows<PatchDepression>(cells)), values_of(table.rows<PatchHeldX>(cells)),
           values_of(table.rows<PatchHeldY>(cells)), values_of(table.rows<PatchKnown>(cells))},
          {values_of(table.rows<PatchChangeX>(cells)), values_of(table.rows<PatchChangeY>(cells)),
           values_of(table.rows<PatchChangePressure>(cells)),
           values_of(table.rows<PatchChangeMovedX>(cells)),
           values_of(table.rows<PatchChangeMovedY>(cells)),
           values_of(table.rows<PatchChangeDepression>(cells))}};
}

bool load_cells(const PatchRows& rows, const Friction& friction, const PatchColumns& columns,
                const PatchPlaces& places) {
  const std::size_t count = rows.geometry.size();
  const PatchColumns to = columns;
  const PatchPlaces at = places;
  const double fall = friction.dynamic_friction - friction.static_friction;
  bool rims = false;
  for (std::size_t cell = 0; cell < count; ++cell) {
    const CellGeometry& geometry = rows.geometry[cell];
    const CellTraction& traction = rows.tractions[cell];
    const bool bears = geometry.bearing > kLeastBearing;
    rims |= bears && geometry.bearing < 1.0;
    to.depth[cell] = bears ? geometry.depth : kNoContact;
    at.share[cell] = geometry.coverage;
    at.height[cell] = geometry.height;
    to.friction[cell] = friction.static_friction + traction.kinetic_share * fall;
    to.pressure[cell] = traction.pressure;
    to.traction_x[cell] = -traction.traction.x;
    to.traction_y[cell] = -traction.traction.y;
  }
  for (std::size_t cell = 0; rims && cell < count; ++cell) {
    const double bearing = rows.geometry[cell].bearing;
    const double softness = bearing > kLeastBearing ? kRimSoftness * (1.0 / bearing - 1.0) : 0.0;
    at.softness[cell] = softness;
    at.root[cell] = 1.0 / std::sqrt(1.0 + softness);
  }
  return rims;
}

void find_starts(const PatchRows& rows, const PatchPlaces& places) {
  const std::size_t count = rows.geometry.size();
  const PatchSurface& from = rows.surface;
  find_starts(count, from.known.data(), from.held_x.data(), from.moved_x.data(),
              places.from_x.data());
  find_starts(count, from.known.data(), from.held_y.data(), from.moved_y.data(),
              places.from_y.data());
}

void add_rims(const PatchProblem& problem, const PatchColumns& columns, const PatchRows& rows,
              double sign) {
  const PatchSurface& surface = rows.surface;
  const PatchChange& change = rows.change;
  add_rims(problem, InfluenceKind::kXX, sign, columns.traction_x, surface.moved_x);
  add_rims(problem, InfluenceKind::kYY, sign, columns.traction_y, surface.moved_y);
  add_rims(problem, InfluenceKind::kZZ, sign, columns.pressure, surface.depression);
  add_rims(problem, InfluenceKind::kXX, sign, change.traction_x, change.moved_x);
  add_rims(problem, InfluenceKind::kYY, sign, change.traction_y, change.moved_y);
  add_rims(problem, InfluenceKind::kZZ, sign, change.pressure, change.depression);
}

ExtrapolationShares best_shares(const PatchRows& rows, const PatchColumns& columns, bool coupled,
                                double most) {
  const PatchSurface& from = rows.surface;
  const PatchChange& change = rows.change;
  Slope normal;
  add_slope(columns.depth, from.depression, change.pressure, change.depression, normal);
  Slope tangential;
  add_slope(columns.target_x, from.moved_x, change.traction_x, change.moved_x, tangential);
  add_slope(columns.target_y, from.moved_y, change.traction_y, change.moved_y, tangential);
  if (coupled) {
    normal.slope += tangential.slope;
    normal.stiffness += tangential.stiffness;
    tangential = normal;
  }
  const auto share = [most](const Slope& along) {
    return along.stiffness > 0.0 ? std::clamp(along.slope / along.stiffness, 0.0, most) : 0.0;
  };
  return {share(normal), share(tangential)};
}

void extrapolate_cells(const PatchRows& rows, const ExtrapolationShares& shares,
                       const PatchColumns& columns, PatchProblem& problem) {
  const auto [normal, tangential] = shares;
  const std::size_t count = rows.geometry.size();
  const PatchSurface& from = rows.surface;
  const PatchChange& change = rows.change;
  const PatchColumns to = columns;
  carry_on(count, tangential, from.moved_x.data(), change.moved_x.data(), to.moved_x.data());
  carry_on(count, tangential, from.moved_y.data(), change.moved_y.data(), to.moved_y.data());
  carry_on(count, normal, from.depression.data(), change.depression.data(), to.depression.data());
  if (normal > 0.0) {
    problem.extrapolated_pressure = normal * extrapolate(normal, change.pressure, to.pressure);
  }
  if (tangential > 0.0) {
    problem.extrapolated_traction =
        tangential * (extrapolate(tangential, change.traction_x, to.traction_x) +
                      extrapolate(tangential, change.traction_y, to.traction_y));
  }
}

void store_cells(const PatchColumns& columns, std::span<const double> support_x,
                 std::span<const double> support_y, const PatchRows& rows) {
  const std::size_t count = rows.tractions.size();
  const PatchColumns from = columns;
  const PatchChange to = rows.change;
  for (std::size_t cell = 0; cell < count; ++cell) {
    CellTraction& traction = rows.tractions[cell];
    const double x = from.traction_x[cell];
    const double y = from.traction_y[cell];
    const double pressure = from.pressure[cell];
    to.traction_x[cell] = x + traction.traction.x;
    to.traction_y[cell] = y + traction.traction.y;
    to.pressure[cell] = pressure - traction.pressure;
    traction.traction = {-x, -y};
    traction.pressure = pressure;
    // Without branches, which a contact's ragged rim would often mispredict.
    traction.coverage = static_cast<double>(pressure > 0.0);
    const double moved_x = from.moved_x[cell];
    const double moved_y = from.moved_y[cell];
    double slide = 0.0;
    slide_beyond_rounding(x, y, from.target_x[cell] - moved_x, from.target_y[cell] - moved_y,
                          moved_x, moved_y, slide);
    traction.sticks = static_cast<std::uint32_t>((from.slips[cell] == 0.0) | !(slide > 0.0));
  }
  const PatchSurface& surface = rows.surface;
  take_over(count, from.moved_x.data(), surface.moved_x.data(), to.moved_x.data());
  take_over(count, from.moved_y.data(), surface.moved_y.data(), to.moved_y.data());
  take_over(count, from.depression.data(), surface.depression.data(), to.depression.data());
  const double* const slips = from.slips.data();
  find_held(count, slips, from.target_x.data(), from.moved_x.data(), surface.held_x.data());
  find_held(count, slips, from.target_y.data(), from.moved_y.data(), surface.held_y.data());
  add_scaled(support_x.size(), 1.0, support_x.data(), surface.held_x.data());
  add_scaled(support_y.size(), 1.0, support_y.data(), surface.held_y.data());
  std::ranges::fill(surface.known, 1.0);
}

void set_targets(const RegionMotion& motion, const PatchPlaces& places,
                 const PatchColumns& columns) {
  go_with_tool(columns.target_x.size(), motion, places.x.data(), places.y.data(),
               places.from_x.data(), places.from_y.data(), columns.target_x.data(),
               columns.target_y.data());
}

void take_off_support(std::span<const double> known, std::span<const double> support_x,
                      std::span<const double> support_y, const PatchColumns& columns) {
  take_off(known.size(), known.data(), support_x.data(), columns.target_x.data());
  take_off(known.size(), known.data(), support_y.data(), columns.target_y.data());
}

}  // namespace torsion::engine
