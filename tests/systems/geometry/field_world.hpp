#pragma once

// A world that holds one distance field and one mesh part that uses it.

#include <algorithm>

#include "ecs/world.hpp"
#include "systems/geometry/distance_field.hpp"

namespace torsion::engine {

inline World field_world(const BuiltField& field) {
  World world;
  Capacities capacities;
  capacities.parts = 1;
  capacities.fields = 1;
  capacities.field_nodes = static_cast<std::uint32_t>(field.nodes.size());
  capacities.field_bricks = static_cast<std::uint32_t>(field.bricks.size());
  capacities.field_creases = static_cast<std::uint32_t>(field.creases.size());
  world.model.reserve(capacities, Settings{});
  world.state.reserve(capacities, Settings{});
  world.model.fields.at<DistanceField>(world.model.fields.append()->first) = field.header;
  world.model.field_nodes.append(capacities.field_nodes);
  world.model.field_bricks.append(capacities.field_bricks);
  world.model.field_creases.append(capacities.field_creases);
  std::ranges::copy(field.nodes, world.model.field_nodes.column<DistanceNode>().begin());
  std::ranges::copy(field.bricks, world.model.field_bricks.column<DistanceBrick>().begin());
  std::ranges::copy(field.creases, world.model.field_creases.column<DistanceCrease>().begin());
  ShapePart& part = world.model.parts.at<ShapePart>(world.model.parts.append()->first);
  part = ShapePart{};
  part.kind = ShapeKind::kMesh;
  part.field = 0;
  return world;
}

}  // namespace torsion::engine
