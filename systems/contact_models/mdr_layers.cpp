#include "systems/contact_models/mdr_layers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

namespace torsion {
namespace {

constexpr double kPi = std::numbers::pi;

/// Limits of the springs at x = place * a: of the tangential one over mu F / (Gt a), of the
/// torsional one over mu F / (G a^2).
struct SpringLimits {
  double shift = 0.0;
  double turn = 0.0;
};

/// Tangential: mu times the normal line load, 3 F / (4 a) (1 - x^2 / a^2) or F / (2 a). Torsional:
/// (mu / 2 G) times the Abel transform of the pressure, which gives K - E or K of m = 1 - x^2 /
/// a^2.
SpringLimits limits_at(double place, double flat_share) {
  const double modulus = std::sqrt(std::max(0.0, 1.0 - place * place));
  const double k = std::comp_ellint_1(modulus);
  const double e = std::comp_ellint_2(modulus);
  const double round = 1.0 - flat_share;
  return {round * 0.75 * (1.0 - place * place) + flat_share * 0.5,
          round * 3.0 / (4.0 * kPi) * (k - e) + flat_share * k / (4.0 * kPi)};
}

/// Share of all friction that has slipped once `layers` layers have: finer where the first and the
/// last springs slip, where the exact curve bends most.
double slipped_share(std::size_t layers) {
  const double t = static_cast<double>(layers) / static_cast<double>(kMdrLayers);
  return t * t * (3.0 - 2.0 * t);
}

double cube(double x) {
  return x * x * x;
}

/// For one pressure: the places at which given shares of all friction lie outside.
MdrThresholds make_thresholds(double flat_share) {
  constexpr std::size_t kFine = 20000;
  // Shares of the friction beyond place (i / kFine), from the rim inwards.
  std::vector<double> shift_beyond(kFine + 1, 0.0);
  std::vector<double> turn_beyond(kFine + 1, 0.0);
  for (std::size_t i = kFine; i-- > 0;) {
    const double place = (static_cast<double>(i) + 0.5) / kFine;
    const SpringLimits limits = limits_at(place, flat_share);
    shift_beyond[i] = shift_beyond[i + 1] + limits.shift;
    turn_beyond[i] = turn_beyond[i + 1] + place * place * limits.turn;
  }
  const auto place_of = [&](const std::vector<double>& beyond, double share) {
    if (share <= 0.0 || share >= 1.0) {
      return share <= 0.0 ? 1.0 : 0.0;
    }
    const double wanted = share * beyond.front();
    const auto at = std::partition_point(beyond.begin(), beyond.end(),
                                         [wanted](double value) { return value > wanted; });
    const auto high = static_cast<std::size_t>(at - beyond.begin());
    const double above = beyond[high - 1];
    const double part = (above - wanted) / (above - beyond[high]);
    return (static_cast<double>(high - 1) + part) / static_cast<double>(kFine);
  };
  MdrThresholds thresholds;
  for (std::size_t layer = 0; layer < kMdrLayers; ++layer) {
    const double from = slipped_share(layer);
    const double to = slipped_share(layer + 1);
    const double middle = 0.5 * (from + to);
    MdrThreshold& threshold = thresholds[layer];
    threshold.shift_place = place_of(shift_beyond, middle);
    threshold.turn_place = place_of(turn_beyond, middle);
    // The layer's largest load over the stiffness of its springs, so that all layers together have
    // the exact stiffness before they slip and the exact load after.
    const double cells = (to - from) / static_cast<double>(kFine);
    threshold.shift_limit =
        cells * shift_beyond.front() / (place_of(shift_beyond, from) - place_of(shift_beyond, to));
    threshold.turn_limit = 3.0 * cells * turn_beyond.front() /
                           (cube(place_of(turn_beyond, from)) - cube(place_of(turn_beyond, to)));
  }
  return thresholds;
}

double mix(double a, double b, double share) {
  return a + share * (b - a);
}

/// Catmull-Rom's interpolation between `b` and `c`, kept between them.
double cubic(double a, double b, double c, double d, double x) {
  const double value =
      b + 0.5 * x * (c - a + x * (2.0 * a - 5.0 * b + 4.0 * c - d + x * (3.0 * (b - c) + d - a)));
  return std::clamp(value, std::min(b, c), std::max(b, c));
}

/// Places fall from the rim inwards with the layer's number.
template <class Place>
struct Lookup {
  const MdrThresholds& thresholds;
  Place place;
  std::size_t next = 0;

