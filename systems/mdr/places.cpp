#include "systems/mdr/places.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
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
    // Equal steps of the slip's direction, scaled so that the points are about evenly spaced.
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
  // On a convex curve the distance first falls and then rises: search downhill for the segment
  // where it turns.
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
  // Going from pure sliding to pure spinning, the inside of the curve is on the left.
  const glm::dvec2 offset = load - from;
  if (along.x * offset.y - along.y * offset.x >= 0.0) {
    return load;
  }
  const double share = glm::dot(weights * offset, along) / glm::dot(weights * along, along);
  return from + std::clamp(share, 0.0, 1.0) * along;
}

namespace {

using std::numbers::pi;

/// Loads of the springs at x = place * a in full slip, per length: the tangential one over mu F,
/// the torsional one over (4 / pi) mu F a.
struct SpringLoads {
  double shift = 0.0;
  double turn = 0.0;
};

/// Complete elliptic integrals of m = 1 - x^2 / a^2.
struct RingIntegrals {
  double first = 0.0;
  double second = 0.0;
};

RingIntegrals ring_integrals_at(double place) {
  const double modulus = std::sqrt(std::max(0.0, 1.0 - place * place));
  return {std::comp_ellint_1(modulus), std::comp_ellint_2(modulus)};
}

/// For one pressure. Tangential: mu times the normal line load, 3 F / (2 a) (1 - x^2 / a^2) or F /
/// a over the half line. Torsional: 16 G x^2 times (mu / 2 G) times the Abel transform of the
/// pressure, which gives K - E or K. The middle of a long contact sticks for longer than that of a
/// round one of equal torque: modelled by a power of K - E, fitted to a boundary element solution
/// (docs/models.md).
struct Loads {
  double flat_share = 0.0;
  double power = 1.0;
  double scale = 1.0;  // takes back what the power changes in the load of all

