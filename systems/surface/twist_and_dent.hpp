#pragma once

// The turn of a vertex about one axis, in float and in the same order of operations as
// shaders/deform.comp.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/vec3.hpp>

#include "ecs/components.hpp"
#include "ecs/model.hpp"
#include "ecs/snapshot.hpp"

namespace torsion::engine {

struct SineVersine {
  float sine = 0.0F;
  float versine = 0.0F;  // 1 - cos
};

/// Taylor series in [-pi/4, pi/4].
inline float sine_near_zero(float x) {
  const float z = x * x;
  return x +
         x * z *
             (-1.66666667e-1F + z * (8.33333333e-3F + z * (-1.98412698e-4F + z * 2.75573192e-6F)));
}
inline float cosine_near_zero(float x) {
  const float z = x * x;
  return 1.0F + z * (-0.5F + z * (4.16666667e-2F + z * (-1.38888889e-3F + z * 2.48015873e-5F)));
}

/// sine_and_versine() of twice an angle in (-pi/4, pi/4): of that without quarter turns, to the
/// same bits.
inline SineVersine sine_and_versine_of_half(float h) {
  const float s = sine_near_zero(h);
  return {2.0F * s * cosine_near_zero(h), 2.0F * s * s};
}

/// With h = angle / 2: sin = 2 sin h cos h, 1 - cos = 2 sin^2 h, so that small angles keep their
/// relative precision. h is brought to [-pi/4, pi/4] by quarter turns with pi/2 in three parts
/// (Cody and Waite 1980); sine and cosine are Taylor series there.
/// @param angle  rad; exact to float precision up to about a thousand turns
inline SineVersine sine_and_versine(float angle) {
  const float h = 0.5F * angle;
  const float quarters = std::nearbyint(h * 0.636619772F);
  const float x =
      ((h - quarters * 1.5703125F) - quarters * 4.83989716e-4F) + quarters * 1.62920680e-7F;
  const float s = sine_near_zero(x);
  const float c = cosine_near_zero(x);
  const bool swap = (static_cast<int>(quarters) & 1) != 0;
  const float product = 2.0F * s * c;
  return {swap ? -product : product, swap ? 2.0F * c * c : 2.0F * s * s};
}

/// Rodrigues' rotation as x + sin(t) k x r + (1 - cos(t)) k x (k x r), r from the axis point to x.
/// @param position  m, body
inline glm::vec3 turn_vertex(const glm::vec3& position, const TwistAxis& axis, float angle) {
  const SineVersine turn = sine_and_versine(angle);
  const glm::vec3 k(axis.direction);
  const glm::vec3 r = position - glm::vec3(axis.point);
  const glm::vec3 across(k.y * r.z - k.z * r.y, k.z * r.x - k.x * r.z, k.x * r.y - k.y * r.x);
  const glm::vec3 inward(k.y * across.z - k.z * across.y, k.z * across.x - k.x * across.z,
                         k.x * across.y - k.y * across.x);
  return position + (turn.sine * across + turn.versine * inward);
}

// Blocks of vertices as columns: what is the same for every vertex goes through them in loops that
// the compiler turns into vector instructions.

inline constexpr std::size_t kPointBlock = 256;

/// A number for each point of a block.
using BlockColumn = std::array<float, kPointBlock>;

/// A vector for each point of a block.
struct BlockVectors {
  BlockColumn x;
  BlockColumn y;
  BlockColumn z;

  [[nodiscard]] glm::dvec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const glm::dvec3& vector) {
    x[i] = static_cast<float>(vector.x);
    y[i] = static_cast<float>(vector.y);
    z[i] = static_cast<float>(vector.z);
  }
};

/// turn_vertex() for each point, to the same bits.
/// @param angles  rad
/// @param points  m, body; in and out
void turn_block(const TwistAxis& axis, const BlockColumn& angles, BlockVectors& points);

// What one contact region does to the surface around it: turn and dent, as functions of the place.
// docs/models.md, "Twist angles" and "Local dent".

/// A number that grows along one direction from zero at the fixed region to one at the contact,
/// clamped to [0, 1]: l_u / l_contact.
struct HeightShare {
  glm::dvec3 origin{0.0};  // m, body: q_f
  glm::dvec3 slope{0.0};   // 1/m, body

  [[nodiscard]] double at(const glm::dvec3& point) const;
};

/// Bonded discs that turn the surface of an elastic half-space, about one centre.
struct TurnedDiscs {
  glm::dvec3 center{0.0};  // m, body
  glm::dvec3 normal{0.0};  // body, unit, outward
  double radius = 0.0;     // m: of the largest; 0: there are none
  // Far away, at height z and distance R, the angle is turn_3 / R^3 + turn_5 (1 - 5 z^2 / R^2) /
  // R^5.
  double turn_3 = 0.0;                                    // rad m^3
  double turn_5 = 0.0;                                    // rad m^5
  double most = std::numeric_limits<double>::infinity();  // rad: nothing turns farther
  std::array<double, kFieldDiscs>
      turn{};  // rad: of the disc of radius (j + 1) / kFieldDiscs * radius

