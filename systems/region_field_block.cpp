// The fields of systems/region_field.hpp for blocks of points, in float. Most points of a body are
// far from a region, where one force and one couple are all there is to it.

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/region_field.hpp"

namespace torsion {
namespace {

constexpr double kNearRadii = 4.0;  // radii: beyond there is nothing but the far field

/// displacement_by_force() of a block, in float, with what is the same for all points taken out.
struct SpreadForce {
  glm::vec3 place;    // m, body
  glm::vec3 normal;   // body, unit
  glm::vec3 drag;     // tangential force over 4 pi G, m^2
  float pressing;     // normal force into the body over 4 pi G, m^2
  float spread;       // m^2, squared
  float free;         // 1 - 2 nu
  float compression;  // 2 (1 - nu)
};

SpreadForce spread_force(const PressedSurface& pressed, const PressedSurface::Force& each) {
  const double scale = pressed.share / (4.0 * std::numbers::pi * pressed.shear_modulus);
  const double pressing = -glm::dot(each.force, pressed.normal);
  return {glm::vec3(each.place),
          glm::vec3(pressed.normal),
          glm::vec3(scale * (each.force + pressed.normal * pressing)),
          static_cast<float>(scale * pressing),
          static_cast<float>(pressed.spread * pressed.spread),
          static_cast<float>(1.0 - 2.0 * pressed.poisson_ratio),
          static_cast<float>(2.0 - 2.0 * pressed.poisson_ratio)};
}

/// Source: Johnson, Contact Mechanics (1985), eq. 3.18 and 3.75, as in displacement_by_force().
void add_displacements_by(const SpreadForce& by, const BlockVectors& points, std::size_t used,
                          BlockVectors& sum) {
  const glm::vec3 n = by.normal;
  const glm::vec3 drag = by.drag;
  for (std::size_t i = 0; i < used; ++i) {
    const float dx = points.x[i] - by.place.x;
    const float dy = points.y[i] - by.place.y;
    const float dz = points.z[i] - by.place.z;
    const float height = dx * n.x + dy * n.y + dz * n.z;
    const float depth = height < 0.0F ? -height : 0.0F;
    const float x = dx - n.x * height;
    const float y = dy - n.y * height;
    const float z = dz - n.z * height;
    const float r = std::sqrt(x * x + y * y + z * z + depth * depth + by.spread);
    const float inverse = 1.0F / r;
    const float cube = inverse * inverse * inverse;
    const float sideways = 1.0F / (r + depth);
    const float free = by.free * inverse * sideways;
    const float along = drag.x * x + drag.y * y + drag.z * z;
    const float outward = by.pressing * (depth * cube - free) + along * (cube - free * sideways);
    const float dragged = inverse + by.free * sideways;
    const float down = by.pressing * (depth * depth * cube + by.compression * inverse) +
                       along * (depth * cube + free);
    sum.x[i] += x * outward + drag.x * dragged - n.x * down;
    sum.y[i] += y * outward + drag.y * dragged - n.y * down;
    sum.z[i] += z * outward + drag.z * dragged - n.z * down;
  }
}

}  // namespace

void TurnedDiscs::angles(const BlockVectors& points, std::size_t used, BlockColumn& angles) const {
  const glm::vec3 c(center);
  const glm::vec3 up(normal);
  const auto far_3 = static_cast<float>(turn_3);
  const auto far_5 = static_cast<float>(turn_5);
  BlockColumn square;
  for (std::size_t i = 0; i < kPointBlock; ++i) {
    const float dx = points.x[i] - c.x;
    const float dy = points.y[i] - c.y;
    const float dz = points.z[i] - c.z;
    square[i] = dx * dx + dy * dy + dz * dz;
    const float height = dx * up.x + dy * up.y + dz * up.z;
    const float inverse = 1.0F / square[i];
    angles[i] = (far_3 + far_5 * inverse * (1.0F - 5.0F * height * height * inverse)) * inverse /
                std::sqrt(square[i]);
  }
  const auto near = static_cast<float>(kNearRadii * kNearRadii * radius * radius);
  for (std::size_t i = 0; i < used; ++i) {
    if (square[i] < near) {
      angles[i] = static_cast<float>(angle(points.at(i)));
    }
  }
}

void RegionTwist::angles(const BlockVectors& rest, std::size_t used, BlockColumn& angles) const {
  if (discs.radius > 0.0) {
    discs.angles(rest, used, angles);
    return;
  }
  for (std::size_t i = 0; i < used; ++i) {
    angles[i] = static_cast<float>(angle(rest.at(i)));
  }
}

void PressedSurface::add_displacements(const BlockVectors& points, std::size_t used,
                                       BlockVectors& sum) const {
  BlockVectors moved{};
  add_displacements_by(spread_force(*this, all), points, kPointBlock, moved);
  // Near points, packed together, and what they get instead.
  std::array<std::size_t, kPointBlock> rows;
  BlockVectors near;
  std::size_t found = 0;
  const glm::vec3 c(all.place);
  const auto reach = static_cast<float>(kNearRadii * kNearRadii * radius * radius);
  for (std::size_t i = 0; i < used; ++i) {
    const float dx = points.x[i] - c.x;
    const float dy = points.y[i] - c.y;
    const float dz = points.z[i] - c.z;
    if (dx * dx + dy * dy + dz * dz < reach) {
      near.x[found] = points.x[i];
      near.y[found] = points.y[i];
      near.z[found] = points.z[i];
      rows[found++] = i;
    }
  }
  BlockVectors each{};
  for (std::uint32_t force = 0; force < (found > 0 ? count : 0); ++force) {
    add_displacements_by(spread_force(*this, forces[force]), near, found, each);
  }
  for (std::size_t k = 0; k < found; ++k) {
    const std::size_t i = rows[k];
    const double share_near = near_share(near.at(k));
    moved.set(i, share_near * each.at(k) + (1.0 - share_near) * moved.at(i));
  }
  for (std::size_t i = 0; i < kPointBlock; ++i) {
    sum.x[i] += moved.x[i];
    sum.y[i] += moved.y[i];
    sum.z[i] += moved.z[i];
  }
}

void RegionDent::add_displacements(const BlockVectors& points, std::size_t used,
                                   BlockVectors& sum) const {
  if (radius <= 0.0) {
    return;
  }
  if (pressed.count > 0) {
    pressed.add_displacements(points, used, sum);
    return;
  }
  for (std::size_t i = 0; i < used; ++i) {
    sum.set(i, sum.at(i) + displacement(points.at(i)));
  }
}

}  // namespace torsion
