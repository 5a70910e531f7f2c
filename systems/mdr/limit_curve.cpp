#include "systems/mdr/limit_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace torsion {
namespace {

using std::numbers::pi;

/// Force and couple of a Hertz contact that slides at v and spins at w, x = v / (w a), over their
/// largest values. Derived like Zhuravlev's solution: J. Appl. Math. Mech. 62 (1998) 705.
glm::dvec2 sliding_load(double x) {
  const double x2 = x * x;
  if (x <= 1.0) {
    return {3.0 * pi / 8.0 * x * (1.0 - 0.25 * x2), 1.0 - x2 + 0.375 * x2 * x2};
  }
  if (x > 60.0) {  // the exact terms cancel
    return {1.0 - 0.1 / x2, 16.0 / (15.0 * pi * x)};
  }
  const double w = std::sqrt(x2 - 1.0);
  const double s = std::asin(1.0 / x);
  return {0.75 / x * ((x2 - 0.25 * x2 * x2) * s + 0.25 * (3.0 * w + w * w * w)),
          4.0 / pi * ((0.5 - 0.5 * x2 + 0.1875 * x2 * x2) * s + 0.1875 * (w - w * w * w))};
}

/// Half the rate at which the weighted distance from `load` falls when `from` goes towards `to`.
double approach(const glm::dvec2& load, const glm::dvec2& weights, const glm::dvec2& from,
                const glm::dvec2& to) {
  return glm::dot(weights * (load - from), to - from);
}

}  // namespace

LimitCurve make_limit_curve() {
  LimitCurve curve;
  for (int k = 0; k <= kLimitCurveSegments; ++k) {
    // Equal steps of the slip's direction, scaled so that the points lie about evenly.
    const double angle = 0.5 * pi * k / kLimitCurveSegments;
    curve.points[static_cast<std::size_t>(k)] = k == 0 ? glm::dvec2(1.0, 0.0)
                                                : k == kLimitCurveSegments
                                                    ? glm::dvec2(0.0, 1.0)
                                                    : sliding_load(0.7 / std::tan(angle));
  }
  return curve;
}

glm::dvec2 nearest_inside(const LimitCurve& curve, const glm::dvec2& load,
                          const glm::dvec2& weights, std::size_t& segment) {
  // On a convex curve the distance falls and then rises: downhill to the segment where it turns.
  std::size_t low = std::min(segment, std::size_t{kLimitCurveSegments - 1});
  while (low + 1 < kLimitCurveSegments &&
         approach(load, weights, curve.points[low + 1], curve.points[low + 2]) > 0.0) {
    ++low;
  }
  while (low > 0 && approach(load, weights, curve.points[low], curve.points[low + 1]) <= 0.0) {
    --low;
  }
  segment = low;
  const glm::dvec2& from = curve.points[low];
  const glm::dvec2 along = curve.points[low + 1] - from;
  // The way from pure sliding to pure spinning has the inside on its left.
  const glm::dvec2 offset = load - from;
  if (along.x * offset.y - along.y * offset.x >= 0.0) {
    return load;
  }
  const double share = glm::dot(weights * offset, along) / glm::dot(weights * along, along);
  return from + std::clamp(share, 0.0, 1.0) * along;
}

}  // namespace torsion
