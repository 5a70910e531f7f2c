#include "systems/geometry/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/geometry/distance_mesh.hpp"
#include "systems/geometry/distance_shapes.hpp"
#include "systems/model/cache.hpp"
#include "tests/systems/geometry/distance_meshes.hpp"
#include "tests/systems/geometry/field_world.hpp"

namespace torsion::engine {
namespace {

BuiltField built(const SurfaceMesh& mesh, const FieldOptions& options) {
  Result<BuiltField> result = build_distance_field(mesh, options);
  EXPECT_TRUE(result.ok());
  return std::move(result).value();
}

/// A field ready to be asked.
struct Field {
  Field(const SurfaceMesh& mesh, const FieldOptions& options)
      : world(field_world(built(mesh, options))) {}
  [[nodiscard]] Distance at(const glm::dvec3& p) const {
    return FieldDistance(world.model, 0)(p.x, p.y, p.z);
  }
  World world;
};

std::vector<glm::dvec3> directions(int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  std::vector<glm::dvec3> result;
  while (static_cast<int>(result.size()) < count) {
    const double x = coordinate(random);
    const double y = coordinate(random);
    const double z = coordinate(random);
    const glm::dvec3 v(x, y, z);
    if (glm::length(v) > 0.1 && glm::length(v) <= 1.0) {
      result.push_back(glm::normalize(v));
    }
  }
  return result;
}

/// How far a mesh with its corners on a sphere about the origin lies inside it, and how much its
/// normals lean against the sphere's at most [rad].
struct Deviation {
  double depth = 0.0;
  double lean = 0.0;
};

Deviation deviation_from_sphere(const SurfaceMesh& mesh, double radius) {
  Deviation largest;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3& a = mesh.positions[t.x];
    const glm::dvec3 normal =
        glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
    const double plane = glm::dot(a, normal);
    largest.depth = std::max(largest.depth, radius - plane);
    largest.lean = std::max(largest.lean, std::acos(plane / radius));
  }
  return largest;
}

TEST(DistanceFieldTest, BallIsTheSphereButForItsFacets) {
  const double radius = 0.05;
  const SurfaceMesh mesh = sphere_mesh(radius, 4);
  const Deviation deviation = deviation_from_sphere(mesh, radius);
  const Field field(mesh, {});
  const double field_error = 1e-5 * 2.0 * radius;  // FieldOptions: 1e-5 of the longest side
  for (const glm::dvec3& direction : directions(2000)) {
    for (const double height : {-1e-3, -1e-4, 0.0, 1e-4, 1e-3}) {
      const Distance distance = field.at((radius + height) * direction);
      // The mesh lies between the sphere and `depth` inside it.
      EXPECT_GT(distance.value, height - field_error);
      EXPECT_LT(distance.value, height + deviation.depth + field_error);
      // A mean of normals none of which leans by more, over cells of 1 mm on a radius of 50 mm:
      // shorter by (1/50)^2 / 8 at most.
      EXPECT_NEAR(glm::distance(distance.gradient, direction), 0.0, deviation.lean + 1e-4);
    }
  }
}

TEST(DistanceFieldTest, CubeIsExactButWithinAFineCellOfItsEdges) {
  const double half = 0.05;
  const FieldOptions options;
  const Field field(box_mesh(glm::dvec3(half)), options);
  const double fine = field.world.model.fields.at<DistanceField>(0).spacing / options.subdivision;
  const BoxDistance exact{glm::dvec3(half)};
  std::mt19937 random(2);
  std::uniform_real_distribution<double> along(-half, half);
  std::uniform_real_distribution<double> off(-8e-4, 8e-4);
  int far_from_edges = 0;
  for (int i = 0; i < 4000; ++i) {
    const double x = along(random);
    const double z = along(random);
    const glm::dvec3 p(x, half + off(random), z);
    const Distance expected = exact(p.x, p.y, p.z);
    const Distance found = field.at(p);
    const double to_edge = half - std::max(std::abs(p.x), std::abs(p.z));
    // The distance bends where the next face is as near, as far from the edge as from this face; of
    // two points in one cell the difference of two coordinates differs by at most two cells.
    if (to_edge > std::abs(expected.value) + 2.0 * fine) {
      // A plane's distance is linear, and so is the field: what is left are the nodes' floats.
      EXPECT_NEAR(found.value, expected.value, 1e-8);
      EXPECT_NEAR(glm::distance(found.gradient, expected.gradient), 0.0, 1e-6);
      ++far_from_edges;
    } else {
      EXPECT_NEAR(found.value, expected.value, 0.5 * fine);
    }
  }
  EXPECT_GT(far_from_edges, 3000);
}

TEST(DistanceFieldTest, TorusConvergesWithTheGrid) {
  const double ring = 0.04;
  const double tube = 0.015;
  const SurfaceMesh mesh = torus_mesh(ring, tube, 240, 120);
  // Facets leave ring edge^2 / 8 R + tube edge^2 / 8 r of the torus: 6e-6 m.
  const double facets = std::pow(2.0 * std::numbers::pi / 240.0, 2) / 8.0 * (ring + tube) +
                        std::pow(2.0 * std::numbers::pi / 120.0, 2) / 8.0 * tube;
  double worst[2] = {0.0, 0.0};
  for (int level = 0; level < 2; ++level) {
    FieldOptions options;
    options.coarse_cells = level == 0 ? 8 : 16;
    options.subdivision = 2;
    const Field field(mesh, options);
    for (const glm::dvec3& direction : directions(1500)) {
      const double around = std::atan2(direction.z, direction.x);
      const double across = std::asin(direction.y) * 2.0;
      for (const double height : {-5e-4, 0.0, 5e-4}) {
        const double rho = ring + (tube + height) * std::cos(across);
        const glm::dvec3 p(rho * std::cos(around), (tube + height) * std::sin(across),
                           rho * std::sin(around));
        worst[level] =
            std::max(worst[level], std::abs(field.at(p).value - torus_distance(ring, tube, p)));
      }
    }
  }
  // Third order: half the spacing, an eighth of the error, but for the facets.
  EXPECT_LT(worst[1], worst[0] / 4.0 + facets);
  EXPECT_LT(worst[1], 1e-3 * 0.11);
}

TEST(DistanceFieldTest, InnerEdgeKeepsItsSignAndSize) {
  const double size = 0.05;
  const SurfaceMesh mesh = l_shape_mesh(size, 0.03);
  Result<MeshDistance> exact = MeshDistance::build(mesh);
  ASSERT_TRUE(exact.ok());
  const FieldOptions options;
  const Field field(mesh, options);
  const double fine = field.world.model.fields.at<DistanceField>(0).spacing / options.subdivision;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-0.055, 0.055);
  for (int i = 0; i < 4000; ++i) {
    const double x = coordinate(random);
    const double y = coordinate(random);
    const glm::dvec3 p(x, y, 0.2 * coordinate(random));
    const double expected = exact.value().closest(p).distance.value;
    const double found = field.at(p).value;
    // Near the surface the bends of the distance are rounded by a fine cell, elsewhere by a coarse
    // one.
    const bool near = std::abs(expected) < 0.2 * fine * options.subdivision;
    EXPECT_NEAR(found, expected, 0.5 * (near ? 1.0 : options.subdivision) * fine);
    if (std::abs(expected) > fine) {
      EXPECT_EQ(found < 0.0, expected < 0.0);
    }
  }
}

