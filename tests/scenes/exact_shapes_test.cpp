#include "scenes/exact_shapes.hpp"

#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scenes/closed_mesh.hpp"

namespace torsion::engine::test {
namespace {

using std::numbers::pi;

struct Fitted {
  std::vector<Problem> found;
  std::optional<ShapePart> shape;
};

Fitted fit(const std::string& name, const glm::dvec3& extent, const NodeTransform& to_owner = {}) {
  Fitted fitted;
  fitted.shape = fit_shape(shape_kind(name), -0.5 * extent, 0.5 * extent, to_owner, "node \"n\"",
                           {"f.gltf", fitted.found});
  return fitted;
}

TEST(ExactShapesTest, BoundsThatSuitAreTakenWithinOnePercent) {
  EXPECT_TRUE(fit("box", {1.0, 2.0, 3.0}).shape);
  EXPECT_TRUE(fit("ellipsoid", {1.0, 2.0, 3.0}).shape);
  EXPECT_TRUE(fit("sphere", {1.0, 1.009, 0.999}).shape);
  EXPECT_TRUE(fit("cylinder", {1.0, 7.0, 1.009}).shape);
  EXPECT_TRUE(fit("capsule", {1.0, 7.0, 1.0}).shape);
  EXPECT_TRUE(fit("capsule", {1.0, 0.995, 1.0}).shape);  // a sphere, as a mesh of it may be cut
}

TEST(ExactShapesTest, BoundsThatDoNotSuitAreProblems) {
  EXPECT_FALSE(fit("sphere", {1.0, 1.02, 1.0}).shape);
  EXPECT_FALSE(fit("cylinder", {1.0, 7.0, 1.02}).shape);
  EXPECT_FALSE(fit("capsule", {1.0, 0.9, 1.0}).shape);
  EXPECT_FALSE(fit("box", {1.0, 0.0, 1.0}).shape);
  const Fitted fitted = fit("cylinder", {2.0, 1.0, 1.0});
  ASSERT_EQ(fitted.found.size(), 1U);
  EXPECT_EQ(fitted.found[0].where, "node \"n\"");
  EXPECT_NE(fitted.found[0].value.find("2 x 1 x 1 m"), std::string::npos);
  EXPECT_NE(fitted.found[0].mend.find("y axis"), std::string::npos);
}

TEST(ExactShapesTest, ScaleOfTheNodeCountsBeforeTheBoundsAreJudged) {
  NodeTransform to_owner;
  to_owner.scale = {1.0, 1.0, 2.0};
  EXPECT_FALSE(fit("sphere", {1.0, 1.0, 1.0}, to_owner).shape);
  EXPECT_TRUE(fit("sphere", {1.0, 1.0, 0.5}, to_owner).shape);
}

TEST(ExactShapesTest, CenterOfTheBoundsIsCarriedIntoTheOwnersFrame) {
  NodeTransform to_owner;
  to_owner.translation = {0.0, 0.0, 1.0};
  to_owner.rotation = glm::angleAxis(pi / 2.0, glm::dvec3(0.0, 0.0, 1.0));
  to_owner.scale = {-2.0, 1.0, 1.0};  // mirrored
  std::vector<Problem> found;
  const auto shape = fit_shape(ShapeKind::kBox, {1.0, 0.0, 0.0}, {3.0, 2.0, 2.0}, to_owner, "n",
                               {"f.gltf", found});
  ASSERT_TRUE(shape);
  // Centre (2, 1, 1) scaled to (-4, 1, 1), turned a quarter about z to (-1, -4, 1), then moved.
  EXPECT_LE(glm::distance(shape->pose.position, glm::dvec3(-1.0, -4.0, 2.0)), 1e-14);
  EXPECT_EQ(shape->half_extent, glm::dvec3(2.0, 1.0, 1.0));
}

struct Solid {
  const char* name;
  glm::dvec3 extent;  // m
  double volume;      // m^3, exact
};

class TessellateTest : public testing::TestWithParam<Solid> {};

TEST_P(TessellateTest, IsClosedAndHasTheVolumeOfTheSolid) {
  const Solid& solid = GetParam();
  NodeTransform to_owner;
  to_owner.translation = {0.3, -0.2, 0.1};
  to_owner.rotation = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, 3.0)));
  const Fitted fitted = fit(solid.name, solid.extent, to_owner);
  ASSERT_TRUE(fitted.shape);
  std::vector<Problem> found;
  const SurfaceMesh mesh = closed_surface(tessellate(*fitted.shape), "n", {"f.gltf", found});
  EXPECT_TRUE(found.empty()) << to_text(found);
  // Inscribed polyhedra lose volume with the square of the edge over the radius: 96 edges around
  // give less than 1 - sin(2 pi / 96) / (2 pi / 96) = 0.0007 in each of two directions, and where
  // the cube's corners stretch the quads up to 3 times that.
  const double volume = enclosed_volume(mesh);
  EXPECT_LE(volume, solid.volume * (1.0 + 1e-9));
  EXPECT_GE(volume, solid.volume * (1.0 - 0.0045));
}

TEST_P(TessellateTest, FillsTheBoundsThatItWasFittedTo) {
  const Solid& solid = GetParam();
  const Fitted fitted = fit(solid.name, solid.extent);
  ASSERT_TRUE(fitted.shape);
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  for (const glm::dvec3& position : tessellate(*fitted.shape).positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(low[axis], -0.5 * solid.extent[axis], 1e-12);
    EXPECT_NEAR(high[axis], 0.5 * solid.extent[axis], 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Solids, TessellateTest,
    testing::Values(Solid{"box", {1.0, 2.0, 3.0}, 6.0},
                    Solid{"sphere", {2.0, 2.0, 2.0}, 4.0 / 3.0 * pi},
                    Solid{"ellipsoid", {2.0, 4.0, 1.0}, 4.0 / 3.0 * pi},
                    Solid{"cylinder", {2.0, 5.0, 2.0}, 5.0 * pi},
                    Solid{"capsule", {2.0, 5.0, 2.0}, 3.0 * pi + 4.0 / 3.0 * pi}),
    [](const testing::TestParamInfo<Solid>& solid) { return std::string(solid.param.name); });

}  // namespace
}  // namespace torsion::engine::test
