#pragma once

// A world that holds one distance field and one mesh part that uses it.

#include <algorithm>

#include "ecs/world.hpp"
#include "systems/geometry/distance_field_build.hpp"

namespace torsion {

inline World field_world(const BuiltField& field) {
  World world;
  Capacities capacities;
  capacities.parts = 1;
  capacities.fields = 1;
  capacities.field_nodes = static_cast<std::uint32_t>(field.nodes.size());
  capacities.field_bricks = static_cast<std::uint32_t>(field.bricks.size());
  world.reserve(capacities, Settings{});
  world.fields.at<DistanceField>(world.fields.append()->first) = field.header;
  world.field_nodes.append(capacities.field_nodes);
  world.field_bricks.append(capacities.field_bricks);
  std::ranges::copy(field.nodes, world.field_nodes.column<DistanceNode>().begin());
  std::ranges::copy(field.bricks, world.field_bricks.column<DistanceBrick>().begin());
  ShapePart& part = world.parts.at<ShapePart>(world.parts.append()->first);
  part = ShapePart{};
  part.kind = ShapeKind::kMesh;
  part.field = 0;
  return world;
}

}  // namespace torsion