  [[nodiscard]] SpringLoads at(double place, const RingIntegrals& integrals) const {
    const double bend = integrals.first - integrals.second;
    const double round = 3.0 * scale * (power == 1.0 ? bend : std::pow(bend, power));
    return {std::lerp(1.5 * (1.0 - place * place), 1.0, flat_share),
            place * place * std::lerp(round, integrals.first, flat_share)};
  }
  [[nodiscard]] SpringLoads at(double place) const { return at(place, ring_integrals_at(place)); }
};

constexpr std::size_t kFine = 20000;

double fine_place(std::size_t i) {
  return (static_cast<double>(i) + 0.5) / static_cast<double>(kFine);
}

/// @param fine  (kFine) at fine_place
Loads make_loads(double flat_share, double power, const std::vector<RingIntegrals>& fine) {
  const Loads round{0.0, power, 1.0};
  double sum = 0.0;
  for (std::size_t i = 0; i < kFine; ++i) {
    sum += round.at(fine_place(i), fine[i]).turn / static_cast<double>(kFine);
  }
  return {flat_share, power, 3.0 * pi * pi / 64.0 / sum};  // the integral at power 1
}

/// Share of the whole friction that has slipped when so many pieces have: finer where the first and
/// the last springs slip, where the exact curve bends most.
double slipped_share(std::size_t pieces) {
  return smooth_step(static_cast<double>(pieces) / static_cast<double>(kMdrPieces));
}

/// Two places on a piece, t = -1 to 1, whose linear functions (1 at the one, 0 at the other) are
/// orthogonal with the weight (middle + half t)^2: so a linear deflection stores the same energy as
/// the two springs. The outer place is free.
struct TwoSprings {
  double inner = 0.0;         // t
  double outer_weight = 0.0;  // of the integral of the weight
};

TwoSprings springs_with(double outer, double middle, double half) {
  const double square = middle * middle;
  const double m0 = 2.0 * (square + half * half / 3.0);
  const double mean = 4.0 / 3.0 * middle * half / m0;
  const double variance = 2.0 * (square / 3.0 + half * half / 5.0) / m0 - mean * mean;
  const double arm = outer - mean;
  return {mean - variance / arm, variance / (variance + arm * arm)};
}

double cube(double x) {
  return x * x * x;
}

/// Places and stiffnesses of the springs, from the pieces' edges and, in torsion, from the place of
/// the outer spring of each piece.
void place_springs(MdrPlaces& places) {
  for (std::size_t k = 0; k < kMdrPieces; ++k) {
    const std::size_t outer = 2 * k;
    const double middle = 0.5 * (places.shift.edges[k] + places.shift.edges[k + 1]);
    const double half = 0.5 * (places.shift.edges[k] - places.shift.edges[k + 1]);
    places.shift.place[outer] = middle + half / std::numbers::sqrt3;
    places.shift.place[outer + 1] = middle - half / std::numbers::sqrt3;
    places.shift.stiffness[outer] = half;
    places.shift.stiffness[outer + 1] = half;
    const double turn_middle = 0.5 * (places.turn.edges[k] + places.turn.edges[k + 1]);
    const double turn_half = 0.5 * (places.turn.edges[k] - places.turn.edges[k + 1]);
    const TwoSprings springs = springs_with(places.turn_outer[k], turn_middle, turn_half);
    const double stiffness = cube(places.turn.edges[k]) - cube(places.turn.edges[k + 1]);
    places.turn.place[outer] = turn_middle + turn_half * places.turn_outer[k];
    places.turn.place[outer + 1] = turn_middle + turn_half * springs.inner;
    places.turn.stiffness[outer] = stiffness * springs.outer_weight;
    places.turn.stiffness[outer + 1] = stiffness * (1.0 - springs.outer_weight);
  }
}

void set_haste(MdrPlaces& places) {
  for (std::size_t k = 0; k < kMdrLayers; ++k) {
    places.shift_haste[k] = places.shift.stiffness[k] / places.share[k];
    places.turn_haste[k] = places.turn.stiffness[k] / places.share[k];
  }
}

/// The edges, from the rim, outside of which given shares of the whole load lie.
/// @param beyond  (n + 1) load beyond i / n
std::array<double, kMdrPieces + 1> edges_of(const std::vector<double>& beyond) {
  std::array<double, kMdrPieces + 1> edges{};
  edges.front() = 1.0;
  for (std::size_t k = 1; k < kMdrPieces; ++k) {
    const double wanted = slipped_share(k) * beyond.front();
    const auto at = std::partition_point(beyond.begin(), beyond.end(),
                                         [wanted](double value) { return value > wanted; });
    const auto high = static_cast<std::size_t>(at - beyond.begin());
    const double above = beyond[high - 1];
    const double part = (above - wanted) / (above - beyond[high]);
    edges[k] = (static_cast<double>(high - 1) + part) / static_cast<double>(beyond.size() - 1);
  }
  return edges;
}

/// The share of a piece's torsional load that its outer spring carries when it is at t = `outer`.
double outer_turn_load(const Loads& loads, double outer, double middle, double half) {
  const TwoSprings springs = springs_with(outer, middle, half);
  const auto limit = [&](double t) {
    const double x = middle + half * t;
    return loads.at(x).turn / (x * x);
  };
  const double load = springs.outer_weight * limit(outer);
  return load / (load + (1.0 - springs.outer_weight) * limit(springs.inner));
}

/// Places the torsional springs of piece k so that they divide its load as the tangential ones do.
/// The farther out the outer spring, the less it carries: by bisection.
void divide_piece(const Loads& loads, std::size_t k, MdrPlaces& places) {
  const double shift_outer = loads.at(places.shift.place[2 * k]).shift;
  const double shift_inner = loads.at(places.shift.place[2 * k + 1]).shift;
  const double wanted = shift_outer / (shift_outer + shift_inner);
  const double middle = 0.5 * (places.turn.edges[k] + places.turn.edges[k + 1]);
  const double half = 0.5 * (places.turn.edges[k] - places.turn.edges[k + 1]);
  // Both springs stay within the piece, the inner one off the centre, where the friction limit has
  // no load.
  double low = -1.0;
  double high = 1.0 - 1e-9;
  for (int halving = 0; halving < 50; ++halving) {
    const double t = 0.5 * (low + high);
    const bool inside = springs_with(t, middle, half).inner > -1.0 + 1e-6 &&
                        springs_with(t, middle, half).inner < t;
    (!inside || outer_turn_load(loads, t, middle, half) > wanted ? low : high) = t;
  }
  places.turn_outer[k] = high;
  const double share = slipped_share(k + 1) - slipped_share(k);
  places.share[2 * k] = wanted * share;
  places.share[2 * k + 1] = (1.0 - wanted) * share;
}

MdrPlaces make_places(const Loads& loads, const std::vector<RingIntegrals>& fine) {
  // Loads beyond place i / kFine, from the rim inwards.
  std::vector<double> shift_beyond(kFine + 1, 0.0);
  std::vector<double> turn_beyond(kFine + 1, 0.0);
  for (std::size_t i = kFine; i-- > 0;) {
    const SpringLoads load = loads.at(fine_place(i), fine[i]);
    shift_beyond[i] = shift_beyond[i + 1] + load.shift;
    turn_beyond[i] = turn_beyond[i + 1] + load.turn;
  }
  MdrPlaces places;
  places.shift.edges = edges_of(shift_beyond);
  places.turn.edges = edges_of(turn_beyond);
  place_springs(places);
  for (std::size_t k = 0; k < kMdrPieces; ++k) {
    divide_piece(loads, k, places);
  }
  place_springs(places);
  set_haste(places);
  return places;
}

constexpr double kLongestPower = 0.24;  // power - 1 at b / a = 0

template <std::size_t N>
void add(const std::array<double, N>& values, double share, std::array<double, N>& sum) {
  for (std::size_t k = 0; k < N; ++k) {
    sum[k] += share * values[k];
  }
}

}  // namespace

