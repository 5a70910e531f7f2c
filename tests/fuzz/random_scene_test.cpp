// Seeds of random scenes in which a property once did not hold (./dev fuzz).

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "tests/fuzz/scene_properties.hpp"

namespace torsion::test {
namespace {

struct Seed {
  std::uint64_t seed;
  const char* what;
};

class RandomSceneTest : public testing::TestWithParam<Seed> {};

TEST_P(RandomSceneTest, KeepsAllProperties) {
  const RandomScene scene = random_scene(GetParam().seed);
  const std::optional<std::string> broken = broken_property(scene);
  EXPECT_FALSE(broken.has_value()) << *broken << "\n" << scene.text;
}

INSTANTIATE_TEST_SUITE_P(
    Seeds, RandomSceneTest,
    testing::Values(
        Seed{20, "PaperGridThatGoesToAndFroUnderAToolThatStands"},
        Seed{44, "MdrGridThatGoesToAndFro"}, Seed{117, "CylinderOnACylinder"},
        Seed{74, "ForceOfACompliantBodyBetweenSamples"}, Seed{306, "LastForceOfACompliantBody"},
        Seed{321, "OneContactInTwoRegionsThatTakeCellsFromEachOther"},
        Seed{456, "CoarseBallInTwoRegions"}, Seed{484, "NeighboursThatTouch"},
        Seed{458, "ContactOfANanometre"}, Seed{1049, "RegionsWhoseCouplingsAreMoreThanThemselves"},
        Seed{1264, "ContactBesideItsFirstGrid"},
        Seed{1187, "LittleFrictionOnAnEndThatIsSoftSideways"},
        Seed{1345, "MdrOnABodyThatIsSoftSideways"}, Seed{1099, "PaperOnALongContactAskew"},
        Seed{1148, "MdrWhereASideCutsABall"}, Seed{1265, "MdrOnALongContactAskew"},
        Seed{1344, "HardlyAnyForceAfterALongWay"}),
    [](const testing::TestParamInfo<Seed>& seed) { return std::string(seed.param.what); });

}  // namespace
}  // namespace torsion::test
