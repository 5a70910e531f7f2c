#include "ecs/check_state.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/ecs/small_world.hpp"

namespace torsion::engine {
namespace {

TEST(CheckStateTest, AWholeStatePasses) {
  const World world = test::small_world(1);
  const Result<Done> checked = check_state(world.model, world.state);
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

class CheckStateDamageTest : public testing::TestWithParam<Damage> {};

TEST_P(CheckStateDamageTest, IsFoundAndNamed) {
  World world = test::small_world(1);
  GetParam().inflict(world);
  const Result<Done> checked = check_state(world.model, world.state);
  ASSERT_FALSE(checked.ok());
  EXPECT_EQ(checked.error().text.rfind(GetParam().place, 0), 0U) << checked.error().text;
}

const std::vector<Damage> kDamages = {
    {"cells row 0",
     [](World& world) {
       world.model.settings.grid_side = 60;
     }},
    {"bodies row 0",
     [](World& world) {
       world.state.bodies.erase(0);
     }},
    {"tools row 0",
     [](World& world) {
       world.state.tools.erase(1);
     }},
    {"regions row 0",
     [](World& world) {
       world.state.regions.at<RegionIdentity>(0).body = 2;
     }},
    {"regions row 1",
     [](World& world) {
       world.state.regions.at<RegionIdentity>(1).tool = kNoRow;
     }},
    {"regions row 1",
     [](World& world) {
       world.state.regions.at<RegionIdentity>(1).cells.count = 17;
     }},
};

INSTANTIATE_TEST_SUITE_P(All, CheckStateDamageTest, testing::ValuesIn(kDamages));

}  // namespace
}  // namespace torsion::engine
