#include "systems/mdr/layers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

using std::numbers::pi;

/// Integrals of 1, x and x^2 from 0 to a place, for the measure dx or x^2 dx.
struct Moments {
  double zeroth = 0.0;
  double first = 0.0;
  double second = 0.0;

  Moments operator-(const Moments& other) const {
    return {zeroth - other.zeroth, first - other.first, second - other.second};
  }
};

template <bool Turn>
Moments moments_to(double x) {
  const double square = x * x;
  if constexpr (Turn) {
    const double cube = square * x;
    return {cube / 3.0, square * square / 4.0, cube * square / 5.0};
  } else {
    return {x, square / 2.0, square * x / 3.0};
  }
}

/// value + slope x
template <class Value>
struct Line {
  Value value{};
  Value slope{};
};

/// The deflection on one piece, from its two springs.
template <class Value>
Line<Value> line_of(double outer_place, double inner_place, const Value& outer,
                    const Value& inner) {
  const Value slope = (outer - inner) / (outer_place - inner_place);
  return {inner - slope * inner_place, slope};
}

/// Projects one foundation's deflections from the pieces of the last step onto those of this step.
/// Both lists of edges fall; between two successive edges of either list both are linear.
/// @param before, now      foundations
/// @param scale_before     a of the last step over that of this one: places are over the new a
/// @param deflections      (kMdrLayers) in: of the last step; out: of this step
template <bool Turn, class Value>
void project(const MdrFoundation& before, const MdrFoundation& now, double scale_before,
             std::array<Value, kMdrLayers>& deflections) {
  std::array<Value, kMdrLayers> found{};
  std::size_t old_piece = 0;
  for (std::size_t piece = 0; piece < kMdrPieces; ++piece) {
    const double outer = now.place[2 * piece];
    const double inner = now.place[2 * piece + 1];
    const double per_length = 1.0 / (outer - inner);
    const double end = now.edges[piece + 1];
    double from = std::min(now.edges[piece], scale_before);  // beyond it nothing was held
    Moments to_from = moments_to<Turn>(from);
    Value of_outer{};
    Value of_inner{};
    while (from > end) {
      while (old_piece + 1 < kMdrPieces && scale_before * before.edges[old_piece + 1] >= from) {
        ++old_piece;
      }
      const double old_end =
          old_piece + 1 < kMdrPieces ? scale_before * before.edges[old_piece + 1] : 0.0;
      const double to = std::max(end, old_end);
      const Moments to_to = moments_to<Turn>(to);
      const Moments m = to_from - to_to;
      const Line<Value> line = line_of(scale_before * before.place[2 * old_piece],
                                       scale_before * before.place[2 * old_piece + 1],
                                       deflections[2 * old_piece], deflections[2 * old_piece + 1]);
      const Value zeroth = line.value * m.zeroth + line.slope * m.first;
      const Value first = line.value * m.first + line.slope * m.second;
      of_outer += (first - zeroth * inner) * per_length;
      of_inner += (zeroth * outer - first) * per_length;
      from = to;
      to_from = to_to;
    }
    // A spring's weight: its share of the integral of the measure over all x.
    const double whole = Turn ? 1.0 / 3.0 : 1.0;
    found[2 * piece] = of_outer / (whole * now.stiffness[2 * piece]);
    found[2 * piece + 1] = of_inner / (whole * now.stiffness[2 * piece + 1]);
  }
  deflections = found;
}

constexpr double kLoadRounding =
    1e-9;  // of a layer's largest load: by so much none slips that is held

/// Where slip ends, over the contact's radius: at the edge between the pieces that slip and those
/// that stick (two layers a piece). Sliding and turning have an edge each; where both go on, they
/// are weighted by their loads.
double stick_radius(const MdrPlaces& places, std::size_t slipping, const glm::dvec2& loads) {
  const std::size_t piece = slipping / 2;
  const auto edge = [&](const std::array<double, kMdrPieces + 1>& edges) {
    const double outer = piece < kMdrPieces ? edges[piece] : 0.0;
    const double inner = piece + 1 < kMdrPieces ? edges[piece + 1] : 0.0;
    return slipping % 2 == 0 ? outer : 0.5 * (outer + inner);
  };
  const double square = glm::dot(loads, loads);
  const double turning = square > 0.0 ? loads.y * loads.y / square : 0.0;
  return std::lerp(edge(places.shift.edges), edge(places.turn.edges), turning);
}

}  // namespace

