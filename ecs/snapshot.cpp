#include "ecs/snapshot.hpp"

namespace torsion::engine {

void Snapshot::reserve(const Model& model, const State& state) {
  tools.reserve(state.tools.capacity());
  bodies.reserve(state.bodies.capacity());
  tools_over_bodies.reserve(state.tools_over_bodies.capacity());
  regions.reserve(state.regions.capacity());
  region_fields.reserve(state.regions.capacity());
  anchors.reserve(model.anchors.capacity());
}

void capture(const Model& model, const State& state, Snapshot& snapshot) {
  snapshot.clock = state.clock;
  snapshot.tools.copy_rows(state.tools);
  snapshot.bodies.copy_rows(state.bodies);
  snapshot.tools_over_bodies.copy_rows(state.tools_over_bodies);
  snapshot.regions.copy_rows(state.regions);
  snapshot.region_fields.assign_zeros(state.regions.size());
  snapshot.anchors.assign_zeros(model.anchors.size());
}

}  // namespace torsion::engine
