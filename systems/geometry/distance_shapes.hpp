#pragma once

#include <cmath>

#include "systems/geometry/distance.hpp"
#include "systems/math/lanes.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {

/// How far a distance's gradient is a normal: 1 where its length is. Beside the edges of a mesh the
/// distances of a field are between those to both faces, and so is their gradient, which is shorter
/// for that: 0 from .96 of a normal's length.
inline double normal_share(double length_squared) {
  constexpr double kBetweenFaces = 0.93;
  constexpr double kOnFace = 0.99;
  return smooth_step((length_squared - kBetweenFaces) / (kOnFace - kBetweenFaces));
}

// Signed distance to one exact shape in its own frame: negative inside, with a unit gradient. All
// are free of branches, so that a loop over them vectorises, and give NaN for NaN.

/// Sphere about the origin. At the centre the gradient is +x.
struct SphereDistance {
  double radius;  // m

  Distance operator()(double x, double y, double z) const {
    const double length = std::sqrt(x * x + y * y + z * z);
    const bool centre = length == 0.0;
    const double scale = 1.0 / (centre ? 1.0 : length);
    return {length - radius, {centre ? 1.0 : x * scale, y * scale, z * scale}};
  }
};

/// Box of half sides half_extent. Inside, the nearest face; x before y before z where two are
/// equally near.
struct BoxDistance {
  glm::dvec3 half_extent;  // m

  Distance operator()(double x, double y, double z) const {
    const double qx = std::abs(x) - half_extent.x;
    const double qy = std::abs(y) - half_extent.y;
    const double qz = std::abs(z) - half_extent.z;
    const double nearest = larger(larger(qx, qy), qz);
    const double ox = larger(qx, 0.0);
    const double oy = larger(qy, 0.0);
    const double oz = larger(qz, 0.0);
    const double length = std::sqrt(ox * ox + oy * oy + oz * oz);
    const bool outside = length > 0.0;
    const double scale = 1.0 / (outside ? length : 1.0);
    const double face_x = qx == nearest ? 1.0 : 0.0;
    const double face_y = (qy == nearest ? 1.0 : 0.0) * (1.0 - face_x);
    const double face_z = (1.0 - face_x) * (1.0 - face_y);
    const double value = outside ? length : nearest;
    return {value + 0.0 * (x + y + z),
            {std::copysign(outside ? ox * scale : face_x, x),
             std::copysign(outside ? oy * scale : face_y, y),
             std::copysign(outside ? oz * scale : face_z, z)}};
  }
};

/// Cylinder about the y axis, with flat ends. On the axis the radial direction is +x.
struct CylinderDistance {
  double radius;       // m
  double half_height;  // m

  Distance operator()(double x, double y, double z) const {
    const double axial = std::abs(y) - half_height;
    const double from_axis = std::sqrt(x * x + z * z);
    const double radial = from_axis - radius;
    const bool on_axis = from_axis == 0.0;
    const double inverse = 1.0 / (on_axis ? 1.0 : from_axis);
    const double radial_x = on_axis ? 1.0 : x * inverse;
    const double radial_z = z * inverse;
    const double oa = larger(axial, 0.0);
    const double radial_out = larger(radial, 0.0);
    const double length = std::sqrt(oa * oa + radial_out * radial_out);
    const bool outside = length > 0.0;
    const double scale = 1.0 / (outside ? length : 1.0);
    const double side =
        radial >= axial ? 1.0 : 0.0;  // inside: the nearer of the mantle and the ends
    const double along_radial = outside ? radial_out * scale : side;
    const double along_axis = outside ? oa * scale : 1.0 - side;
    const double value = outside ? length : larger(radial, axial);
    return {value + 0.0 * (x + y + z),
            {radial_x * along_radial, std::copysign(along_axis, y), radial_z * along_radial}};
  }
};

/// Capsule about the y axis: all points within `radius` of a segment. On the segment the gradient
/// is +x.
struct CapsuleDistance {
  double radius;        // m
  double half_segment;  // m: half height without the caps

  Distance operator()(double x, double y, double z) const {
    const double above = std::copysign(larger(std::abs(y) - half_segment, 0.0), y);
    return SphereDistance{radius}(x, above + 0.0 * y, z);
  }
};

