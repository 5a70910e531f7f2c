// The deformed surface for another renderer.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/library/library_scenes.hpp"

namespace torsion::test {
namespace {

/// The pad's top as a grid of side x side squares, m.
Mesh top_of_pad(std::uint32_t side) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= side; ++j) {
    for (std::uint32_t i = 0; i <= side; ++i) {
      const auto along = [side](std::uint32_t k) {
        return kHalf * (2.0 * k / side - 1.0);
      };
      mesh.vertices.push_back({along(i), kHalf, along(j)});
      if (i < side && j < side) {
        const std::uint32_t here = j * (side + 1) + i;
        mesh.triangles.push_back({here, here + side + 1, here + 1});
        mesh.triangles.push_back({here + 1, here + side + 1, here + side + 2});
      }
    }
  }
  return mesh;
}

TEST(LibrarySurfaceTest, TheSurfaceIsDentedUnderTheBallAndTurnsWithIt) {
  constexpr double kDent = 2e-3;
  constexpr double kTurn = 0.02;
  constexpr std::uint32_t kSide = 40;
  Simulation simulation = simulation_of(ball_on_pad("mdr"));
  const Mesh mesh = top_of_pad(kSide);
  Surface surface(simulation.shared_model(), 0, mesh);
  Snapshot snapshot(simulation);
  press(simulation, kDent);
  for (int step = 1; step <= 100; ++step) {
    const Pose pose = pressed(kDent, kTurn * step / 100);
    simulation.step({&pose, 1});
  }
  snapshot.take(simulation);
  surface.update(snapshot);
  ASSERT_EQ(surface.positions().size(), mesh.vertices.size());
  const std::size_t middle = (kSide / 2) * (kSide + 1) + kSide / 2;
  const std::size_t corner = 0;
  EXPECT_NEAR(surface.positions()[middle][1], kHalf - kDent, 0.02 * kDent);
  EXPECT_NEAR(surface.positions()[corner][1], kHalf, 0.15 * kDent);
  // The middle sticks and goes round with the ball, up to what the friction allows it.
  EXPECT_GT(surface.twist()[middle], 0.5 * kTurn);
  EXPECT_LE(surface.twist()[middle], 1.001 * kTurn);
  EXPECT_LT(std::abs(surface.twist()[corner]), 0.05 * kTurn);
  EXPECT_NEAR(surface.normals()[corner][1], 1.0, 0.05);
  EXPECT_NEAR(snapshot.pose(0).position[1], simulation.pose(0).position[1], 0.0);
}

}  // namespace
}  // namespace torsion::test
