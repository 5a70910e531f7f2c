#include "ecs/model.hpp"

namespace torsion::engine {

void Model::reserve(const Capacities& capacities, const Settings& chosen) {
  bodies.reserve(capacities.bodies);
  body_scripts.clear();
  tools.reserve(capacities.tools);
  parts.reserve(capacities.parts);
  fields.reserve(capacities.fields);
  field_nodes.reserve(capacities.field_nodes);
  field_bricks.reserve(capacities.field_bricks);
  field_creases.reserve(capacities.field_creases);
  fixed_volumes.reserve(capacities.fixed_volumes);
  samples.reserve(capacities.samples);
  balls.reserve(capacities.balls);
  anchors.reserve(capacities.anchors);
  sections.reserve(capacities.anchors * kBeamStations);
  reserve_models(capacities, chosen);
}

void Model::reserve_models(const Capacities& capacities, const Settings& chosen) {
  settings = chosen;
  influences.reserve(capacities.influences);
  ports.reserve(capacities.ports);
  compliance.reserve(capacities.compliance_values);
}

}  // namespace torsion::engine