MdrTables make_mdr_tables() {
  std::vector<RingIntegrals> fine(kFine);
  for (std::size_t i = 0; i < kFine; ++i) {
    fine[i] = ring_integrals_at(fine_place(i));
  }
  MdrTables tables;
  for (std::size_t shape = 0; shape < MdrTables::kShapes; ++shape) {
    const double flat_share = static_cast<double>(shape) / (MdrTables::kShapes - 1);
    tables.places[0][shape] = make_places(make_loads(flat_share, 1.0, fine), fine);
    tables.places[1][shape] = make_places(make_loads(flat_share, 1.0 + kLongestPower, fine), fine);
  }
  tables.limit_curve = make_limit_curve();
  return tables;
}

MdrPlaces places_of(const MdrTables& tables, const MdrPressure& pressure) {
  const double at = std::clamp(pressure.flat_share, 0.0, 1.0) * (MdrTables::kShapes - 1);
  const auto shape = std::min(static_cast<std::size_t>(at), MdrTables::kShapes - 2);
  const double part = at - static_cast<double>(shape);
  // The power grows with the square of the elongation.
  const double longer = pressure.elongation * pressure.elongation;
  if (part == 0.0 && longer == 0.0) {
    return tables.places[0][shape];
  }
  MdrPlaces mixed;
  for (std::size_t elongation = 0; elongation < MdrTables::kElongations; ++elongation) {
    for (std::size_t next = 0; next < 2; ++next) {
      const double share =
          (elongation == 0 ? 1.0 - longer : longer) * (next == 0 ? 1.0 - part : part);
      if (share == 0.0) {
        continue;
      }
      const MdrPlaces& places = tables.places[elongation][shape + next];
      add(places.shift.edges, share, mixed.shift.edges);
      add(places.turn.edges, share, mixed.turn.edges);
      add(places.turn_outer, share, mixed.turn_outer);
      add(places.share, share, mixed.share);
    }
  }
  mixed.shift.edges.front() = 1.0;  // not a rounding less
  mixed.turn.edges.front() = 1.0;
  place_springs(mixed);
  set_haste(mixed);
  return mixed;
}

}  // namespace torsion::engine
