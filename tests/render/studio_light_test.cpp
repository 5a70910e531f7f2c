#include "render/studio_light.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include "shaders/shared.h"

namespace torsion::engine {
namespace {

using glm::dvec3;

std::vector<dvec3> random_directions(int count) {
  std::mt19937 random(7);
  std::normal_distribution<double> number;
  std::vector<dvec3> directions;
  for (int i = 0; i < count; ++i) {
    directions.push_back(glm::normalize(dvec3(number(random), number(random), number(random))));
  }
  return directions;
}

/// Mean of f over the sphere, by equal areas.
template <class F>
dvec3 mean_over_sphere(F&& f) {
  constexpr int kRows = 100;
  dvec3 sum(0.0);
  for (int row = 0; row < kRows; ++row) {
    const double y = 1.0 - 2.0 * (row + 0.5) / kRows;
    for (int column = 0; column < 2 * kRows; ++column) {
      const double angle = std::numbers::pi * (column + 0.5) / kRows;
      const double across = std::sqrt(1.0 - y * y);
      sum += f(dvec3(across * std::cos(angle), y, across * std::sin(angle)));
    }
  }
  return sum / (2.0 * kRows * kRows);
}

TEST(StudioLightTest, NineHarmonicsHoldTheDiffuseLight) {
  // Ramamoorthi and Hanrahan: no normal is farther off than 9 % of the brightest, for any light;
  // the next band's factor is 1/24 of the first's.
  const auto coefficients = studio_irradiance();
  double largest = 0.0;
  double worst = 0.0;
  for (const dvec3& n : random_directions(40)) {
    const dvec3 exact = mean_over_sphere(
        [&](const dvec3& d) { return 4.0 * std::max(glm::dot(n, d), 0.0) * studio_radiance(d); });
    const dvec3 found = irradiance_at(coefficients, n);
    for (int lane = 0; lane < 3; ++lane) {
      largest = std::max(largest, exact[lane]);
      worst = std::max(worst, std::abs(found[lane] - exact[lane]));
      EXPECT_GT(found[lane], 0.0);
    }
  }
  EXPECT_LT(worst, 0.09 * largest);
}

TEST(StudioLightTest, ASmoothMirrorShowsTheStudioAndARoughOneItsMean) {
  const dvec3 mean = mean_over_sphere(studio_radiance);
  const auto spread = [&](double roughness) {
    double sum = 0.0;
    for (const dvec3& d : random_directions(200)) {
      const double off = mirrored_studio(d, roughness).y - mean.y;
      sum += off * off;
    }
    return sum;
  };
  for (const dvec3& d : random_directions(20)) {
    EXPECT_EQ(mirrored_studio(d, 0.0), studio_radiance(d));
  }
  double before = spread(0.0);
  for (const double roughness : {0.25, 0.5, 0.75, 1.0}) {
    const double now = spread(roughness);
    EXPECT_LT(now, before) << roughness;
    before = now;
  }
}

/// shaders/reflection.glsl's on_octahedron(), written again.
glm::dvec2 on_octahedron(const dvec3& direction) {
  const dvec3 d =
      direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
  if (d.y >= 0.0) {
    return 0.5 + 0.5 * glm::dvec2(d.x, d.z);
  }
  return 0.5 + 0.5 * glm::dvec2((1.0 - std::abs(d.z)) * (d.x < 0.0 ? -1.0 : 1.0),
                                (1.0 - std::abs(d.x)) * (d.z < 0.0 ? -1.0 : 1.0));
}

TEST(StudioLightTest, TexelsAreWhereTheShaderLooks) {
  const std::vector<std::uint16_t> texels = reflection_texels({0.0F, 1.0F});
  constexpr std::size_t kSide = shared::kReflectionSide;
  ASSERT_EQ(texels.size(), kSide * kSide * 4 * shared::kReflectionTiles);
  const auto green_at = [&](std::size_t tile, const glm::dvec2& at) {
    const auto column = static_cast<std::size_t>(at.x * kSide);
    const auto row = static_cast<std::size_t>(at.y * kSide);
    return static_cast<double>(
        glm::unpackHalf1x16(texels[4 * ((tile * kSide + row) * kSide + column) + 1]));
  };
  // Within a texel, so the light of a rough mirror hardly differs.
  for (const dvec3& d : random_directions(100)) {
    EXPECT_NEAR(green_at(16, on_octahedron(d)), mirrored_studio(d, 1.0).y, 0.08);
  }
  EXPECT_EQ(green_at(3, {0.5, 0.5}), 0.0);  // no surface needs it
}

}  // namespace
}  // namespace torsion::engine
