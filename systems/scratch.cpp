#include "systems/scratch.hpp"

namespace torsion {

void Scratch::reserve(const World& world) {
  const std::uint32_t samples = world.samples.size();
  const std::uint32_t bodies = world.bodies.size();
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  sample_distance.assign(samples, 0.0);
  sample_stamp.assign(samples, 0);
  candidates.reserve(samples);
  // Every sample of every tool may be inside every body.
  const std::size_t most_points = std::size_t{samples} * bodies;
  points.reserve(most_points);
  pairs.reserve(std::size_t{world.tools.size()} * bodies);
  order.assign(2 * std::size_t{samples}, 0);
  parent.assign(samples, 0);
  cluster_points.reserve(samples);
  owners.reserve(samples);
  overlaps.reserve(std::size_t{kMaxRegionsPerBody} * samples);
  region_commands.reserve(world.regions.capacity());
  region_points.assign(world.regions.capacity(), RegionPoints{});
  const std::size_t cells = std::size_t{side} * side;
  cell_points.assign(cells, glm::dvec3(0.0));
  cell_distances.assign(cells, Distance{});
  cell_normals.assign(cells, glm::dvec3(0.0));
  cell_depth_changes.assign(cells, 0.0);
  carried_cells.assign(std::size_t{side + 2} * (side + 2), CarriedCell{});
  near_parts.assign(world.parts.size(), 0);
}

}  // namespace torsion
