#include "systems/patch/scratch.hpp"

#include <array>

#include "systems/math/wide_lanes.hpp"

namespace torsion::engine {

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
