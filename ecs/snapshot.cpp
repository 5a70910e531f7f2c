#include "ecs/snapshot.hpp"

#include <algorithm>

namespace torsion {
namespace {

template <class T, class To, class From>
void copy_column(const From& from, To& to) {
  std::ranges::copy(from.template column<T>(), to.template column<T>().begin());
}

/// Makes `to` as long as `from` and copies the columns Ts.
template <class... Ts, class To, class From>
void copy_columns(const From& from, To& to) {
  to.clear();
  TORSION_ASSERT(to.append(from.size()).has_value());
  (copy_column<Ts>(from, to), ...);
}

}  // namespace

void Snapshot::reserve(const World& world) {
  clock.reserve(1);
  tools.reserve(world.tools.capacity());
  regions.reserve(world.regions.capacity());
  region_fields.reserve(world.regions.capacity());
  anchors.reserve(world.anchors.capacity());
}

void capture(const World& world, Snapshot& snapshot) {
  snapshot.clock.copy_rows(world.clock);
  copy_columns<ToolPose, ToolMotion, ToolWrench>(world.tools, snapshot.tools);
  snapshot.regions.copy_rows(world.regions);
  snapshot.region_fields.clear();
  TORSION_ASSERT(snapshot.region_fields.append(world.regions.size()).has_value());
  snapshot.anchors.clear();
  TORSION_ASSERT(snapshot.anchors.append(world.anchors.size()).has_value());
}

}  // namespace torsion