/// Ellipsoid of semi-axes `semi_axis` along x, y, z.
///
/// The signed distance to a convex body is the largest of n.p - h(n) over all unit normals n, with
/// the support function h(n) = sqrt(sum a_i^2 n_i^2). The normal at the closest point is n_i ~ p_i
/// / (t + a_i^2) where t > -min a_i^2 solves |v(t)| = 1, v_i = a_i p_i / (t + a_i^2) (Eberly,
/// "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", 2013). 1 / |v(t)| is
/// increasing and concave, nearly straight, and straight for a sphere, so Newton on 1 / |v| = 1
/// (Hebden 1973, More and Sorensen 1983) started anywhere is left of the root after one step and
/// rises to it. An error e of n makes one of order e^2 in the value, always downwards, so that
/// outside the value never exceeds the distance. On the surface t = 0 is the start and the result
/// is exact.
struct EllipsoidDistance {
  glm::dvec3 semi_axis;  // m
  glm::dvec3 squared;    // m^2

  explicit EllipsoidDistance(const glm::dvec3& axes) : semi_axis(axes), squared(axes * axes) {}

  Distance operator()(double x, double y, double z) const {
    // At t = a_i |p_i| - a_i^2 the i-th term alone is 1: never right of the root. The 1e-9 keeps t
    // + a_i^2 positive.
    const double keep = 1.0 - 1e-9;
    const double floor = larger(larger(semi_axis.x * (std::abs(x) - keep * semi_axis.x),
                                       semi_axis.y * (std::abs(y) - keep * semi_axis.y)),
                                semi_axis.z * (std::abs(z) - keep * semi_axis.z));
    double t = 0.0;
    double sx = x / squared.x;
    double sy = y / squared.y;
    double sz = z / squared.z;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const double dx = 1.0 / (t + squared.x);
      const double dy = 1.0 / (t + squared.y);
      const double dz = 1.0 / (t + squared.z);
      const double vx = x * dx * semi_axis.x;
      const double vy = y * dy * semi_axis.y;
      const double vz = z * dz * semi_axis.z;
      const double square = vx * vx + vy * vy + vz * vz;
      const double slope = vx * vx * dx + vy * vy * dy + vz * vz * dz;
      const double step = square * (std::sqrt(square) - 1.0) / (slope > 0.0 ? slope : 1.0);
      t = larger(t + step, floor);
      sx = x / (t + squared.x);
      sy = y / (t + squared.y);
      sz = z / (t + squared.z);
    }
    const double length = std::sqrt(sx * sx + sy * sy + sz * sz);
    const bool centre = length == 0.0;
    const double scale = 1.0 / (centre ? 1.0 : length);
    const double nx =
        centre ? (squared.x <= squared.y && squared.x <= squared.z ? 1.0 : 0.0) : sx * scale;
    const double ny =
        centre ? (squared.y < squared.x && squared.y <= squared.z ? 1.0 : 0.0) : sy * scale;
    const double nz =
        centre ? (squared.z < squared.x && squared.z < squared.y ? 1.0 : 0.0) : sz * scale;
    const double support =
        std::sqrt(squared.x * nx * nx + squared.y * ny * ny + squared.z * nz * nz);
    return {nx * x + ny * y + nz * z - support, {nx, ny, nz}};
  }

  static constexpr int kIterations = 2;
};

/// Calls f with the distance function of an exact shape, in the part's frame. @pre part.kind is not
/// kMesh
template <class F>
auto with_exact_shape(const ShapePart& part, F&& f) {
  const glm::dvec3& half = part.half_extent;
  switch (part.kind) {
    case ShapeKind::kSphere:
      return f(SphereDistance{half.x});
    case ShapeKind::kEllipsoid:
      return f(EllipsoidDistance(half));
    case ShapeKind::kBox:
      return f(BoxDistance{half});
    case ShapeKind::kCylinder:
      return f(CylinderDistance{half.x, half.y});
    default:
      return f(CapsuleDistance{half.x, larger(half.y - half.x, 0.0)});
  }
}

}  // namespace torsion::engine
