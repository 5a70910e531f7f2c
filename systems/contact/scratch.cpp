#include "systems/contact/scratch.hpp"

namespace torsion {

void ContactScratch::reserve(const Model& model, const State& state) {
  const std::uint32_t samples = model.samples.size();
  const std::uint32_t bodies = model.bodies.size();
  const std::uint32_t side = model.settings.grid_side;
  sample_states.assign(samples, SampleState{});
  found_samples.assign((samples + 63) / 64, 0);
  walk.reserve(model.balls.size());
  candidates.reserve(samples);
  // Every sample of every tool may be inside every body.
  const std::size_t most_points = std::size_t{samples} * bodies;
  points.reserve(most_points);
  near_pairs.reserve(most_points * kSampleNeighbours);
  pairs.reserve(std::size_t{model.tools.size()} * bodies);
  order.assign(2 * std::size_t{samples}, 0);
  parent.assign(samples, 0);
  cluster_points.reserve(samples);
  owners.reserve(samples);
  overlaps.reserve(std::size_t{kMaxRegionsPerBody} * samples);
  ended_regions.reserve(state.regions.capacity());
  region_points.assign(state.regions.capacity(), RegionPoints{});
  const std::size_t cells = std::size_t{side} * side;
  column_memory.reserve(26, cells);
  for (DistanceColumns* found : {&cell_columns.points, &left_cells.points}) {
    for (std::span<double>* each : {&found->x, &found->y, &found->z, &found->value,
                                    &found->gradient_x, &found->gradient_y, &found->gradient_z}) {
      *each = column_memory.take();
    }
  }
  for (std::span<double>* each :
       {&cell_columns.tool_x, &cell_columns.tool_y, &cell_columns.depth, &cell_columns.depth_change,
        &cell_columns.coverage, &cell_columns.bearing, &cell_columns.rim_share,
        &cell_columns.rim_bearing, &left_cells.tool_x, &left_cells.tool_y,
        &cell_columns.gradient_square, &left_cells.gradient_square}) {
    *each = column_memory.take();
  }
  cell_memory.assign(cells, 0);
  left_cells.cells = cell_memory;
  near_parts.assign(model.parts.size(), 0);
  beams.assign(state.regions.capacity(), BeamSpring{});
}

}  // namespace torsion
