#include "systems/contact_models/patch_cells.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include "systems/contact_models/patch_passes.hpp"
#include "systems/frames.hpp"
#include "systems/widest.hpp"

namespace torsion {
namespace {

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

/// What counts how often: 1 for every cell with pressure, and for those of them that stick.
TORSION_WIDEST
void find_loaded(std::size_t count, const double* __restrict pressure,
                 const double* __restrict slips, double* __restrict loaded,
                 double* __restrict sticks) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    const double one = pressure[cell] > 0.0 ? 1.0 : 0.0;
    loaded[cell] = one;
    sticks[cell] = one * (1.0 - slips[cell]);
  }
}

TORSION_WIDEST
void multiply(std::size_t count, const double* __restrict a, const double* __restrict b,
              double* __restrict product) {
  for (std::size_t cell = 0; cell < count; ++cell) {
    product[cell] = a[cell] * b[cell];
  }
}

}  // namespace

void load_cells(const PatchRows& rows, const Friction& friction, double share,
                const PatchColumns& columns, const PatchPlaces& places, PatchWork& work,
                PatchProblem& problem) {
  const std::size_t count = rows.cells.size();
  const PatchColumns to = columns;
  const PatchPlaces at = places;
  const double fall = friction.dynamic_friction - friction.static_friction;
  double* const change_x = work.change_x.data();
  double* const change_y = work.change_y.data();
  double* const change_pressure = work.change_pressure.data();
  for (std::size_t cell = 0; cell < count; ++cell) {
    const CellGeometry& geometry = rows.geometry[cell];
    const CellTraction& traction = rows.tractions[cell];
    to.depth[cell] = geometry.coverage >= 0.5 ? geometry.depth : kNoContact;
    at.height[cell] = geometry.height;
    to.friction[cell] = friction.static_friction + traction.kinetic_share * fall;
    to.pressure[cell] = traction.pressure;
    to.traction_x[cell] = -traction.traction.x;
    to.traction_y[cell] = -traction.traction.y;
  }
  for (std::size_t cell = 0; cell < count; ++cell) {
    const PatchCell& held = rows.cells[cell];
    const bool known = held.known != 0;
    at.from_x[cell] = known ? held.held.x : held.displacement.x;
    at.from_y[cell] = known ? held.held.y : held.displacement.y;
    at.known[cell] = known ? 1.0 : 0.0;
    to.depression[cell] = held.depression;
    to.moved_x[cell] = held.displacement.x;
    to.moved_y[cell] = held.displacement.y;
  }
  if (share == 0.0) {
    return;
  }
  for (std::size_t cell = 0; cell < count; ++cell) {
    const PatchChange& change = rows.changes[cell];
    change_pressure[cell] = change.pressure;
    change_x[cell] = change.traction.x;
    change_y[cell] = change.traction.y;
    to.depression[cell] += share * change.depression;
    to.moved_x[cell] += share * change.displacement.x;
    to.moved_y[cell] += share * change.displacement.y;
  }
  add_scaled(count, share, change_pressure, to.pressure.data());
  add_scaled(count, share, change_x, to.traction_x.data());
  add_scaled(count, share, change_y, to.traction_y.data());
  const std::size_t whole = whole_lanes(count);
  problem.foreseen_pressure = share * size_of_change(whole, change_pressure).sum;
  problem.foreseen_traction =
      share * (size_of_change(whole, change_x).sum + size_of_change(whole, change_y).sum);
}

void store_cells(const PatchColumns& columns, std::span<const double> support_x,
                 std::span<const double> support_y, const PatchRows& rows) {
  const PatchColumns from = columns;
  for (std::size_t cell = 0; cell < rows.cells.size(); ++cell) {
    PatchCell& at = rows.cells[cell];
    CellTraction& traction = rows.tractions[cell];
    const glm::dvec2 on_body(from.traction_x[cell], from.traction_y[cell]);
    const glm::dvec2 moved(from.moved_x[cell], from.moved_y[cell]);
    const double pressure = from.pressure[cell];
    const double depression = from.depression[cell];
    const bool sticks = from.slips[cell] == 0.0;
    rows.changes[cell] = {on_body + traction.traction, pressure - traction.pressure,
                          moved - at.displacement, depression - at.depression};
    at.displacement = moved;
    at.depression = depression;
    at.held = {(sticks ? from.target_x[cell] : moved.x) + support_x[cell],
               (sticks ? from.target_y[cell] : moved.y) + support_y[cell]};
    at.known = 1;
    traction.traction = -on_body;
    traction.pressure = pressure;
    traction.coverage = pressure > 0.0 ? 1.0 : 0.0;
    traction.sticks = sticks ? 1U : 0U;
  }
}

void set_targets(const RegionMotion& motion, const PatchPlaces& places,
                 std::span<const double> support_x, std::span<const double> support_y,
                 const PatchColumns& columns) {
  const std::size_t count = columns.target_x.size();
  go_with_tool(count, motion, places.x.data(), places.y.data(), places.from_x.data(),
               places.from_y.data(), columns.target_x.data(), columns.target_y.data());
  take_off(count, places.known.data(), support_x.data(), columns.target_x.data());
  take_off(count, places.known.data(), support_y.data(), columns.target_y.data());
}

PatchSums sum_cells(const PatchColumns& columns, const PatchPlaces& places, double cell_area,
                    PatchWork& work) {
  const std::size_t count = whole_lanes(columns.pressure.size());
  const auto sum = [count](const auto& a, const auto& b) {
    return dot(count, a.data(), b.data());
  };
  std::vector<double>& loaded = work.step_x;
  std::vector<double>& sticks = work.step_y;
  find_loaded(columns.pressure.size(), columns.pressure.data(), columns.slips.data(), loaded.data(),
              sticks.data());
  PatchSums sums;
  const double pressure = sum(columns.pressure, loaded);
  if (pressure <= 0.0) {
    return sums;
  }
  std::vector<double>& by_x = work.moves_x;  // pressure times place
  std::vector<double>& by_y = work.moves_y;
  multiply(count, columns.pressure.data(), places.x.data(), by_x.data());
  multiply(count, columns.pressure.data(), places.y.data(), by_y.data());
  sums.force = pressure * cell_area;
  sums.center = glm::dvec2(sum(by_x, loaded), sum(by_y, loaded)) / pressure;
  sums.height = sum(columns.pressure, places.height) / pressure;
  sums.depth = sum(columns.pressure, columns.depth) / pressure;
  sums.moved =
      glm::dvec2(sum(columns.pressure, columns.moved_x), sum(columns.pressure, columns.moved_y)) /
      pressure;
  const double moment = sum(by_x, columns.moved_y) - sum(by_y, columns.moved_x) -
                        pressure * (sums.center.x * sums.moved.y - sums.center.y * sums.moved.x);
  const double second_moment =
      sum(by_x, places.x) + sum(by_y, places.y) - pressure * glm::dot(sums.center, sums.center);
  sums.turn = second_moment > 0.0 ? moment / second_moment : 0.0;
  // The columns' tractions are on the body.
  sums.friction =
      -cell_area * glm::dvec2(sum(columns.traction_x, loaded), sum(columns.traction_y, loaded));
  sums.couple =
      -cell_area * (sum(places.x, columns.traction_y) - sum(places.y, columns.traction_x));
  sums.loaded_cells = sum(loaded, loaded);
  sums.stuck_cells = sum(sticks, loaded);
  return sums;
}

}  // namespace torsion
