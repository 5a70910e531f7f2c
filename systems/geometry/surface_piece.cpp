#include "systems/geometry/surface_piece.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

void end_at(SurfacePiece& piece, const glm::dvec3& direction, double distance) {
  piece.border_list[piece.borders++] = {direction, distance};
}

/// Both ends of a piece from -reach to reach along an axis.
void end_along(SurfacePiece& piece, const glm::dvec3& axis, double place, double reach) {
  end_at(piece, axis, reach - place);
  end_at(piece, -axis, reach + place);
}

SurfacePiece box_face(const glm::dvec3& half, const glm::dvec3& point) {
  const glm::dvec3 over = glm::abs(point) - half;
  int side = 0;
  for (int axis = 1; axis < 3; ++axis) {
    side = over[axis] > over[side] ? axis : side;
  }
  SurfacePiece piece;
  piece.face[side] = std::copysign(1.0, point[side]);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != side) {
      glm::dvec3 along(0.0);
      along[axis] = 1.0;
      end_along(piece, along, point[axis], half[axis]);
    }
  }
  return piece;
}

SurfacePiece cylinder_piece(double radius, double half_height, const glm::dvec3& point) {
  SurfacePiece piece;
  const double from_axis = std::hypot(point.x, point.z);
  if (from_axis - radius >= std::abs(point.y) - half_height) {
    piece.quadric = glm::dvec3(1.0, 0.0, 1.0) / (radius * radius);
    end_along(piece, {0.0, 1.0, 0.0}, point.y, half_height);
    return piece;
  }
  piece.face.y = std::copysign(1.0, point.y);
  // The rim, as if it were equally near on all sides.
  end_along(piece, {1.0, 0.0, 0.0}, 0.0, radius - from_axis);
  end_along(piece, {0.0, 0.0, 1.0}, 0.0, radius - from_axis);
  return piece;
}

SurfacePiece capsule_piece(double radius, double half_segment, const glm::dvec3& point) {
  SurfacePiece piece;
  if (std::abs(point.y) <= half_segment) {
    piece.quadric = glm::dvec3(1.0, 0.0, 1.0) / (radius * radius);
    end_along(piece, {0.0, 1.0, 0.0}, point.y, half_segment);
    return piece;
  }
  const double side = std::copysign(1.0, point.y);
  piece.quadric = glm::dvec3(1.0 / (radius * radius));
  piece.center.y = side * half_segment;
  if (half_segment > 0.0) {
    end_at(piece, {0.0, -side, 0.0}, std::abs(point.y) - half_segment);
  }
  return piece;
}

}  // namespace

SurfacePiece piece_at(const ShapePart& part, const glm::dvec3& point) {
  const glm::dvec3& half = part.half_extent;
  SurfacePiece piece;
  switch (part.kind) {
    case ShapeKind::kBox:
      return box_face(half, point);
    case ShapeKind::kCylinder:
      return cylinder_piece(half.x, half.y, point);
    case ShapeKind::kCapsule:
      return capsule_piece(half.x, std::max(half.y - half.x, 0.0), point);
    case ShapeKind::kSphere:
      piece.quadric = glm::dvec3(1.0 / (half.x * half.x));
      return piece;
    default:
      piece.quadric = 1.0 / (half * half);
      return piece;
  }
}

glm::dmat3 curvature_at(const SurfacePiece& piece, const glm::dvec3& point) {
  // The normal is g / |g| with g = Q (x - c). Its derivative is Q / |g| without the component along
  // the normal.
  const glm::dvec3 gradient = piece.quadric * (point - piece.center);
  const double length = glm::length(gradient);
  if (length == 0.0) {
    return glm::dmat3(0.0);
  }
  const glm::dvec3 normal = gradient / length;
  const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(normal, normal);
  const glm::dmat3 quadric(piece.quadric.x / length, 0.0, 0.0, 0.0, piece.quadric.y / length, 0.0,
                           0.0, 0.0, piece.quadric.z / length);
  return across * quadric * across;
}

double drop_at(const SurfacePiece& piece, const glm::dvec3& point, const glm::dvec3& normal,
               const glm::dvec3& aside) {
  if (piece.face != glm::dvec3(0.0)) {
    return glm::dot(piece.face, aside) / glm::dot(piece.face, normal);
  }
  // (y - z n)' Q (y - z n) = 1 with y from the centre: A z^2 - 2 B z + C = 0, the root near zero.
  const glm::dvec3 place = point - piece.center + aside;
  const double a = glm::dot(normal, piece.quadric * normal);
  const double b = glm::dot(normal, piece.quadric * place);
  const double c = glm::dot(place, piece.quadric * place) - 1.0;
  return c / (b + std::sqrt(b * b - a * c));
}

}  // namespace torsion::engine
