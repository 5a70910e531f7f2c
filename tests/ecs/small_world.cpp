#include "tests/ecs/small_world.hpp"

#include <cstddef>
#include <span>

namespace torsion::engine::test {
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

// One mesh with a field of 2 x 2 x 2 coarse cells, of which one is divided once, and two exact
// shapes.
void mend_shapes(World& world) {
  for (std::uint32_t row = 0; row < world.model.parts.size(); ++row) {
    world.model.parts.at<ShapePart>(row).kind = ShapeKind::kSphere;
  }
  world.model.parts.at<ShapePart>(1).kind = ShapeKind::kMesh;
  world.model.parts.at<ShapePart>(1).field = 0;
  auto& field = world.model.fields.at<DistanceField>(0);
  field.cells = glm::uvec3(2);
  field.subdivision = 2;
  field.coarse_nodes = {0, 27};
  field.bricks = {0, 8};
  field.creases = {0, 8};
  for (DistanceBrick& brick : world.model.field_bricks.column<DistanceBrick>()) {
    brick.first_node = kNoRow;
    brick.first_crease = kNoRow;
  }
  world.model.field_bricks.at<DistanceBrick>(3) = {27, 0};
  for (DistanceCrease& crease : world.model.field_creases.column<DistanceCrease>()) {
    crease = {};
  }
}

// Two tools with 10 samples in a chain and 20 balls each, two bodies with 3 anchors each.
void mend_owners(World& world) {
  for (std::uint32_t row = 0; row < world.model.samples.size(); ++row) {
    for (std::uint32_t& neighbour : world.model.samples.at<SurfaceSample>(row).neighbours) {
      neighbour = kNoRow;
    }
    world.model.samples.at<SurfaceSample>(row).neighbours[0] = (row + 1) % 10;
  }
  for (std::uint32_t row = 0; row < world.model.balls.size(); ++row) {
    world.model.balls.at<SurfaceBall>(row).skip = row % 20 + 1;
    world.model.balls.at<SurfaceBall>(row).sample = row % 2 == 0 ? kNoRow : row % 20 / 2;
  }
  for (std::uint32_t row = 0; row < 2; ++row) {
    world.model.tools.at<OwnedRows>(row) = {
        {row, 1}, {row * 10, 10}, {row * 20, 20}, {}, {}, {}, {}, {}};
    world.model.bodies.at<OwnedRows>(row) = {{row + 1, 1}, {}, {}, {row * 3, 3}, {}, {}, {}, {}};
    if (row == 0) {
      world.model.bodies.at<OwnedRows>(row).ports = {0, 3};
      world.model.bodies.at<OwnedRows>(row).compliance = {0, 162};
    }
    for (SupportFit& support_fit : world.state.support_fits.column<SupportFit>()) {
      support_fit.count = 0;
    }
    world.model.bodies.at<FixedRegion>(row).volumes = {row, 1};
    auto& region = world.state.regions.at<RegionIdentity>(row);
    region.body = row;
    region.tool = 1 - row;
    region.cells = {row * 16, 16};
  }
}

}  // namespace

World small_world(unsigned seed) {
  World world;
  Capacities capacities;
  capacities.bodies = 2;
  capacities.tools = 2;
  capacities.parts = 3;
  capacities.fields = 1;
  capacities.field_nodes = 54;
  capacities.field_bricks = 8;
  capacities.field_creases = 8;
  capacities.fixed_volumes = 2;
  capacities.samples = 20;
  capacities.balls = 40;
  capacities.anchors = 6;
  capacities.regions = 4;
  capacities.influences = 3;
  capacities.patch_bodies = 1;
  capacities.mdr_bodies = 1;
  capacities.layer_influences = 448;
  capacities.ports = 3;
  capacities.compliance_values = 162;
  Settings settings;
  settings.grid_side = 4;
  world.model.reserve(capacities, settings);
  world.state.reserve(capacities, settings);

  world.model.parts.append(3);
  world.model.fields.append(1);
  world.model.field_nodes.append(54);
  world.model.field_bricks.append(8);
  world.model.field_creases.append(8);
  world.model.fixed_volumes.append(2);
  world.model.samples.append(20);
  world.model.balls.append(40);
  world.model.sections.append(6 * kBeamStations);
  world.model.bodies.append(2);
  world.model.tools.append(2);
  world.state.regions.append(2);
  world.model.influences.append(3);
  world.model.ports.append(3);
  world.model.compliance.append(162);
  world.model.anchors.append(6);

  unsigned random = seed;
  const auto fill_all = [&random](auto&... tables) {
    (fill(tables, random), ...);
  };
  std::apply(fill_all, world.model.tables());
  std::apply(fill_all, world.state.tables());
  mend_shapes(world);
  mend_owners(world);
  return world;
}

}  // namespace torsion::engine::test
