#include "systems/scratch.hpp"

namespace torsion {

void Scratch::reserve(const World& world) {
  const std::uint32_t samples = world.samples.size();
  const std::uint32_t bodies = world.bodies.size();
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  sample_states.assign(samples, SampleState{});
  found_samples.assign((samples + 63) / 64, 0);
  walk.reserve(world.balls.size());
  candidates.reserve(samples);
  // Every sample of every tool may be inside every body.
  const std::size_t most_points = std::size_t{samples} * bodies;
  points.reserve(most_points);
  near_pairs.reserve(most_points * kSampleNeighbours);
  pairs.reserve(std::size_t{world.tools.size()} * bodies);
  order.assign(2 * std::size_t{samples}, 0);
  parent.assign(samples, 0);
  cluster_points.reserve(samples);
  owners.reserve(samples);
  overlaps.reserve(std::size_t{kMaxRegionsPerBody} * samples);
  region_commands.reserve(world.regions.capacity());
  region_points.assign(world.regions.capacity(), RegionPoints{});
  main_beams.assign(world.sections.empty() ? 0 : world.regions.capacity(), MainBeam{});
  const std::size_t cells = std::size_t{side} * side;
  const bool patches = !world.patch_cells.empty();
  // Columns end in zeros up to a multiple of 8, so that loops may take eight cells at a time.
  const std::size_t stride = (cells + 7) / 8 * 8;
  const std::size_t columns = patches ? 48 : 26;
  column_memory.reserve(static_cast<std::uint32_t>(columns * stride));
  std::size_t next = 0;
  const auto column = [&] {
    return std::span<double>(column_memory.data() + stride * next++, cells);
  };
  for (DistanceColumns* found : {&cell_columns.points, &left_cells.points}) {
    for (std::span<double>* each : {&found->x, &found->y, &found->z, &found->value,
                                    &found->gradient_x, &found->gradient_y, &found->gradient_z}) {
      *each = column();
    }
  }
  for (std::span<double>* each :
       {&cell_columns.tool_x, &cell_columns.tool_y, &cell_columns.depth, &cell_columns.depth_change,
        &cell_columns.coverage, &cell_columns.bearing, &cell_columns.rim_share,
        &cell_columns.rim_bearing, &left_cells.tool_x, &left_cells.tool_y,
        &cell_columns.gradient_square, &left_cells.gradient_square}) {
    *each = column();
  }
  cell_memory.assign(cells, 0);
  left_cells.cells = cell_memory;
  if (!world.footings.empty()) {
    constexpr std::size_t kRows = std::size_t{6} * kMaxRegionsPerBody;
    compliance_matrix.resize(kRows * kRows);
    compliance_copy.resize(kRows * kRows);
    compliance_inverse.resize(kRows * kRows);
    compliance_residuals.resize(kRows);
  }
  if (!world.mdr_layers.empty()) {
    mdr_tables = make_mdr_tables();
  }
  if (patches) {
    PatchColumns& patch = patch_columns;
    for (std::span<double>* each :
         {&patch.depth,       &patch.friction,      &patch.target_x,      &patch.target_y,
          &patch.pressure,    &patch.traction_x,    &patch.traction_y,    &patch.depression,
          &patch.moved_x,     &patch.moved_y,       &patch.slips,         &patch_places.x,
          &patch_places.y,    &patch_places.height, &patch_places.share,  &patch_places.softness,
          &patch_places.root, &patch_places.from_x, &patch_places.from_y, &support_columns.x,
          &support_columns.y, &support_columns.z}) {
      *each = column();
    }
    if (!world.footings.empty()) {
      patch_support.assign(kSupportTerms * stride, 0.0);
      disc_stiffness = make_disc_stiffness();
    }
    ring_profiles = make_ring_profiles();
    patch_work.reserve(side);
    held_before.x.assign(cells, 0.0);
    held_before.y.assign(cells, 0.0);
    tractions_before.assign(cells, CellTraction{});
  }
  carried_cells.assign(std::size_t{side + 2} * (side + 2), CarriedCell(0.0));
  near_parts.assign(world.parts.size(), 0);
}

}  // namespace torsion
