// The fields of systems/surface/twist_and_dent.hpp for blocks of points, in float. Most points of a
// body are far from a region, and need one force and one couple only.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/math/lanes.hpp"
#include "systems/math/smooth_step.hpp"
#include "systems/surface/twist_and_dent.hpp"

namespace torsion::engine {
namespace {

constexpr double kNearRadii = 4.0;  // radii: beyond there is nothing but the far field

/// displacement_by_force() for a block, in float, with what is equal for all points computed once.
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
TORSION_WIDEST
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

/// Places of points relative to the discs' common centre.
struct PlacesAboutDiscs {
  BlockColumn height;  // m
  BlockColumn square;  // m^2: of the distance
};

TORSION_WIDEST
void find_places(const TurnedDiscs& discs, const BlockVectors& points, PlacesAboutDiscs& places) {
  const glm::vec3 c(discs.center);
  const glm::vec3 up(discs.normal);
  for (std::size_t i = 0; i < kPointBlock; ++i) {
    const float dx = points.x[i] - c.x;
    const float dy = points.y[i] - c.y;
    const float dz = points.z[i] - c.z;
    places.square[i] = dx * dx + dy * dy + dz * dz;
    places.height[i] = dx * up.x + dy * up.y + dz * up.z;
  }
}

/// TurnedDiscs::far_angle().
TORSION_WIDEST
void far_angles(const TurnedDiscs& discs, const PlacesAboutDiscs& places, BlockColumn& angles) {
  const auto far_3 = static_cast<float>(discs.turn_3);
  const auto far_5 = static_cast<float>(discs.turn_5);
  for (std::size_t i = 0; i < kPointBlock; ++i) {
    const float height = places.height[i];
    const float inverse = 1.0F / places.square[i];
    angles[i] = (far_3 + far_5 * inverse * (1.0F - 5.0F * height * height * inverse)) * inverse /
                std::sqrt(places.square[i]);
  }
}

/// Angle of a point at oblate spheroidal height zeta over a disc that turns by 1: 2 / pi times
/// acot(zeta) - zeta / (1 + zeta^2). The arctangent up to 1 to 2e-8 by Abramowitz & Stegun,
/// Handbook of Mathematical Functions (1964), 4.4.49.
inline float angle_over_disc(float zeta) {
  constexpr float kHalfPi = 0.5F * std::numbers::pi_v<float>;
  const bool below = zeta < 1.0F;
  const float x = below ? zeta : 1.0F / zeta;
  const float z = x * x;
  const float arctangent =
      x +
      x * z *
          (-0.3333314528F +
           z * (0.1999355085F +
                z * (-0.1420889944F +
                     z * (0.1065626393F +
                          z * (-0.0752896400F +
                               z * (0.0429096138F + z * (-0.0161657367F + z * 0.0028662257F)))))));
  const float arccotangent = below ? kHalfPi - arctangent : arctangent;
  return (arccotangent - zeta / (1.0F + zeta * zeta)) / kHalfPi;
}

/// The sum of TurnedDiscs::angle() over the discs. Inside a disc's cylinder the root of zeta's
/// equation is taken in the form that loses no digits.
/// @param angles  out
TORSION_WIDEST
void near_angles(const TurnedDiscs& discs, const PlacesAboutDiscs& places, std::size_t used,
                 BlockColumn& angles) {
  std::fill(angles.begin(), angles.end(), 0.0F);
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    const auto turn = static_cast<float>(discs.turn[j]);
    const auto per_radius =
        static_cast<float>(kFieldDiscs / (discs.radius * static_cast<double>(j + 1)));
    for (std::size_t i = 0; i < used; ++i) {
      const float z = places.height[i] * per_radius;
      const float excess = places.square[i] * per_radius * per_radius - 1.0F;
      const float root = std::sqrt(excess * excess + 4.0F * z * z);
      const float both = root + std::abs(excess);
      const float inside = both > 0.0F ? 2.0F * z * z / both : 0.0F;
      const float zeta = std::sqrt(excess < 0.0F ? inside : 0.5F * both);
      angles[i] += turn * angle_over_disc(zeta);
    }
  }
}

TORSION_WIDEST
void clamp_angles(float most, BlockColumn& angles) {
  for (float& angle : angles) {
    angle = std::min(std::max(angle, -most), most);
  }
}

}  // namespace

void TurnedDiscs::angles(const BlockVectors& points, std::size_t used, BlockColumn& angles) const {
  PlacesAboutDiscs places;
  find_places(*this, points, places);
  far_angles(*this, places, angles);
  // Near points, packed together, and their results.
  std::array<std::size_t, kPointBlock> rows;
  PlacesAboutDiscs near;
  std::size_t found = 0;
  const auto reach = static_cast<float>(kNearRadii * kNearRadii * radius * radius);
  for (std::size_t i = 0; i < used; ++i) {
    if (places.square[i] < reach) {
      near.height[found] = places.height[i];
      near.square[found] = places.square[i];
      rows[found++] = i;
    }
  }
  const auto limit = static_cast<float>(most);
  if (found == 0) {
    clamp_angles(limit, angles);
    return;
  }
  BlockColumn sums;
  near_angles(*this, near, found, sums);
  for (std::size_t k = 0; k < found; ++k) {
    const double distance = std::sqrt(static_cast<double>(near.square[k])) / radius;
    const auto share = static_cast<float>(1.0 - smooth_step(distance - 3.0));
    float& angle = angles[rows[k]];
    // The far field is unbounded at the centre.
    angle = share < 1.0F ? share * sums[k] + (1.0F - share) * angle : sums[k];
  }
  clamp_angles(limit, angles);
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
  // Near points, packed together, and their results.
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

}  // namespace torsion::engine
