#include "render/studio_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include "shaders/shared.h"

namespace torsion::engine {
namespace {

using glm::dvec3;
constexpr double kPi = std::numbers::pi;

double smooth(double low, double high, double value) {
  return glm::smoothstep(low, high, value);
}

/// A rectangle of light far away, with soft edges.
class SoftBox {
 public:
  /// @param half_width, half_height  as tangents
  SoftBox(const dvec3& toward, double half_width, double half_height, const dvec3& radiance)
      : middle_(glm::normalize(toward)),
        right_(glm::normalize(glm::cross(dvec3(0.0, 1.0, 0.0), middle_))),
        up_(glm::cross(middle_, right_)),
        half_width_(half_width),
        half_height_(half_height),
        radiance_(radiance) {}

  [[nodiscard]] dvec3 seen(const dvec3& direction) const {
    constexpr double kEdge = 0.12;
    const double ahead = glm::dot(direction, middle_);
    if (ahead <= 0.05) {
      return dvec3(0.0);
    }
    const double x = std::abs(glm::dot(direction, right_)) / ahead;
    const double y = std::abs(glm::dot(direction, up_)) / ahead;
    return radiance_ * (1.0 - smooth(half_width_ - kEdge, half_width_ + kEdge, x)) *
           (1.0 - smooth(half_height_ - kEdge, half_height_ + kEdge, y));
  }

