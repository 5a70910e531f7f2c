#pragma once

// Which friction forces and couples a sliding and spinning round contact can carry together.

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>

#include "ecs/components.hpp"

namespace torsion::engine {

inline constexpr int kLimitCurveSegments = 128;

/// The exact limit curve of a Hertz pressure as a polygon inside it: (force over mu F_n, couple
/// over its largest value), from pure sliding (1, 0) to pure spinning (0, 1). Sags by less than
/// 5e-5. Source: docs/models.md (a rigid disc that slides at v and spins at w, x = v / (w a),
/// integrated over the pressure of Hertz).
struct LimitCurve {
  std::array<glm::dvec2, kLimitCurveSegments + 1> points{};
};

LimitCurve make_limit_curve();

/// The point of the curve's inside that is nearest to `load` (both components >= 0), where lengths
/// along the axes count with `weights`: the associated return map of an elastic layer with these
/// limits, so that what slips slips along the curve's normal.
/// @param weights  > 0: elastic energy at the limit along each axis
/// @param segment  in: where to begin to look, any; out: the curve's segment that was found. Loads
///                 that change little from call to call find it at once
glm::dvec2 nearest_inside(const LimitCurve& curve, const glm::dvec2& load,
                          const glm::dvec2& weights, std::size_t& segment);

/// The square of a load's length below which it is inside in any case: the curve's nearest point is
/// 0.94 from the origin.
inline constexpr double kSurelyInside = 0.88;

// Where the springs of a round contact sit: the one-dimensional foundations of the method of
// dimensionality reduction, cut into pieces on which the deflection is linear.

inline constexpr std::size_t kMdrPieces = kMdrLayers / 2;

/// One foundation over x / a from the rim (1) to the centre (0). Each piece carries two springs at
/// places such that a deflection linear on the piece is known from them and its energy is theirs to
/// the last digit (Gauss quadrature's, or another pair with orthogonal linear functions).
struct MdrFoundation {
  std::array<double, kMdrPieces + 1> edges{};  // x / a, falling from 1 to 0
  std::array<double, kMdrLayers> place{};      // x / a, falling
  std::array<double, kMdrLayers> stiffness{};  // of the spring over that of all; sums to 1
};

/// Both foundations. Piece k slips after the same share of the whole friction has slipped in pure
/// sliding as in pure spinning, so all layers have limit curves of one shape and their sum never
/// leaves it.
struct MdrPlaces {
  MdrFoundation shift;                          // measure dx
  MdrFoundation turn;                           // measure x^2 dx
  std::array<double, kMdrPieces> turn_outer{};  // -1 to 1: of its outer spring on each piece
  std::array<double, kMdrLayers> share{};  // of all friction that each layer can hold; sums to 1
  // Stiffness over that share: how soon each layer slips, 1 on average.
  std::array<double, kMdrLayers> shift_haste{};
  std::array<double, kMdrLayers> turn_haste{};
};

/// What of a contact decides where its springs sit.
struct MdrPressure {
  double flat_share = 0.0;  // of F_n by a flat punch's pressure, the rest by a paraboloid's
  double elongation = 0.0;  // 1 - b / a

  bool operator==(const MdrPressure&) const = default;
};

/// Contacts of any pressure between a paraboloid's and a flat punch's, and of any elongation.
struct MdrTables {
  static constexpr std::size_t kShapes = 9;  // flat shares 0, 1/8, ..., 1
  static constexpr std::size_t kElongations = 2;
  std::array<std::array<MdrPlaces, kShapes>, kElongations> places{};
  LimitCurve limit_curve;
};

/// Source: Popov & Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction, 2015
/// (normal and tangential springs); the torsional thresholds are the Abel transform of the pressure
/// (docs/models.md).
MdrTables make_mdr_tables();

/// The places for a pressure between those of the tables.
MdrPlaces places_of(const MdrTables& tables, const MdrPressure& pressure);

}  // namespace torsion::engine
