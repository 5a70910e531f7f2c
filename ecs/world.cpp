#include "ecs/world.hpp"

namespace torsion {

void World::reserve(const Capacities& capacities, const Settings& chosen) {
  parts.reserve(capacities.parts);
  fields.reserve(capacities.fields);
  field_nodes.reserve(capacities.field_nodes);
  field_bricks.reserve(capacities.field_bricks);
  fixed_volumes.reserve(capacities.fixed_volumes);
  samples.reserve(capacities.samples);
  balls.reserve(capacities.balls);
  sections.reserve(capacities.anchors * kBeamStations);
  clock.reserve(1);
  bodies.reserve(capacities.bodies);
  tools.reserve(capacities.tools);
  anchors.reserve(capacities.anchors);
  reserve_models(capacities, chosen);
  clock.append();
  clock.at<Clock>(0) = Clock{};
}

void World::reserve_models(const Capacities& capacities, const Settings& chosen) {
  settings.reserve(1);
  influences.reserve(capacities.influences);
  ports.reserve(capacities.ports);
  compliance.reserve(capacities.compliance_values);
  const std::uint32_t footed = capacities.ports > 0 ? capacities.regions : 0;
  footings.reserve(footed);
  couplings.reserve(footed * (footed - (footed > 0 ? 1 : 0)) / 2);
  regions.reserve(capacities.regions);
  cells.reserve(capacities.regions * chosen.grid_side * chosen.grid_side);
  patch_cells.reserve(capacities.patch_bodies > 0 ? cells.capacity() : 0);
  layer_influences.reserve(capacities.regions * capacities.layer_influences);
  mdr_layers.reserve(capacities.mdr_bodies > 0 ? capacities.regions * kMdrLayers : 0);
  settings.append();
  settings.at<Settings>(0) = chosen;
}

}  // namespace torsion