  /// Layer and part of the way to the following one where `wanted` lies; wanted falls from call to
  /// call.
  std::pair<std::size_t, double> at(double wanted) {
    while (next + 1 < kMdrLayers && place(thresholds[next + 1]) > wanted) {
      ++next;
    }
    if (next + 1 == kMdrLayers || wanted >= place(thresholds[next])) {
      return {next, 0.0};
    }
    const double from = place(thresholds[next]);
    return {next, (from - wanted) / (from - place(thresholds[next + 1]))};
  }
};

/// One component of all layers, resampled.
template <class Place, class Value>
void resize(const MdrThresholds& thresholds, double ratio, std::span<MdrLayer> layers, Place place,
            Value value) {
  std::array<double, kMdrLayers> old{};
  for (std::size_t k = 0; k < kMdrLayers; ++k) {
    old[k] = value(layers[k]);
  }
  Lookup<Place> lookup{thresholds, place};
  const double rim = place(thresholds[0]);
  for (std::size_t k = 0; k < kMdrLayers; ++k) {
    const double wanted = place(thresholds[k]) * ratio;
    if (wanted >= rim) {
      // Between the rim, where nothing is held, and the outermost spring.
      const double share = rim < 1.0 ? std::clamp((1.0 - wanted) / (1.0 - rim), 0.0, 1.0) : 0.0;
      value(layers[k]) = share * old[0];
      continue;
    }
    const auto [layer, part] = lookup.at(wanted);
    const std::size_t after = std::min<std::size_t>(layer + 1, kMdrLayers - 1);
    const std::size_t last = std::min<std::size_t>(layer + 2, kMdrLayers - 1);
    value(layers[k]) =
        cubic(layer > 0 ? old[layer - 1] : 0.0, old[layer], old[after], old[last], part);
  }
}

}  // namespace

MdrTables make_mdr_tables() {
  MdrTables tables;
  for (std::size_t shape = 0; shape < MdrTables::kShapes; ++shape) {
    tables.thresholds[shape] =
        make_thresholds(static_cast<double>(shape) / (MdrTables::kShapes - 1));
  }
  tables.limit_curve = make_limit_curve();
  return tables;
}

MdrThresholds thresholds_of(const MdrTables& tables, double flat_share) {
  const double place = std::clamp(flat_share, 0.0, 1.0) * (MdrTables::kShapes - 1);
  const auto shape = std::min(static_cast<std::size_t>(place), MdrTables::kShapes - 2);
  const double part = place - static_cast<double>(shape);
  if (part == 0.0) {
    return tables.thresholds[shape];
  }
  MdrThresholds result;
  for (std::size_t k = 0; k < kMdrLayers; ++k) {
    const MdrThreshold& a = tables.thresholds[shape][k];
    const MdrThreshold& b = tables.thresholds[shape + 1][k];
    result[k] = {mix(a.shift_place, b.shift_place, part), mix(a.shift_limit, b.shift_limit, part),
                 mix(a.turn_place, b.turn_place, part), mix(a.turn_limit, b.turn_limit, part)};
  }
  return result;
}

void resize_layers(const MdrThresholds& thresholds, double before, double radius,
                   std::span<MdrLayer> layers) {
  if (before <= 0.0 || before == radius) {
    return;
  }
  const double ratio = radius / before;
  const auto shift_place = [](const MdrThreshold& t) {
    return t.shift_place;
  };
  resize(thresholds, ratio, layers, shift_place,
         [](MdrLayer& layer) -> double& { return layer.shift.x; });
  resize(thresholds, ratio, layers, shift_place,
         [](MdrLayer& layer) -> double& { return layer.shift.y; });
  resize(
      thresholds, ratio, layers, [](const MdrThreshold& t) { return t.turn_place; },
      [](MdrLayer& layer) -> double& { return layer.turn; });
}

MdrForces move_layers(const MdrTables& tables, const MdrContact& contact,
                      std::span<MdrLayer> layers) {
  MdrForces forces;
  const double friction = contact.friction * contact.force;
  if (friction <= 0.0) {
    std::ranges::fill(layers, MdrLayer{});
    return forces;
  }
  const MdrThresholds thresholds = thresholds_of(tables, contact.flat_share);
  const double tangential_modulus = 4.0 * contact.shear_modulus / (2.0 - contact.poisson_ratio);
  const double shift_unit = friction / (tangential_modulus * contact.radius);
  const double turn_unit =
      contact.torque_share * friction / (contact.shear_modulus * contact.radius * contact.radius);
  // Largest couple (3 pi / 16) or (pi / 4) mu F a: docs/models.md.
  const double couple_arm =
      kPi * mix(3.0 / 16.0, 0.25, contact.flat_share) * contact.radius * contact.torque_share;
  for (std::size_t k = 0; k < kMdrLayers; ++k) {
    const double share = slipped_share(k + 1) - slipped_share(k);
    MdrLayer& layer = layers[k];
    const double shift_limit = thresholds[k].shift_limit * shift_unit;
    const double turn_limit = thresholds[k].turn_limit * turn_unit;
    layer.shift += contact.slide;
    layer.turn += contact.spin;
    const double shift = glm::length(layer.shift);
    const glm::dvec2 load(shift / shift_limit, std::abs(layer.turn) / turn_limit);
    const glm::dvec2 kept =
        nearest_inside(tables.limit_curve, load, {shift_limit, couple_arm * turn_limit});
    if (kept != load) {
      const glm::dvec2 from = layer.shift;
      layer.shift *= shift > 0.0 ? kept.x * shift_limit / shift : 0.0;
      const double turn = std::copysign(kept.y * turn_limit, layer.turn);
      forces.slipped +=
          share * (glm::distance(from, layer.shift) + contact.radius * std::abs(turn - layer.turn));
      layer.turn = turn;
    } else {
      forces.stick_share += share;
    }
    forces.force -= layer.shift * (share * friction / shift_limit);
    forces.couple -= layer.turn * (share * friction * couple_arm / turn_limit);
  }
  return forces;
}

}  // namespace torsion