 private:
  dvec3 middle_;
  dvec3 right_;
  dvec3 up_;
  double half_width_;
  double half_height_;
  dvec3 radiance_;
};

/// Two axes beside a direction.
void beside(const dvec3& direction, dvec3& x, dvec3& z) {
  const dvec3 other = std::abs(direction.y) < 0.9 ? dvec3(0.0, 1.0, 0.0) : dvec3(1.0, 0.0, 0.0);
  x = glm::normalize(glm::cross(other, direction));
  z = glm::cross(x, direction);
}

/// The i-th of n points of Hammersley's set, bits of i mirrored.
double mirrored_bits(std::uint32_t i) {
  std::uint32_t bits = 0;
  for (int bit = 0; bit < 32; ++bit) {
    bits = bits << 1U | (i >> static_cast<std::uint32_t>(bit) & 1U);
  }
  return static_cast<double>(bits) / 4294967296.0;
}

/// The direction of a texel of a tile, as shaders/reflection.glsl's on_octahedron() has it.
dvec3 texel_direction(std::uint32_t column, std::uint32_t row) {
  const double side = shared::kReflectionSide;
  const double u = (column + 0.5) / side * 2.0 - 1.0;
  const double v = (row + 0.5) / side * 2.0 - 1.0;
  dvec3 d(u, 1.0 - std::abs(u) - std::abs(v), v);
  if (d.y < 0.0) {
    d.x = (1.0 - std::abs(v)) * (u < 0.0 ? -1.0 : 1.0);
    d.z = (1.0 - std::abs(u)) * (v < 0.0 ? -1.0 : 1.0);
  }
  return glm::normalize(d);
}

}  // namespace

dvec3 studio_radiance(const dvec3& direction) {
  static const std::array<SoftBox, 3> kBoxes = {{
      {kToKeyLight, 0.38, 0.28, dvec3(2.05, 2.0, 1.9)},
      {dvec3(0.70, 0.45, -0.75), 0.36, 0.28, dvec3(0.95, 1.0, 1.08)},
      {dvec3(0.95, 0.12, 0.35), 0.12, 0.80, dvec3(0.75, 0.77, 0.80)},
  }};
  constexpr dvec3 kFloor(0.205, 0.20, 0.195);
  constexpr dvec3 kWall(0.21, 0.22, 0.235);
  constexpr dvec3 kCeiling(0.26, 0.275, 0.295);
  const double y = direction.y;
  dvec3 radiance = glm::mix(kFloor, kWall, smooth(-0.25, 0.05, y));
  radiance = glm::mix(radiance, kCeiling, smooth(0.05, 0.9, y));
  for (const SoftBox& box : kBoxes) {
    radiance += box.seen(direction);
  }
  return radiance;
}

std::array<dvec3, 9> studio_irradiance() {
  // Real spherical harmonics times the cosine lobe's factors 1, 2/3 and 1/4 (over pi), with the
  // constants of both the projection and the sum.
  constexpr double kBand0 = 0.282095 * 0.282095;
  constexpr double kBand1 = 0.488603 * 0.488603 * 2.0 / 3.0;
  constexpr double kBand2 = 1.092548 * 1.092548 / 4.0;
  constexpr double kBand20 = 0.315392 * 0.315392 / 4.0;
  constexpr double kBand22 = 0.546274 * 0.546274 / 4.0;
  constexpr int kRows = 64;
  std::array<dvec3, 9> sums{};
  for (int row = 0; row < kRows; ++row) {
    const double y = 1.0 - 2.0 * (row + 0.5) / kRows;  // equal areas
    const double across = std::sqrt(1.0 - y * y);
    for (int column = 0; column < 2 * kRows; ++column) {
      const double angle = kPi * (column + 0.5) / kRows;
      const dvec3 n(across * std::cos(angle), y, across * std::sin(angle));
      const dvec3 light = studio_radiance(n) * (4.0 * kPi / (2.0 * kRows * kRows));
      sums[0] += kBand0 * light;
      sums[1] += kBand1 * n.y * light;
      sums[2] += kBand1 * n.z * light;
      sums[3] += kBand1 * n.x * light;
      sums[4] += kBand2 * n.x * n.y * light;
      sums[5] += kBand2 * n.y * n.z * light;
      sums[6] += kBand20 * (3.0 * n.z * n.z - 1.0) * light;
      sums[7] += kBand2 * n.x * n.z * light;
      sums[8] += kBand22 * (n.x * n.x - n.y * n.y) * light;
    }
  }
  return sums;
}

dvec3 irradiance_at(const std::array<dvec3, 9>& c, const dvec3& n) {
  return c[0] + c[1] * n.y + c[2] * n.z + c[3] * n.x + c[4] * (n.x * n.y) + c[5] * (n.y * n.z) +
         c[6] * (3.0 * n.z * n.z - 1.0) + c[7] * (n.x * n.z) + c[8] * (n.x * n.x - n.y * n.y);
}

dvec3 mirrored_studio(const dvec3& direction, double roughness) {
  if (roughness < 0.03) {
    return studio_radiance(direction);
  }
  constexpr std::uint32_t kSamples = 96;
  const double alpha = roughness * roughness;
  dvec3 x;
  dvec3 z;
  beside(direction, x, z);
  dvec3 sum(0.0);
  double weight = 0.0;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    // A microfacet's normal h of GGX's distribution, and where it sends the ray.
    const double share = (i + 0.5) / kSamples;
    const double angle = 2.0 * kPi * mirrored_bits(i);
    const double cosine = std::sqrt((1.0 - share) / (1.0 + (alpha * alpha - 1.0) * share));
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const dvec3 h = sine * std::cos(angle) * x + cosine * direction + sine * std::sin(angle) * z;
    const dvec3 sent = 2.0 * glm::dot(direction, h) * h - direction;
    const double facing = glm::dot(sent, direction);
    if (facing > 0.0) {
      sum += facing * studio_radiance(sent);
      weight += facing;
    }
  }
  return sum / weight;
}

std::vector<std::uint16_t> reflection_texels(const std::vector<float>& roughness) {
  constexpr std::size_t kSide = shared::kReflectionSide;
  constexpr std::size_t kLanes = 4;
  std::vector<std::uint16_t> texels(kSide * kSide * kLanes * shared::kReflectionTiles);
  std::vector<bool> made(shared::kReflectionTiles);
  for (const float wanted : roughness) {
    const double steps = shared::kReflectionTiles - 1;
    const auto tile = static_cast<std::size_t>(
        std::lround(std::clamp(static_cast<double>(wanted), 0.0, 1.0) * steps));
    if (made[tile]) {
      continue;
    }
    made[tile] = true;
    std::uint16_t* texel = texels.data() + tile * kSide * kSide * kLanes;
    for (std::uint32_t row = 0; row < kSide; ++row) {
      for (std::uint32_t column = 0; column < kSide; ++column) {
        const dvec3 light =
            mirrored_studio(texel_direction(column, row), static_cast<double>(tile) / steps);
        for (int lane = 0; lane < 3; ++lane) {
          *texel++ = glm::packHalf1x16(static_cast<float>(light[lane]));
        }
        *texel++ = glm::packHalf1x16(1.0F);
      }
    }
  }
  return texels;
}

}  // namespace torsion::engine