  /// Fills what is known of far away from the discs.
  void sum_far_terms();
  /// Angle by which the material at a point turns about the normal through the centre, rad.
  /// Source: Reissner & Sagoci, J. Appl. Phys. 15, 1944, in oblate spheroidal coordinates.
  [[nodiscard]] double angle(const glm::dvec3& point) const;
  /// The same for the first `used` points of a block.
  void angles(const BlockVectors& points, std::size_t used, BlockColumn& angles) const;
  /// The first two terms of the angle far away, by the height over the surface and the distance's
  /// square; 6e-4 off from 4 radii on.
  [[nodiscard]] double far_angle(double height, double square) const;
};

/// The twist of a body by one region, (10) to (13) of the paper as docs/models.md reads them.
struct RegionTwist {
  TwistAxis axis;             // for the vertices' turn
  TurnedDiscs discs;          // of a half-space model; then all below but the axis is of no account
  glm::dvec3 point{0.0};      // m, body: on the axis
  glm::dvec3 direction{0.0};  // body, unit
  double through = 0.0;       // share of the branch "the axis goes through the region"
  double stick_turn = 0.0;    // phi_m, rad
  double stick_radius = 0.0;  // r_m, m, > 0 where stick_turn is not 0
  HeightShare through_height;  // along the region's normal
  double past_turn = 0.0;      // rad at the contact: |T| l / (G J) with its sign
  HeightShare past_height;     // along the tool's axis

  /// Twist angle of a point of the rest shape [rad].
  [[nodiscard]] double angle(const glm::dvec3& rest) const;
  /// The same for the first `used` points of a block.
  void angles(const BlockVectors& rest, std::size_t used, BlockColumn& angles) const;
};

/// @param region  row in snapshot.regions
RegionTwist region_twist(const Model& model, const Snapshot& snapshot, std::uint32_t region);

/// Forces on the surface of an elastic half-space, each spread over a little area.
struct PressedSurface {
  struct Force {
    glm::dvec3 place{0.0};  // m, body
    glm::dvec3 force{0.0};  // N, body, on the material
  };
  std::array<Force, std::size_t{kFieldBlocks} * kFieldBlocks> forces{};
  std::uint32_t count = 0;     // 0: there are none
  Force all;                   // the sum, at the pressure centre
  glm::dvec3 normal{0.0};      // body, unit, outward
  double radius = 0.0;         // m: of the contact
  double spread = 0.0;         // m
  double shear_modulus = 0.0;  // Pa
  double poisson_ratio = 0.0;
  double share = 1.0;  // of the displacement that is drawn; the rest is the whole body's

  /// Displacement of the material at a point [m, body].
  [[nodiscard]] glm::dvec3 displacement(const glm::dvec3& point) const;
  /// Adds it for the first `used` points of a block.
  void add_displacements(const BlockVectors& points, std::size_t used, BlockVectors& sum) const;
  /// Share of the forces one by one in it; the rest is that of their sum.
  [[nodiscard]] double near_share(const glm::dvec3& point) const;
};

/// The dent that a contact presses and drags into an elastic half-space.
struct RegionDent {
  glm::dvec3 center{0.0};     // m, body
  glm::dvec3 normal{0.0};     // body, unit, outward
  double radius = 0.0;        // m: of the part that carries pressure
  double depth = 0.0;         // m, at the centre
  double flatness = 0.0;      // 0: Hertz' paraboloid, 1: flat punch
  glm::dvec3 drag{0.0};       // m, body: tangential displacement of the contact
  double pressure = 0.0;      // Pa, mean
  double full_overlap = 0.0;  // m: overlap from which the pressure is drawn in full
  PressedSurface pressed;  // of a half-space model: then depth, flatness and drag are of no account

  /// Distance of a point of the surface from the centre, in radii.
  [[nodiscard]] double reach(const glm::dvec3& point) const;
  /// Displacement of a point of the surface [m, body].
  [[nodiscard]] glm::dvec3 displacement(const glm::dvec3& point) const;
  /// Adds it for the first `used` points of a block.
  void add_displacements(const BlockVectors& points, std::size_t used, BlockVectors& sum) const;
  /// How much of the displacement at a far anchor is taken out again: 0 near the contact, 1 far
  /// away.
  [[nodiscard]] double far_share(const glm::dvec3& point) const;
};

/// @param moved  m, body: what the rest of the body's deformation does to the contact point; what
/// it already yields
///               is not dented once more
RegionDent region_dent(const Model& model, const Snapshot& snapshot, std::uint32_t region,
                       const glm::dvec3& moved);

}  // namespace torsion::engine
