// Distances to meshes from several threads.

#include <cmath>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "systems/geometry/distance_field.hpp"
#include "systems/geometry/distance_mesh.hpp"
#include "tests/systems/geometry/distance_meshes.hpp"

namespace torsion::engine {
namespace {

TEST(DistanceThreadsTest, MayAskOneMeshAtOnce) {
  const Result<MeshDistance> built = MeshDistance::build(torus_mesh(0.04, 0.015, 48, 24));
  ASSERT_TRUE(built.ok());
  const MeshDistance& distance = built.value();
  std::vector<glm::dvec3> points;  // in and around the torus
  for (int k = 0; k < 400; ++k) {
    points.emplace_back(0.08 * std::sin(k), 0.08 * std::sin(1.7 * k), 0.08 * std::cos(2.3 * k));
  }
  std::vector<double> alone;
  alone.reserve(points.size());
  for (const glm::dvec3& p : points) {
    alone.push_back(distance.closest(p).distance.value);
  }
  std::vector<std::vector<double>> together(4);
  std::vector<std::jthread> threads;
  threads.reserve(together.size());
  for (std::vector<double>& found : together) {
    threads.emplace_back([&] {
      for (const glm::dvec3& p : points) {
        found.push_back(distance.closest(p).distance.value);
      }
    });
  }
  threads.clear();
  for (const std::vector<double>& found : together) {
    EXPECT_EQ(found, alone);
  }
}

TEST(DistanceThreadsTest, AFieldDoesNotDependOnTheirNumber) {
  const SurfaceMesh mesh = torus_mesh(0.04, 0.015, 24, 12);
  const Result<BuiltField> by_one = build_distance_field({mesh, mesh}, {12, 4, 1});
  const Result<BuiltField> by_three = build_distance_field({mesh, mesh}, {12, 4, 3});
  ASSERT_TRUE(by_one.ok() && by_three.ok());
  EXPECT_EQ(to_bytes(by_one.value()), to_bytes(by_three.value()));
}

}  // namespace
}  // namespace torsion::engine
