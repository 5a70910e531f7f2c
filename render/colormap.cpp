#include "render/colormap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "render/srgb.hpp"

namespace torsion::engine {
namespace {

/// A colour as Oklab lightness, chroma and hue (Ottosson 2020, "A perceptual color space for image
/// processing"): equal steps of it look equally large.
struct Stop {
  double lightness;
  double chroma;
  double hue;  // degrees
};

constexpr std::array<Stop, 3> kTwistStops = {
    {{0.42, 0.14, 258.0}, {0.94, 0.0, 0.0}, {0.46, 0.17, 29.0}}};
constexpr std::array<Stop, 5> kPressureStops = {{{0.94, 0.0, 0.0},
                                                 {0.83, 0.13, 92.0},
                                                 {0.66, 0.18, 48.0},
                                                 {0.48, 0.19, 12.0},
                                                 {0.30, 0.13, 318.0}}};
constexpr std::array<Stop, 2> kPaleStops = {{{0.94, 0.0, 0.0}, {0.94, 0.0, 0.0}}};

glm::dvec3 lab_of(const Stop& stop) {
  const double hue = stop.hue * std::numbers::pi / 180.0;
  return {stop.lightness, stop.chroma * std::cos(hue), stop.chroma * std::sin(hue)};
}

glm::dvec3 linear_of(const glm::dvec3& lab) {
  const auto cube = [](double v) {
    return v * v * v;
  };
  const double l = cube(lab.x + 0.3963377774 * lab.y + 0.2158037573 * lab.z);
  const double m = cube(lab.x - 0.1055613458 * lab.y - 0.0638541728 * lab.z);
  const double s = cube(lab.x - 0.0894841775 * lab.y - 1.2914855480 * lab.z);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

std::span<const Stop> stops_of(HeatMap map) {
  switch (map) {
    case HeatMap::kTwist:
      return kTwistStops;
    case HeatMap::kPressure:
      return kPressureStops;
    case HeatMap::kNone:
      break;
  }
  return kPaleStops;
}

}  // namespace

glm::dvec3 heat_color(HeatMap map, double at) {
  const std::span<const Stop> stops = stops_of(map);
  const double place = std::clamp(at, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double share = place - static_cast<double>(low);
  const glm::dvec3 linear =
      linear_of((1.0 - share) * lab_of(stops[low]) + share * lab_of(stops[low + 1]));
  return {srgb_encoded(linear.x), srgb_encoded(linear.y), srgb_encoded(linear.z)};
}

}  // namespace torsion::engine
