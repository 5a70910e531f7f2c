#include "systems/patch/scratch.hpp"

#include <array>

#include "systems/half_space/sum_influence.hpp"
#include "systems/math/wide_lanes.hpp"

namespace torsion::engine {

void PatchWork::reserve(std::uint32_t side) {
  const std::size_t count = whole_lanes(std::size_t{side} * side);
  for (std::vector<double>* each : {&residual_x,
                                    &residual_y,
                                    &preconditioned_x,
                                    &preconditioned_y,
                                    &direction_x,
                                    &direction_y,
                                    &response_x,
                                    &response_y,
                                    &response_both,
                                    &limit,
                                    &along_x,
                                    &along_y,
                                    &softened,
                                    &clips,
                                    &change_pressure,
                                    &change_x,
                                    &change_y,
                                    &change_depression,
                                    &depth,
                                    &target_x,
                                    &target_y}) {
    each->assign(count, 0.0);
  }
  for (auto* each : {&rigid_x, &rigid_y, &rigid_tractions_x, &rigid_tractions_y}) {
    each->fill(std::vector<double>(count, 0.0));
  }
  discs.reserve(count);
  bordered.assign(std::size_t{side + 2} * (side + 2) + kLanes, 0.0);
  // One more: the unused last value is written, too.
  for (std::vector<double>* each : {&scales_x, &scales_y, &scales}) {
    each->assign(2 * (most_pairs(side) + 1), 0.0);
  }
  places.assign(most_pairs(side) + 1, 0);
}

void PatchScratch::reserve(const Model& model, const State& state) {
  if (state.patch_cells.empty()) {
    return;
  }
  const std::uint32_t side = model.settings.grid_side;
  const std::size_t cells = std::size_t{side} * side;
  const std::array all{
      &columns.depth,    &columns.friction,   &columns.target_x,   &columns.target_y,
      &columns.pressure, &columns.traction_x, &columns.traction_y, &columns.depression,
      &columns.moved_x,  &columns.moved_y,    &columns.slips,      &places.x,
      &places.y,         &places.height,      &places.share,       &places.softness,
      &places.root,      &places.from_x,      &places.from_y,      &support.x,
      &support.y,        &support.z};
  lay_columns(cells, all, column_memory);
  if (!state.support_fits.empty()) {
    support_terms.assign(kSupportTerms * whole_lanes(cells), 0.0);
    disc_stiffness = make_disc_stiffness();
  }
  work.reserve(side);
  held_before.x.assign(cells, 0.0);
  held_before.y.assign(cells, 0.0);
  tractions_before.assign(cells, CellTraction{});
}

}  // namespace torsion::engine
