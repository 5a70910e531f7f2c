#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace torsion::engine::reference {

/// The turning points of a path that still matter to a stack of parallel elastic-frictional
/// springs: a reversal that a later, larger swing has passed is forgotten (Madelung's rules). One
/// displacement and one response per entry. Cattaneo-Mindlin and Lubkin contacts at constant normal
/// force are such stacks, so that their response to any sequence of turns follows from the first
/// loading curve alone. Source: Masing 1926; Iwan, J. Appl. Mech. 33 (1966) 893; Jaeger, Appl.
/// Mech. Rev. 47 (1994) 35.
struct MasingHistory {
  std::vector<std::pair<double, double>> turning_points;  // (displacement, response), oldest first
  double displacement = 0.0;
  double response = 0.0;
};

/// Moves to `target` without a turn on the way.
/// @param loading the first loading curve, response(displacement), odd, concave for positive
/// displacement
/// @return the response at `target`
/// Error: that of `loading`, times 2 per remembered turning point at most.
template <class Loading>
double move_to(MasingHistory& history, const Loading& loading, double target) {
  auto& points = history.turning_points;
  const double direction = target - history.displacement;
  if (direction == 0.0) {
    return history.response;
  }
  // Where the path turns, the present place becomes a turning point. It is a turn if the last
  // branch came the other way.
  const double from = points.empty() ? 0.0 : points.back().first;
  if ((history.displacement - from) * direction < 0.0) {
    points.emplace_back(history.displacement, history.response);
  }
  // A branch that reaches the turning point before its own start closes a loop: both are forgotten.
  // On the first loading curve the mirror image of the only turning point plays this part.
  while (!points.empty()) {
    const double start = points.back().first;
    const double closing = points.size() >= 2 ? points[points.size() - 2].first : -start;
    if ((target - closing) * direction < 0.0) {
      break;
    }
    points.resize(points.size() >= 2 ? points.size() - 2 : 0U);
  }
  history.displacement = target;
  history.response =
      points.empty() ? loading(target)
                     : points.back().second + 2.0 * loading(0.5 * (target - points.back().first));
  return history.response;
}

}  // namespace torsion::engine::reference
