#include "tests/ecs/small_world.hpp"

#include <cstddef>
#include <span>

namespace torsion::test {
namespace {

template <class AnyTable>
void fill(AnyTable& table, unsigned& state) {
  table.each_column([&state](std::span<std::byte> bytes, std::size_t /*row_size*/) {
    for (std::byte& byte : bytes) {
      state = state * 1664525U +
              1013904223U;  // Numerical Recipes' generator: the same bytes everywhere
      byte = static_cast<std::byte>(state >> 24U);
    }
  });
}

}  // namespace

World small_world(unsigned seed) {
  World world;
  Capacities capacities;
  capacities.bodies = 2;
  capacities.tools = 2;
  capacities.parts = 3;
  capacities.fields = 1;
  capacities.field_nodes = 27;
  capacities.field_bricks = 8;
  capacities.fixed_volumes = 2;
  capacities.samples = 20;
  capacities.balls = 40;
  capacities.anchors = 6;
  capacities.regions = 4;
  Settings settings;
  settings.grid_side = 4;
  world.reserve(capacities, settings);

  world.parts.append(3);
  world.fields.append(1);
  world.field_nodes.append(27);
  world.field_bricks.append(8);
  world.fixed_volumes.append(2);
  world.samples.append(20);
  world.balls.append(40);
  world.sections.append(6 * kBeamStations);
  world.bodies.append(2);
  world.tools.append(2);
  world.regions.append(2);
  world.cells.append(2 * settings.grid_side * settings.grid_side);
  world.anchors.append(6);

  unsigned state = seed;
  std::apply([&state](auto&... tables) { (fill(tables, state), ...); }, world.tables());
  for (std::uint32_t row = 0; row < 2; ++row) {
    world.bodies.at<Entity>(row) = world.body_handles.create(row).value();
    world.tools.at<Entity>(row) = world.tool_handles.create(row).value();
    world.regions.at<RegionIdentity>(row).self = world.region_handles.create(row).value();
  }
  return world;
}

}  // namespace torsion::test