TEST(DistanceFieldTest, HasNoJumpsNearTheSurfaceAndSmallOnesFarFromIt) {
  const Field field(torus_mesh(0.04, 0.015, 60, 30), {});
  const double spacing = field.world.model.fields.at<DistanceField>(0).spacing;
  // Straight lines in small steps: the value changes by at most the step, and a bit for what the
  // blend's slope exceeds 1. A brick reaches a quarter of a coarse cell from the surface at least;
  // on the face where it ends its blend differs from the coarse one by the latter's error, of third
  // order: (spacing / tube radius)^3 of the radius.
  const double seam = std::pow(spacing / 0.015, 3) * 0.015;
  for (const glm::dvec3& direction : directions(40)) {
    const glm::dvec3 start = -0.08 * direction + glm::dvec3(0.013, 0.002, -0.021);
    const double step = 1e-5;
    double before = field.at(start).value;
    for (int i = 1; i < 16000; ++i) {
      const double value = field.at(start + direction * (step * i)).value;
      const double allowed = std::abs(before) < 0.25 * spacing ? 1.1 * step : 1.1 * step + seam;
      ASSERT_LT(std::abs(value - before), allowed) << "at step " << i;
      before = value;
    }
  }
}

TEST(DistanceFieldTest, FarAwayItNeverExceedsTheDistance) {
  const double radius = 0.05;
  const SurfaceMesh mesh = sphere_mesh(radius, 3);
  const Deviation deviation = deviation_from_sphere(mesh, radius);
  const Field field(mesh, {16, 4, 2});
  for (const glm::dvec3& direction : directions(500)) {
    for (const double height : {0.02, 0.05, 0.2, 5.0}) {
      const Distance distance = field.at((radius + height) * direction);
      EXPECT_LE(distance.value, height + deviation.depth + 1e-4 * height);
      // From the nearest point of the box on, the two legs of a right angle: at least 1/sqrt(2).
      EXPECT_GT(distance.value, 0.7 * height);
      EXPECT_NEAR(glm::length(distance.gradient), 1.0, 1e-2);
    }
  }
}

