#include "systems/geometry/sample_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/systems/geometry/distance_meshes.hpp"

namespace torsion::engine {
namespace {

PartDescription exact_part(ShapeKind kind, const glm::dvec3& half_extent, const Pose& pose = {}) {
  PartDescription part;
  part.shape.kind = kind;
  part.shape.half_extent = half_extent;
  part.shape.pose = pose;
  return part;
}

PartDescription mesh_part(SurfaceMesh mesh) {
  PartDescription part;
  part.shape.kind = ShapeKind::kMesh;
  part.surface = std::move(mesh);
  return part;
}

Pose shifted(const glm::dvec3& position) {
  return {position, glm::dquat(1.0, 0.0, 0.0, 0.0)};
}

struct Tool {
  std::string name;
  std::vector<PartDescription> parts;
};

std::vector<Tool> tools() {
  const Pose turned{{0.01, -0.02, 0.03},
                    glm::angleAxis(1.1, glm::normalize(glm::dvec3(1.0, 0.3, -0.7)))};
  return {{"sphere", {exact_part(ShapeKind::kSphere, glm::dvec3(0.05))}},
          {"turned ellipsoid", {exact_part(ShapeKind::kEllipsoid, {0.08, 0.02, 0.04}, turned)}},
          {"box", {exact_part(ShapeKind::kBox, {0.05, 0.002, 0.03})}},
          {"mesh with a hole", {mesh_part(torus_mesh(0.04, 0.015, 40, 20))}},
          {"mallet",
           {exact_part(ShapeKind::kCylinder, {0.02, 0.05, 0.02}, turned),
            exact_part(ShapeKind::kCapsule, {0.01, 0.08, 0.01}, turned),
            mesh_part(l_shape_mesh(0.04, 0.02))}}};
}

double total_area(std::span<const PartDescription> parts, std::uint32_t count = 1000) {
  const PartSolids solids(parts);
  double area = 0.0;
  for (const SurfaceTriangle& piece : surface_pieces(parts, solids, count)) {
    area += piece.area;
  }
  return area;
}

TEST(SurfacePiecesTest, AreasSumUpToTheSurface) {
  using std::numbers::pi;
  const auto area_of = [](const PartDescription& part) {
    return total_area({&part, 1});
  };
  // Inscribed flat pieces of about the size of a sample's share lack a few tenths of a per cent.
  EXPECT_NEAR(area_of(exact_part(ShapeKind::kSphere, glm::dvec3(0.05))) / (4.0 * pi * 0.05 * 0.05),
              1.0, 5e-3);
  EXPECT_NEAR(area_of(exact_part(ShapeKind::kBox, {0.05, 0.02, 0.03})) /
                  (8.0 * (0.05 * 0.02 + 0.02 * 0.03 + 0.03 * 0.05)),
              1.0, 1e-12);
  EXPECT_NEAR(area_of(exact_part(ShapeKind::kCylinder, {0.02, 0.05, 0.02})) /
                  (2.0 * pi * 0.02 * (0.02 + 0.1)),
              1.0, 5e-3);
  EXPECT_NEAR(area_of(exact_part(ShapeKind::kCapsule, {0.02, 0.05, 0.02})) /
                  (2.0 * pi * 0.02 * (0.06 + 0.04)),
              1.0, 5e-3);
  EXPECT_NEAR(area_of(mesh_part(box_mesh(glm::dvec3(0.05)))), 6.0 * 0.01, 1e-15);
}

TEST(SurfacePiecesTest, WhatLiesInsideAnotherPartIsLeftOut) {
  // A small ball wholly inside a box, and one half inside.
  const PartDescription box = exact_part(ShapeKind::kBox, glm::dvec3(0.05));
  const PartDescription inside = exact_part(ShapeKind::kSphere, glm::dvec3(0.01));
  const PartDescription half =
      exact_part(ShapeKind::kSphere, glm::dvec3(0.01), shifted({0.0, 0.05, 0.0}));
  const double alone = total_area({{box}});
  EXPECT_NEAR(total_area({{box, inside}}), alone, 1e-12);
  const double with_half = total_area({{box, half}});
  const double dome = 2.0 * std::numbers::pi * 0.01 * 0.01;
  // Pieces across the seam stay, on both parts: a band of the pieces' size along its 63 mm.
  EXPECT_GT(with_half, alone + dome - std::numbers::pi * 0.01 * 0.01 - 1e-6);
  EXPECT_LT(with_half, alone + dome + 2.0 * std::numbers::pi * 0.01 * 0.004);
}

TEST(SampleSurfaceTest, SamplesLieOnTheUnionsSurface) {
  for (const Tool& tool : tools()) {
    SCOPED_TRACE(tool.name);
    const SampledSurface surface = sample_surface(tool.parts, 500);
    ASSERT_EQ(surface.samples.size(), 500U);
    std::vector<MeshDistance> meshes;
    for (const PartDescription& part : tool.parts) {
      if (part.shape.kind == ShapeKind::kMesh) {
        meshes.push_back(std::move(MeshDistance::build(part.surface)).value());
      }
    }
    for (const SurfaceSample& sample : surface.samples) {
      double nearest = 1.0;
      std::size_t mesh = 0;
      for (const PartDescription& part : tool.parts) {
        const double distance = part.shape.kind == ShapeKind::kMesh
                                    ? meshes[mesh++].closest(sample.position).distance.value
                                    : exact_distance(part.shape, sample.position).value;
        nearest = std::min(nearest, distance);
      }
      // A sample moves onto its exact shape after it was found outside the others: by the height of
      // a piece, far below 0.1 mm, it may dip into another part.
      EXPECT_LT(nearest, 1e-12);
      EXPECT_GT(nearest, tool.parts.size() == 1 ? -1e-12 : -1e-4);
    }
  }
}

TEST(SampleSurfaceTest, SpacingIsEven) {
  for (const Tool& tool : tools()) {
    SCOPED_TRACE(tool.name);
    const std::uint32_t count = 500;
    const SampledSurface surface = sample_surface(tool.parts, count);
    const double even = std::sqrt(total_area(tool.parts, count) / count);
    // Farthest points of a plane stand in near-hexagonal order: neighbours at 0.8 to 1.1 of the
    // side of a sample's share. Farthest-point picking is within a factor of two of the best.
    std::vector<double> nearest;
    for (const SurfaceSample& sample : surface.samples) {
      ASSERT_NE(sample.neighbours[0], kNoRow);
      nearest.push_back(
          glm::distance(sample.position, surface.samples[sample.neighbours[0]].position));
    }
    std::ranges::sort(nearest);
    EXPECT_GT(nearest[count / 2], 0.5 * even);
    EXPECT_LT(nearest.back(), 2.0 * even);
    // No crowding: samples of the two sides of an edge or of a thin wall alone come nearer.
    if (tool.name == "sphere" || tool.name == "mesh with a hole") {
      EXPECT_GT(nearest.front(), 0.4 * even);
    }
  }
}

TEST(SampleSurfaceTest, AThinWallHasSamplesOnBothSides) {
  const PartDescription plate = exact_part(ShapeKind::kBox, {0.05, 0.0005, 0.05});
  int above = 0;
  int below = 0;
  for (const SurfaceSample& sample : sample_surface({&plate, 1}, 400).samples) {
    above += sample.position.y > 4e-4 ? 1 : 0;
    below += sample.position.y < -4e-4 ? 1 : 0;
  }
  EXPECT_GT(above, 150);
  EXPECT_GT(below, 150);
}

TEST(SampleSurfaceTest, DensityDoesNotFollowTheMesh) {
  // One face of the box cut a thousand times finer than the others gets its share all the same.
  SurfaceMesh mesh = box_mesh(glm::dvec3(0.05));
  for (int cut = 0; cut < 10; ++cut) {
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::dvec3 middle =
          (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0;
      if (middle.z < 0.05 - 1e-9 || finer.size() > 3000) {
        finer.push_back(t);
        continue;
      }
      const auto added = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back(middle);
      finer.insert(finer.end(), {{t.x, t.y, added}, {t.y, t.z, added}, {t.z, t.x, added}});
    }
    mesh.triangles = std::move(finer);
  }
  ASSERT_GT(mesh.triangles.size(), 1000U);
  const PartDescription part = mesh_part(mesh);
  const SampledSurface surface = sample_surface({&part, 1}, 600);
  const auto on_fine_face = std::ranges::count_if(
      surface.samples, [](const SurfaceSample& sample) { return sample.position.z > 0.05 - 1e-9; });
  EXPECT_NEAR(static_cast<double>(on_fine_face), 100.0, 20.0);
}

TEST(SampleSurfaceTest, NeighboursAreTheNearestInRisingOrder) {
  const PartDescription part = exact_part(ShapeKind::kSphere, glm::dvec3(0.05));
  const SampledSurface surface = sample_surface({&part, 1}, 120);
  for (std::uint32_t own = 0; own < surface.samples.size(); ++own) {
    const SurfaceSample& sample = surface.samples[own];
    std::vector<double> all;
    for (std::uint32_t other = 0; other < surface.samples.size(); ++other) {
      if (other != own) {
        all.push_back(glm::distance(sample.position, surface.samples[other].position));
      }
    }
    std::ranges::sort(all);
    for (std::size_t k = 0; k < kSampleNeighbours; ++k) {
      EXPECT_EQ(glm::distance(sample.position, surface.samples[sample.neighbours[k]].position),
                all[k]);
    }
    EXPECT_EQ(sample.spacing, all[kSampleNeighbours - 1]);
  }
}

/// Points all over a part's own surface: of a mesh its triangles', of a shape its exact surface.
std::vector<glm::dvec3> dense_points(const PartDescription& part) {
  std::vector<SurfaceTriangle> pieces = surface_pieces({&part, 1}, PartSolids({&part, 1}), 2000);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<glm::dvec3> points;
  for (const SurfaceTriangle& piece : pieces) {
    const double u = unit(random);
    const double v = unit(random) * (1.0 - u);
    glm::dvec3 p = piece.corner[0] + u * (piece.corner[1] - piece.corner[0]) +
                   v * (piece.corner[2] - piece.corner[0]);
    if (part.shape.kind != ShapeKind::kMesh) {
      const Distance distance = exact_distance(part.shape, p);
      p -= distance.value * distance.gradient;
    }
    points.push_back(p);
  }
  return points;
}

TEST(SampleSurfaceTest, BallsOfALeafAndItsAncestorsHoldEveryPointOfTheSurface) {
  for (const Tool& tool : tools()) {
    SCOPED_TRACE(tool.name);
    const SampledSurface surface = sample_surface(tool.parts, 300);
    const PartSolids solids(tool.parts);
    for (std::uint32_t part = 0; part < tool.parts.size(); ++part) {
      for (const glm::dvec3& point : dense_points(tool.parts[part])) {
        if (solids.inside_others(point, part, 0.0)) {
          continue;
        }
        // Walks as detection does: only into balls that hold the point.
        bool found = false;
        for (std::uint32_t row = 0; row < surface.balls.size() && !found;) {
          const SurfaceBall& ball = surface.balls[row];
          const bool holds = glm::distance(point, ball.center) <= ball.radius * (1.0 + 1e-9);
          found = holds && ball.sample != kNoRow;
          row = holds ? row + 1 : ball.skip;
        }
        ASSERT_TRUE(found) << point.x << " " << point.y << " " << point.z;
      }
    }
  }
}

TEST(SampleSurfaceTest, BallsAreTight) {
  for (const Tool& tool : tools()) {
    SCOPED_TRACE(tool.name);
    if (tool.parts.size() > 1) {
      continue;  // a mesh's triangle that is half inside another part is given to samples as a
                 // whole
    }
    const std::uint32_t count = 500;
    const SampledSurface surface = sample_surface(tool.parts, count);
    const double even = std::sqrt(total_area(tool.parts, count) / count);
    double largest = 0.0;
    for (const SurfaceBall& ball : surface.balls) {
      largest = ball.sample != kNoRow ? std::max(largest, ball.radius) : largest;
    }
    // The largest hole of farthest points is one spacing, and pieces of 0.4 spacings stick out.
    EXPECT_LT(largest, 2.0 * even);
  }
}

TEST(PointTreeTest, VisitsEveryLeafOnceAndSkipsWholeSubtrees) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const std::size_t count : {1U, 2U, 3U, 4U, 5U, 17U, 256U, 1000U}) {
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i < count; ++i) {
      const double x = unit(random);
      points.emplace_back(x, unit(random), 0.0);
    }
    const PointTree tree = point_tree(points);
    std::vector<std::uint32_t> order = tree.order;
    ASSERT_EQ(order.size(), count);
    std::ranges::sort(order);
    for (std::uint32_t i = 0; i < count; ++i) {
      EXPECT_EQ(order[i], i);
    }
    std::uint32_t leaf = 0;
    for (std::uint32_t row = 0; row < tree.balls.size(); ++row) {
      const SurfaceBall& ball = tree.balls[row];
      ASSERT_GT(ball.skip, row);
      ASSERT_LE(ball.skip, tree.balls.size());
      if (ball.sample != kNoRow) {
        EXPECT_EQ(ball.sample, leaf++);
        EXPECT_EQ(ball.skip, row + 1);
        EXPECT_EQ(ball.center, points[tree.order[ball.sample]]);
      }
      for (std::uint32_t below = row + 1; below < ball.skip; ++below) {
        const SurfaceBall& inner = tree.balls[below];
        EXPECT_LE(inner.skip, ball.skip);
        if (inner.sample != kNoRow) {
          EXPECT_LE(glm::distance(ball.center, inner.center) + inner.radius,
                    ball.radius * (1.0 + 1e-9));
        }
      }
    }
    EXPECT_EQ(leaf, count);
  }
  EXPECT_TRUE(point_tree({}).balls.empty());
}

