// Cost of signed distances: ns a point ("items" are points) for each kind of shape.

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "systems/distance.hpp"

namespace torsion {
namespace {

World world_with(const std::vector<ShapePart>& shapes) {
  World world;
  Capacities capacities;
  capacities.parts = static_cast<std::uint32_t>(shapes.size());
  world.reserve(capacities, Settings{});
  for (const ShapePart& shape : shapes) {
    const auto row = world.parts.append(1);
    world.parts.at<ShapePart>(row->first) = shape;
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

void exact_shape(benchmark::State& state, ShapeKind kind, glm::dvec3 half_extent,
                 glm::dquat rotation) {
  ShapePart part;
  part.kind = kind;
  part.half_extent = half_extent;
  part.pose.rotation = rotation;
  const World world = world_with({part});
  const std::vector<glm::dvec3> points = patch_points();
  std::vector<Distance> distances(points.size());
  for (auto _ : state) {
    signed_distances(world, {0, 1}, points, distances);
    benchmark::DoNotOptimize(distances.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

void single_point(benchmark::State& state, ShapeKind kind, glm::dvec3 half_extent) {
  ShapePart part;
  part.kind = kind;
  part.half_extent = half_extent;
  const World world = world_with({part});
  const std::vector<glm::dvec3> points = patch_points();
  for (auto _ : state) {
    for (const glm::dvec3& point : points) {
      benchmark::DoNotOptimize(signed_distance(world, {0, 1}, point));
    }
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

}  // namespace
}  // namespace torsion