TEST(DistanceFieldTest, NanAndInfinityReadNothingBesideTheField) {
  const Field field(sphere_mesh(0.05, 1), {8, 2, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(field.at({nan, 0.0, 0.0}).value));
  EXPECT_TRUE(std::isnan(field.at({0.0, nan, nan}).value));
  EXPECT_EQ(field.at({infinity, 0.0, 0.0}).value, infinity);
  EXPECT_EQ(field.at({0.0, -infinity, 0.0}).value, infinity);
}

TEST(DistanceFieldBuildTest, RefusesAMeshWithoutExtent) {
  SurfaceMesh mesh = box_mesh(glm::dvec3(0.05));
  for (glm::dvec3& position : mesh.positions) {
    position = glm::dvec3(0.3);
  }
  const Result<BuiltField> result = build_distance_field(mesh);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().text.find("no extent"), std::string::npos);
}

TEST(DistanceFieldBuildTest, BytesAreTheFieldAndDamagedBytesAreNone) {
  const BuiltField field = built(sphere_mesh(0.05, 2), {8, 2, 1});
  const std::vector<std::byte> bytes = to_bytes(field);
  const std::optional<BuiltField> back = field_from_bytes(bytes);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(to_bytes(*back), bytes);
  for (std::size_t length = 0; length < bytes.size(); length += 997) {
    EXPECT_FALSE(field_from_bytes(std::span(bytes).first(length)).has_value());
  }
  // A checksum guards the file; ranges are checked all the same, since a step reads without
  // looking.
  BuiltField beyond = field;
  for (DistanceBrick& brick : beyond.bricks) {
    brick.first_node = static_cast<std::uint32_t>(field.nodes.size());
  }
  EXPECT_FALSE(field_from_bytes(to_bytes(beyond)).has_value());
  const BuiltField sharp = built(box_mesh(glm::dvec3(0.05)), {8, 2, 1});
  ASSERT_FALSE(sharp.creases.empty());
  EXPECT_TRUE(field_from_bytes(to_bytes(sharp)).has_value());
  BuiltField planes_beyond = sharp;
  for (DistanceCrease& crease : planes_beyond.creases) {
    crease.first_plane = static_cast<std::uint32_t>(sharp.nodes.size());
  }
  EXPECT_FALSE(field_from_bytes(to_bytes(planes_beyond)).has_value());
  BuiltField creases_beyond = sharp;
  for (DistanceBrick& brick : creases_beyond.bricks) {
    brick.first_crease = static_cast<std::uint32_t>(sharp.creases.size());
  }
  EXPECT_FALSE(field_from_bytes(to_bytes(creases_beyond)).has_value());
  BuiltField wide = field;
  wide.header.cells.x = 1'000'000;
  EXPECT_FALSE(field_from_bytes(to_bytes(wide)).has_value());
  BuiltField none = field;
  none.header.subdivision = 0;
  EXPECT_FALSE(field_from_bytes(to_bytes(none)).has_value());
}

TEST(DistanceFieldBuildTest, ComesFromTheCacheTheSecondTimeAndIsMadeAnewWhenTheEntryIsBad) {
  namespace fs = std::filesystem;
  std::string folder = fs::temp_directory_path() / "torsion_field_cache_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  setenv("TORSION_CACHE_DIR", folder.c_str(), 1);  // NOLINT(concurrency-mt-unsafe): one thread
  const SurfaceMesh mesh = sphere_mesh(0.05, 2);
  const FieldOptions options{8, 2, 1};
  const auto bytes_of = [&](const SurfaceMesh& of) {
    Result<BuiltField> field = load_or_build_distance_field(of, options);
    EXPECT_TRUE(field.ok());
    return to_bytes(field.value());
  };
  const std::vector<std::byte> first = bytes_of(mesh);
  const fs::path entry = fs::directory_iterator(folder)->path();
  const fs::file_time_type written = fs::last_write_time(entry);
  EXPECT_EQ(bytes_of(mesh), first);
  EXPECT_EQ(fs::last_write_time(entry), written);  // it was read, not made
  fs::resize_file(entry, fs::file_size(entry) / 2);
  EXPECT_EQ(bytes_of(mesh), first);
  EXPECT_EQ(bytes_of(mesh), first);

  SurfaceMesh moved = mesh;
  moved.positions[0].x *= 1.01;
  EXPECT_NE(bytes_of(moved), first);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 2);
  unsetenv("TORSION_CACHE_DIR");  // NOLINT(concurrency-mt-unsafe): one thread
  fs::remove_all(folder);
}

}  // namespace
}  // namespace torsion::engine
