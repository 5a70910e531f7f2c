#include "ecs/snapshot.hpp"

namespace torsion {

void Snapshot::reserve(const Model& model, const State& state) {
  tools.reserve(state.tools.capacity());
  regions.reserve(state.regions.capacity());
  region_fields.reserve(state.regions.capacity());
  anchors.reserve(model.anchors.size());
}

void capture(const State& state, Snapshot& snapshot) {
  snapshot.clock = state.clock;
  snapshot.tools.copy_rows(state.tools);
  snapshot.regions.copy_rows(state.regions);
  snapshot.region_fields.clear();
  TORSION_ASSERT(snapshot.region_fields.append(state.regions.size()).has_value());
  snapshot.anchors.clear();
  TORSION_ASSERT(snapshot.anchors.append(snapshot.anchors.capacity()).has_value());
}

}  // namespace torsion