TEST(PointTreeTest, NearestLeafIsTheNearest) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 300; ++i) {
    const double x = unit(random);
    const double y = unit(random);
    points.emplace_back(x, y, unit(random));
  }
  PointTree tree = point_tree(points);
  std::vector<glm::dvec3> centers;
  for (const std::uint32_t row : tree.order) {
    centers.push_back(points[row]);
  }
  std::uint32_t hint = 0;
  for (int i = 0; i < 200; ++i) {
    const double x = unit(random);
    const glm::dvec3 p(x, unit(random), 0.5);
    hint = nearest_leaf(tree.balls, centers, p, hint);
    const auto nearest = std::ranges::min_element(
        centers, {}, [&](const glm::dvec3& center) { return glm::distance(p, center); });
    EXPECT_EQ(centers[hint], *nearest);
  }
}

TEST(SampleSurfaceTest, TheSameInputGivesTheSameBitsAndNothingGivesNothing) {
  const Tool mallet = tools().back();
  const SampledSurface first = sample_surface(mallet.parts, 200);
  const SampledSurface second = sample_surface(mallet.parts, 200);
  ASSERT_EQ(first.samples.size(), second.samples.size());
  for (std::size_t i = 0; i < first.samples.size(); ++i) {
    EXPECT_EQ(first.samples[i].position, second.samples[i].position);
  }
  EXPECT_TRUE(sample_surface({}, 200).samples.empty());
  EXPECT_TRUE(sample_surface(mallet.parts, 0).samples.empty());
  const PartDescription empty = mesh_part(SurfaceMesh{});
  EXPECT_TRUE(sample_surface({&empty, 1}, 200).samples.empty());
}

}  // namespace
}  // namespace torsion::engine
