#include "systems/geometry/surface_piece.hpp"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/geometry/distance_shapes.hpp"

namespace torsion::engine {
namespace {

Distance distance_to(const ShapePart& part, const glm::dvec3& point) {
  return with_exact_shape(part,
                          [&](const auto& shape) { return shape(point.x, point.y, point.z); });
}

/// The nearest point of the surface.
glm::dvec3 on_surface(const ShapePart& part, glm::dvec3 point) {
  for (int step = 0; step < 20; ++step) {
    const Distance distance = distance_to(part, point);
    point -= distance.value * distance.gradient;
  }
  return point;
}

struct Place {
  ShapePart part;
  glm::dvec3 point;  // near the surface
};

std::vector<Place> places() {
  const auto part = [](ShapeKind kind, const glm::dvec3& half) {
    ShapePart made;
    made.kind = kind;
    made.half_extent = half;
    return made;
  };
  const glm::dvec3 half(0.03, 0.05, 0.03);
  return {{part(ShapeKind::kSphere, glm::dvec3(0.05)), {0.03, 0.04, 0.01}},
          {part(ShapeKind::kEllipsoid, {0.07, 0.05, 0.03}), {0.04, 0.03, 0.012}},
          {part(ShapeKind::kEllipsoid, {0.07, 0.05, 0.03}), {0.0, -0.05, 0.0}},
          {part(ShapeKind::kBox, half), {0.01, 0.05, -0.02}},
          {part(ShapeKind::kCylinder, half), {0.02, 0.01, 0.022}},
          {part(ShapeKind::kCylinder, half), {0.01, -0.05, 0.0}},
          {part(ShapeKind::kCapsule, half), {0.02, 0.01, 0.022}},
          {part(ShapeKind::kCapsule, half), {0.01, 0.045, 0.005}}};
}

TEST(SurfacePieceTest, CurvatureIsHowTheNormalTurns) {
  for (const Place& place : places()) {
    const glm::dvec3 point = on_surface(place.part, place.point);
    const glm::dmat3 found = curvature_at(piece_at(place.part, point), point);
    const glm::dvec3 normal = distance_to(place.part, point).gradient;
    const glm::dvec3 first = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.2, 0.9)));
    for (const glm::dvec3& way : {first, glm::cross(normal, first)}) {
      // Differences over 2 h of a surface with radii from 0.02 m: (h / 0.02)^2 of the curvature.
      constexpr double kStep = 1e-6;
      const glm::dvec3 after =
          distance_to(place.part, on_surface(place.part, point + kStep * way)).gradient;
      const glm::dvec3 before =
          distance_to(place.part, on_surface(place.part, point - kStep * way)).gradient;
      const glm::dvec3 turned = (after - before) / (2.0 * kStep);
      EXPECT_LE(glm::distance(found * way, turned), 1e-6 * 50.0);
    }
    EXPECT_LE(glm::length(found * normal), 1e-12);
  }
}

TEST(SurfacePieceTest, TheDropLeadsBackToTheSurface) {
  for (const Place& place : places()) {
    const glm::dvec3 point = on_surface(place.part, place.point);
    const glm::dvec3 normal = distance_to(place.part, point).gradient;
    const SurfacePiece piece = piece_at(place.part, point);
    const glm::dvec3 first = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.2, 0.9)));
    for (const glm::dvec3& aside : {2e-3 * first, -1e-3 * glm::cross(normal, first)}) {
      const double drop = drop_at(piece, point, normal, aside);
      EXPECT_GE(drop, -1e-17);
      EXPECT_NEAR(distance_to(place.part, point + aside - drop * normal).value, 0.0, 1e-15);
    }
  }
}

TEST(SurfacePieceTest, EndsWhereTheShapeBends) {
  // Along a border's direction the piece holds up to its distance, and not beyond.
  for (const Place& place : places()) {
    const glm::dvec3 point = on_surface(place.part, place.point);
    const SurfacePiece piece = piece_at(place.part, point);
    for (const PieceBorder& border : piece.ends()) {
      EXPECT_GT(border.distance, 0.0);
      EXPECT_NEAR(glm::length(border.direction), 1.0, 1e-15);
      const glm::dvec3 inside =
          on_surface(place.part, point + 0.99 * border.distance * border.direction);
      const SurfacePiece there = piece_at(place.part, inside);
      EXPECT_EQ(there.quadric, piece.quadric);
      EXPECT_EQ(there.face, piece.face);
      EXPECT_EQ(there.center, piece.center);
    }
  }
  EXPECT_TRUE(piece_at(places()[0].part, {0.0, 0.05, 0.0}).ends().empty());
}

}  // namespace
}  // namespace torsion::engine