void resize_layers(const MdrSize& before, const MdrSize& now, std::span<MdrLayer> layers) {
  if (before.radius <= 0.0 || now.radius <= 0.0) {
    return;
  }
  const double scale_before = before.radius / now.radius;
  std::array<glm::dvec2, kMdrLayers> shifts{};
  std::array<double, kMdrLayers> turns{};
  for (std::size_t k = 0; k < kMdrLayers; ++k) {
    shifts[k] = layers[k].shift;
    turns[k] = layers[k].turn;
  }
  project<false>(before.places.shift, now.places.shift, scale_before, shifts);
  project<true>(before.places.turn, now.places.turn, scale_before, turns);
  for (std::size_t k = 0; k < kMdrLayers; ++k) {
    layers[k] = {shifts[k], turns[k]};
  }
}

MdrForces move_layers(const MdrPlaces& places, const LimitCurve& curve, const MdrContact& contact,
                      std::span<MdrLayer> layers) {
  MdrForces forces;
  const double friction = contact.friction * contact.force;
  if (friction <= 0.0) {
    std::ranges::fill(layers, MdrLayer{});
    return forces;
  }
  const double a = contact.radius;
  const double slide_stiffness =
      contact.slide_stiffness * 8.0 * contact.shear_modulus * a / (2.0 - contact.poisson_ratio);
  const double turn_stiffness =
      contact.turn_stiffness * 16.0 / 3.0 * contact.shear_modulus * a * a * a;
  // Largest couple (3 pi / 16) or (pi / 4) mu F a: docs/models.md.
  const double largest_couple =
      pi * std::lerp(3.0 / 16.0, 0.25, contact.flat_share) * a * contact.torque_share * friction;
  // Loads over the largest ones. A layer slips where its largest load over its stiffness is
  // reached, so all layers together have the exact stiffness before slip and the exact load in full
  // slip.
  const double shift_unit = slide_stiffness / friction;  // 1/m
  const double turn_unit = turn_stiffness / largest_couple;
  std::size_t segment = kLimitCurveSegments / 2;
  std::size_t slipping = 0;  // layers, from the rim inwards
  glm::dvec2 loads(0.0);     // sums over the layers, over the largest ones
  for (std::size_t k = 0; k < kMdrLayers; ++k) {
    const double share = places.share[k];
    MdrLayer& layer = layers[k];
    layer.shift += contact.slide;
    layer.turn += contact.spin;
    const double per_shift = shift_unit * places.shift_haste[k];
    const double per_turn = turn_unit * places.turn_haste[k];
    const glm::dvec2 load(per_shift * glm::length(layer.shift), per_turn * std::abs(layer.turn));
    loads += share * load;
    if (glm::dot(load, load) > kSurelyInside) {
      const glm::dvec2 kept =
          nearest_inside(curve, load, {friction * per_turn, largest_couple * per_shift}, segment);
      if (kept != load) {
        const MdrLayer from = layer;
        layer.shift *= load.x > 0.0 ? kept.x / load.x : 0.0;
        layer.turn *= load.y > 0.0 ? kept.y / load.y : 0.0;
        forces.slipped +=
            share * (glm::distance(from.shift, layer.shift) + a * std::abs(from.turn - layer.turn));
        slipping = glm::distance(kept, load) > kLoadRounding ? k + 1 : slipping;
      }
    }
    forces.force -= slide_stiffness * places.shift.stiffness[k] * layer.shift;
    forces.couple -= turn_stiffness * places.turn.stiffness[k] * layer.turn;
  }
  forces.stick_radius = stick_radius(places, slipping, loads);
  return forces;
}

}  // namespace torsion::engine
