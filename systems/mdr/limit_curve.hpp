#pragma once

// Which friction forces and couples a sliding and spinning round contact can carry together.

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>

namespace torsion {

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

}  // namespace torsion
