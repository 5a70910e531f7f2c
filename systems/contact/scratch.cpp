#include "systems/contact/scratch.hpp"

#include "systems/math/wide_lanes.hpp"

namespace torsion::engine {

LeftCells first_of(const LeftCells& left, std::size_t count) {
  const DistanceColumns& points = left.points;
  return {left.cells.first(count),
          {points.x.first(count), points.y.first(count), points.z.first(count),
           points.value.first(count), points.gradient_x.first(count),
           points.gradient_y.first(count), points.gradient_z.first(count)},
          left.tool_x.first(count),
          left.tool_y.first(count),
          left.gradient_square.first(count)};
}

void lay_columns(std::size_t cells, std::span<std::span<double>* const> columns,
                 Column<double>& memory) {
  const std::size_t stride = whole_lanes(cells);
  memory.reserve(static_cast<std::uint32_t>(columns.size() * stride));
  for (std::size_t column = 0; column < columns.size(); ++column) {
    *columns[column] = {memory.data() + column * stride, cells};
  }
}

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
  pairs.reserve(std::size_t{model.tools.size()} * bodies);
  order.assign(2 * std::size_t{samples}, 0);
  parent.assign(most_points, 0);
  cluster_points.reserve(samples);
  owners.reserve(samples);
  overlaps.reserve(std::size_t{kMaxRegionsPerBody} * samples);
  ended_regions.reserve(state.regions.capacity());
  region_points.assign(state.regions.capacity(), RegionPoints{});
  const std::size_t cells = std::size_t{side} * side;
  std::vector<std::span<double>*> columns{
      &cell_columns.tool_x,       &cell_columns.tool_y,      &cell_columns.depth,
      &cell_columns.depth_change, &cell_columns.coverage,    &cell_columns.bearing,
      &cell_columns.rim_share,    &cell_columns.rim_bearing, &cell_columns.gradient_square,
      &cell_columns.open,         &left_cells.tool_x,        &left_cells.tool_y,
      &left_cells.gradient_square};
  for (DistanceColumns* found : {&cell_columns.points, &left_cells.points}) {
    columns.insert(columns.end(), {&found->x, &found->y, &found->z, &found->value,
                                   &found->gradient_x, &found->gradient_y, &found->gradient_z});
  }
  columns.insert(columns.end(), {&cell_columns.over_body, &cell_columns.under_face});
  lay_columns(cells, columns, column_memory);
  cell_memory.assign(cells, 0);
  left_cells.cells = cell_memory;
  near_parts.assign(model.parts.size(), 0);
  beams.assign(state.regions.capacity(), BeamSpring{});
  support_answers.assign(state.regions.capacity(), SupportAnswer{});
}

}  // namespace torsion::engine
