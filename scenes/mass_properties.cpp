#include "scenes/mass_properties.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

/// integral of x x^T over a body, given as a matrix, to its inertia.
glm::dmat3 inertia_of(const glm::dmat3& second_moment) {
  const double trace = second_moment[0][0] + second_moment[1][1] + second_moment[2][2];
  return glm::dmat3(trace) - second_moment;
}

}  // namespace

MassProperties mass_properties(std::span<const PartDescription> parts, double mass) {
  double volume = 0.0;
  glm::dvec3 first(0.0);
  glm::dmat3 second(0.0);
  for (const PartDescription& part : parts) {
    for (const glm::uvec3& t : part.surface.triangles) {
      const glm::dvec3& a = part.surface.positions[t.x];
      const glm::dvec3& b = part.surface.positions[t.y];
      const glm::dvec3& c = part.surface.positions[t.z];
      const double tetrahedron = glm::dot(a, glm::cross(b, c)) / 6.0;
      const glm::dvec3 sum = a + b + c;
      volume += tetrahedron;
      first += tetrahedron * 0.25 * sum;
      second += tetrahedron / 20.0 *
                (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c) +
                 glm::outerProduct(sum, sum));
    }
  }
  MassProperties properties;
  properties.mass = mass;
  if (volume > 0.0) {
    properties.center = first / volume;
    const glm::dmat3 about_center =
        mass / volume * second - mass * glm::outerProduct(properties.center, properties.center);
    properties.inertia = inertia_of(about_center);
  }
  return properties;
}

void move_mass_center(MassProperties& properties, const glm::dvec3& center) {
  const glm::dvec3 shift = center - properties.center;
  properties.inertia += inertia_of(properties.mass * glm::outerProduct(shift, shift));
  properties.center = center;
}

}  // namespace torsion::engine
