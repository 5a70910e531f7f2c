// Cost of signed distances: ns a point ("items" are points) for each kind of shape, for the field
// of a mesh, and for the exact distance to a mesh that fields are made from at load.

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "systems/geometry/distance.hpp"
#include "systems/geometry/distance_field.hpp"
#include "systems/geometry/distance_mesh.hpp"
#include "tests/support/distance_columns.hpp"
#include "tests/systems/geometry/distance_meshes.hpp"
#include "tests/systems/geometry/field_world.hpp"

namespace torsion::engine {
namespace {

World world_with(const std::vector<ShapePart>& shapes) {
  World world;
  Capacities capacities;
  capacities.parts = static_cast<std::uint32_t>(shapes.size());
  world.model.reserve(capacities, Settings{});
  world.state.reserve(capacities, Settings{});
  for (const ShapePart& shape : shapes) {
    const auto row = world.model.parts.append(1);
    world.model.parts.at<ShapePart>(row->first) = shape;
  }
  return world;
}

/// What detection asks: a 16 x 16 grid across a contact patch on top of a shape of half height 0.05
/// m.
std::vector<glm::dvec3> patch_points() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> height(-1e-3, 1e-3);
  std::vector<glm::dvec3> points;
  for (int j = 0; j < 16; ++j) {
    for (int i = 0; i < 16; ++i) {
      points.emplace_back(-0.008 + i * 0.001, 0.0495 + height(random), -0.008 + j * 0.001);
    }
  }
  return points;
}

/// The distances of all points of the patch to the world's first part.
void time_patch(benchmark::State& state, const World& world) {
  const std::vector<glm::dvec3> points = patch_points();
  test::PointBatch batch(points);
  const DistanceColumns columns = batch.columns();
  const std::array<std::uint32_t, 1> rows{0};
  for (auto _ : state) {
    signed_distances(world.model, rows, Pose{}, columns);
    benchmark::DoNotOptimize(columns.value.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

void exact_shape(benchmark::State& state, ShapeKind kind, glm::dvec3 half_extent,
                 glm::dquat rotation) {
  ShapePart part;
  part.kind = kind;
  part.half_extent = half_extent;
  part.pose.rotation = rotation;
  const World world = world_with({part});
  time_patch(state, world);
}

void single_point(benchmark::State& state, ShapeKind kind, glm::dvec3 half_extent) {
  ShapePart part;
  part.kind = kind;
  part.half_extent = half_extent;
  const World world = world_with({part});
  const std::vector<glm::dvec3> points = patch_points();
  for (auto _ : state) {
    for (const glm::dvec3& point : points) {
      benchmark::DoNotOptimize(signed_distance(world.model, {0, 1}, point));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

/// The same patch on the mesh of a ball of 8 * 4^levels triangles.
void mesh_field(benchmark::State& state) {
  const SurfaceMesh mesh = sphere_mesh(0.05, static_cast<std::uint32_t>(state.range(0)));
  const World world = field_world(build_distance_field(mesh).value());
  time_patch(state, world);
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
}

/// A patch across an edge of the mesh of a box.
void mesh_field_at_edge(benchmark::State& state) {
  World world = field_world(build_distance_field(box_mesh(glm::dvec3(0.05))).value());
  world.model.parts.at<ShapePart>(0).pose.position.x = 0.05;
  time_patch(state, world);
}

void exact_distance_to_mesh(benchmark::State& state) {
  const SurfaceMesh mesh = sphere_mesh(0.05, static_cast<std::uint32_t>(state.range(0)));
  const Result<MeshDistance> distance = MeshDistance::build(mesh);
  const std::vector<glm::dvec3> points = patch_points();
  for (auto _ : state) {
    for (const glm::dvec3& point : points) {
      benchmark::DoNotOptimize(distance.value().closest(point));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
}

void field_at_load(benchmark::State& state) {
  const SurfaceMesh mesh = sphere_mesh(0.05, static_cast<std::uint32_t>(state.range(0)));
  std::size_t bytes = 0;
  for (auto _ : state) {
    const Result<BuiltField> field = build_distance_field(mesh);
    bytes = to_bytes(field.value()).size();
  }
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
  state.counters["MB"] = static_cast<double>(bytes) * 1e-6;
}

void field_of_box_at_load(benchmark::State& state) {
  const SurfaceMesh mesh = box_mesh(glm::dvec3(0.05));
  for (auto _ : state) {
    benchmark::DoNotOptimize(build_distance_field(mesh));
  }
}

/// Ten balls in a row, and what is left of them when only those near the patch are asked.
void union_of_ten(benchmark::State& state, bool near_only) {
  std::vector<ShapePart> parts(10);
  for (int i = 0; i < 10; ++i) {
    ShapePart& part = parts[static_cast<std::size_t>(i)];
    part.half_extent = glm::dvec3(0.05);
    part.pose.position.x = 0.1 * i;
  }
  const World world = world_with(parts);
  const std::vector<glm::dvec3> points = patch_points();
  test::PointBatch batch(points);
  const DistanceColumns columns = batch.columns();
  std::array<std::uint32_t, 10> rows{};
  std::iota(rows.begin(), rows.end(), 0U);
  for (auto _ : state) {
    if (near_only) {
      signed_distances(world.model, parts_near(world.model, {0, 10}, {0.0, 0.05, 0.0}, 0.012, rows),
                       Pose{}, columns);
    } else {
      signed_distances(world.model, rows, Pose{}, columns);
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

const glm::dquat kUnturned(1.0, 0.0, 0.0, 0.0);
const glm::dquat kTurned(0.5, 0.5, 0.5, 0.5);

BENCHMARK_CAPTURE(exact_shape, sphere, ShapeKind::kSphere, glm::dvec3(0.05), kUnturned);
BENCHMARK_CAPTURE(exact_shape, box, ShapeKind::kBox, glm::dvec3(0.05), kUnturned);
BENCHMARK_CAPTURE(exact_shape, turned_box, ShapeKind::kBox, glm::dvec3(0.05), kTurned);
BENCHMARK_CAPTURE(exact_shape, cylinder, ShapeKind::kCylinder, glm::dvec3(0.05), kUnturned);
BENCHMARK_CAPTURE(exact_shape, capsule, ShapeKind::kCapsule, glm::dvec3(0.02, 0.05, 0.02),
                  kUnturned);
BENCHMARK_CAPTURE(exact_shape, ellipsoid, ShapeKind::kEllipsoid, glm::dvec3(0.08, 0.05, 0.06),
                  kUnturned);
BENCHMARK_CAPTURE(single_point, sphere, ShapeKind::kSphere, glm::dvec3(0.05));
BENCHMARK_CAPTURE(single_point, box, ShapeKind::kBox, glm::dvec3(0.05));
BENCHMARK_CAPTURE(single_point, ellipsoid, ShapeKind::kEllipsoid, glm::dvec3(0.08, 0.05, 0.06));
BENCHMARK(mesh_field)->Arg(3)->Arg(7);
BENCHMARK(mesh_field_at_edge);
BENCHMARK(exact_distance_to_mesh)->Arg(3)->Arg(7);
BENCHMARK(field_at_load)->Arg(3)->Arg(7)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(field_of_box_at_load)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(union_of_ten, all, false);
BENCHMARK_CAPTURE(union_of_ten, near_only, true);

}  // namespace
}  // namespace torsion::engine
