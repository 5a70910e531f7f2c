#include "ecs/check_world.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/ecs/small_world.hpp"

namespace torsion {
namespace {

TEST(CheckWorldTest, AWholeWorldPasses) {
  const Result<Done> checked = check_world(test::small_world(1));
  EXPECT_TRUE(checked.ok()) << checked.error().text;
}

struct Damage {
  std::string place;  // how the message begins
  std::function<void(World&)> inflict;
};

// Google Test finds it by this name.
void PrintTo(const Damage& damage, std::ostream* out) {  // NOLINT(readability-identifier-naming)
  *out << damage.place;
}

class CheckWorldDamageTest : public testing::TestWithParam<Damage> {};

TEST_P(CheckWorldDamageTest, IsFoundAndNamed) {
  World world = test::small_world(1);
  GetParam().inflict(world);
  const Result<Done> checked = check_world(world);
  ASSERT_FALSE(checked.ok());
  EXPECT_EQ(checked.error().text.rfind(GetParam().place, 0), 0U) << checked.error().text;
}

const std::vector<Damage> kDamages = {
    {"settings row 0",
     [](World& world) {
       world.settings.clear();
     }},
    {"settings row 0",
     [](World& world) {
       world.settings.at<Settings>(0).grid_side = 0;
     }},
    {"cells row 0",
     [](World& world) {
       world.settings.at<Settings>(0).grid_side = 60;
     }},
    {"clock row 0",
     [](World& world) {
       world.clock.clear();
     }},
    {"sections row 0",
     [](World& world) {
       world.sections.erase(0);
     }},
    {"parts row 0",
     [](World& world) {
       world.parts.at<ShapePart>(0).kind = static_cast<ShapeKind>(99);
     }},
    {"parts row 1",
     [](World& world) {
       world.parts.at<ShapePart>(1).field = 1;
     }},
    {"fields row 0",
     [](World& world) {
       world.fields.at<DistanceField>(0).cells.x = 3;
     }},
    {"fields row 0",
     [](World& world) {
       world.fields.at<DistanceField>(0).cells.y = UINT32_MAX;
     }},
    {"fields row 0",
     [](World& world) {
       world.fields.at<DistanceField>(0).bricks.count = 9;
     }},
    {"fields row 0",
     [](World& world) {
       world.fields.at<DistanceField>(0).subdivision = 3;
     }},
    {"fields row 0",
     [](World& world) {
       world.field_bricks.at<DistanceBrick>(3).first_node = 28;
     }},
    {"tools row 1",
     [](World& world) {
       world.samples.at<SurfaceSample>(12).neighbours[7] = 10;
     }},
    {"tools row 0",
     [](World& world) {
       world.balls.at<SurfaceBall>(5).skip = 5;
     }},
    {"tools row 0",
     [](World& world) {
       world.balls.at<SurfaceBall>(5).skip = 21;
     }},
    {"tools row 1",
     [](World& world) {
       world.balls.at<SurfaceBall>(21).sample = 10;
     }},
    {"tools row 1",
     [](World& world) {
       world.tools.at<OwnedRows>(1).balls.first = 21;
     }},
    {"tools row 0",
     [](World& world) {
       world.tools.at<OwnedRows>(0).parts = {2, UINT32_MAX};
     }},
    {"bodies row 1",
     [](World& world) {
       world.bodies.at<OwnedRows>(1).anchors.count = 4;
     }},
    {"bodies row 0",
     [](World& world) {
       world.bodies.at<FixedRegion>(0).volumes = {3, 0};
     }},
    {"regions row 0",
     [](World& world) {
       world.regions.at<RegionIdentity>(0).body = 2;
     }},
    {"regions row 1",
     [](World& world) {
       world.regions.at<RegionIdentity>(1).tool = kNoRow;
     }},
    {"regions row 1",
     [](World& world) {
       world.regions.at<RegionIdentity>(1).cells.count = 17;
     }},
};

INSTANTIATE_TEST_SUITE_P(All, CheckWorldDamageTest, testing::ValuesIn(kDamages));

}  // namespace
}  // namespace torsion
