#include "systems/body/skeleton/beam_sections.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/math/frames.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
namespace {

using Complex = std::complex<double>;

constexpr int kHarmonicDegree = 16;
constexpr int kUnknowns = 2 * kHarmonicDegree + 1;
constexpr int kBoundaryPoints = 3 * kUnknowns;

/// Points equally spaced along the boundary, starting half a spacing after the first corner.
void sample_boundary(const std::vector<Complex>& corners, std::vector<Complex>& points) {
  double perimeter = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    perimeter += std::abs(corners[(i + 1) % corners.size()] - corners[i]);
  }
  const double spacing = perimeter / static_cast<double>(kBoundaryPoints);
  double next = 0.5 * spacing;
  double start = 0.0;
  points.clear();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Complex edge = corners[(i + 1) % corners.size()] - corners[i];
    const double length = std::abs(edge);
    for (; next < start + length && points.size() < static_cast<std::size_t>(kBoundaryPoints);
         next += spacing) {
      points.push_back(corners[i] + edge * ((next - start) / length));
    }
    start += length;
  }
}

/// Integral of z^n over the polygon for n = 0..kHarmonicDegree. A triangle with apex 0 and base z1
/// z2 gives cross(z1, z2) / ((n + 1)(n + 2)) * sum over k of z1^k z2^(n-k).
std::array<Complex, kHarmonicDegree + 1> integrate_powers(const std::vector<Complex>& corners) {
  std::array<Complex, kHarmonicDegree + 1> integrals{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Complex a = corners[i];
    const Complex b = corners[(i + 1) % corners.size()];
    const double doubled_area = a.real() * b.imag() - a.imag() * b.real();
    Complex power = 1.0;  // a^n
    Complex sum = 1.0;    // sum over k of a^k b^(n-k)
    for (int n = 0; n <= kHarmonicDegree; ++n) {
      integrals[static_cast<std::size_t>(n)] +=
          sum * (doubled_area / static_cast<double>((n + 1) * (n + 2)));
      power *= a;
      sum = sum * b + power;
    }
  }
  return integrals;
}

}  // namespace

PolygonMoments polygon_moments(const std::vector<glm::dvec2>& polygon) {
  PolygonMoments moments;
  glm::dvec2 first(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& a = polygon[i];
    const glm::dvec2& b = polygon[(i + 1) % polygon.size()];
    const double c = cross(a, b);
    moments.area += c / 2.0;
    first += (a + b) * (c / 6.0);
    moments.xx += c * (a.y * a.y + a.y * b.y + b.y * b.y) / 12.0;
    moments.yy += c * (a.x * a.x + a.x * b.x + b.x * b.x) / 12.0;
    moments.xy += c * (a.x * b.y + 2.0 * a.x * a.y + 2.0 * b.x * b.y + b.x * a.y) / 24.0;
  }
  if (moments.area <= 0.0) {
    return PolygonMoments{};
  }
  moments.centroid = first / moments.area;
  moments.xx -= moments.area * moments.centroid.y * moments.centroid.y;
  moments.yy -= moments.area * moments.centroid.x * moments.centroid.x;
  moments.xy -= moments.area * moments.centroid.x * moments.centroid.y;
  return moments;
}

double torsion_constant(const std::vector<glm::dvec2>& polygon) {
  const PolygonMoments moments = polygon_moments(polygon);
  if (moments.area <= 0.0) {
    return 0.0;
  }
  // Scaled to radius 1 about the centroid, so that the powers of z have similar sizes.
  double radius = 0.0;
  for (const glm::dvec2& corner : polygon) {
    radius = std::max(radius, glm::length(corner - moments.centroid));
  }
  std::vector<Complex> corners;
  corners.reserve(polygon.size());
  for (const glm::dvec2& corner : polygon) {
    corners.emplace_back((corner.x - moments.centroid.x) / radius,
                         (corner.y - moments.centroid.y) / radius);
  }
  std::vector<Complex> points;
  points.reserve(kBoundaryPoints);
  sample_boundary(corners, points);

  // psi = h - r^2/2 with h harmonic; h = r^2/2 on the boundary.
  Eigen::MatrixXd basis(points.size(), kUnknowns);
  Eigen::VectorXd wanted(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    basis(row, 0) = 1.0;
    Complex power = 1.0;
    for (Eigen::Index n = 1; n <= kHarmonicDegree; ++n) {
      power *= points[i];
      basis(row, 2 * n - 1) = power.real();
      basis(row, 2 * n) = power.imag();
    }
    wanted(row) = 0.5 * std::norm(points[i]);
  }
  const Eigen::VectorXd weights = least_squares(basis, wanted);

  const auto integrals = integrate_powers(corners);
  double harmonic = weights(0) * integrals[0].real();
  for (int n = 1; n <= kHarmonicDegree; ++n) {
    const Complex& integral = integrals[static_cast<std::size_t>(n)];
    const Eigen::Index imaginary = Eigen::Index{2} * n;
    harmonic += weights(imaginary - 1) * integral.real() + weights(imaginary) * integral.imag();
  }
  const double fourth = radius * radius * radius * radius;
  return 2.0 * harmonic * fourth - (moments.xx + moments.yy);
}

TransverseAxes transverse_axes(const glm::dvec3& direction, const glm::dvec3& reference) {
  // A fixed perpendicular of the reference: the coordinate axis that is farthest from it, made
  // perpendicular.
  const glm::dvec3 size = glm::abs(reference);
  glm::dvec3 helper(0.0, 0.0, 1.0);
  if (size.x <= size.y && size.x <= size.z) {
    helper = glm::dvec3(1.0, 0.0, 0.0);
  } else if (size.y <= size.z) {
    helper = glm::dvec3(0.0, 1.0, 0.0);
  }
  const glm::dvec3 first = glm::normalize(helper - reference * glm::dot(helper, reference));
  // The smallest turn that takes reference to direction, applied to it (Rodrigues with cross
  // products).
  const glm::dvec3 axis = glm::cross(reference, direction);
  const double cosine = glm::dot(reference, direction);
  const double denominator = std::max(1.0 + cosine, 1e-12);
  const glm::dvec3 carried =
      first * cosine + glm::cross(axis, first) + axis * (glm::dot(axis, first) / denominator);
  const glm::dvec3 square = glm::normalize(carried - direction * glm::dot(carried, direction));
  return {square, glm::cross(direction, square)};
}

glm::dvec3 beam_reference(const FixedRegion& fixed, const Bounds& bounds) {
  if (fixed.kind == FixedKind::kFace) {
    return fixed.normal;
  }
  const glm::dvec3 to_middle = 0.5 * (bounds.lowest + bounds.highest) - fixed.point;
  const double length = glm::length(to_middle);
  const double size = glm::length(bounds.highest - bounds.lowest);
  return length > 1e-6 * size ? to_middle / length : glm::dvec3(0.0, 1.0, 0.0);
}

}  // namespace torsion::engine
