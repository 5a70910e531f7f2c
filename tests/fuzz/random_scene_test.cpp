// Seeds of random scenes in which a property once did not hold (./dev fuzz).

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "tests/fuzz/scene_properties.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine::test {
namespace {

struct Seed {
  std::uint64_t seed;
  const char* what;
  bool chosen = false;  // for every run; the others with all cases
  RandomScene (*scene)(std::uint64_t) = random_scene;
};

class RandomSceneTest : public testing::TestWithParam<Seed> {};

TEST_P(RandomSceneTest, KeepsAllProperties) {
  if (test::is_left_out(GetParam().chosen)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  const RandomScene scene = GetParam().scene(GetParam().seed);
  const std::optional<std::string> broken = broken_property(scene);
  EXPECT_FALSE(broken.has_value()) << *broken << "\n" << scene.text;
}

RandomScene random_scene_of_patch(std::uint64_t seed) {
  RandomScene random = random_scene(seed);
  random.scene.bodies[0].models.contact = ContactModel::kPatch;
  return random;
}

class StepsTest : public testing::TestWithParam<Seed> {};

TEST_P(StepsTest, TheForceIsTheSameHoweverManySteps) {
  const RandomScene scene = GetParam().scene(GetParam().seed);
  const std::optional<std::string> broken = depends_on_steps(scene);
  EXPECT_FALSE(broken.has_value()) << *broken << "\n" << scene.text;
}

INSTANTIATE_TEST_SUITE_P(
    Seeds, StepsTest,
    testing::Values(Seed{22, "MdrToolsThatSlideOverABodyThatLeans"},
                    Seed{22, "PatchToolsThatSlideOverABodyThatLeans", false, random_scene_of_patch},
                    Seed{263, "PaperToolThatSlidesOverABodyThatLeans"}),
    [](const testing::TestParamInfo<Seed>& seed) { return std::string(seed.param.what); });

INSTANTIATE_TEST_SUITE_P(
    Seeds, RandomSceneTest,
    testing::Values(
        Seed{20, "PaperGridThatGoesToAndFroUnderAToolThatStands", true},
        Seed{44, "MdrGridThatGoesToAndFro"}, Seed{117, "CylinderOnACylinder", true},
        Seed{74, "ForceOfACompliantBodyBetweenSamples"}, Seed{306, "LastForceOfACompliantBody"},
        Seed{321, "OneContactInTwoRegionsThatTakeCellsFromEachOther"},
        Seed{456, "CoarseBallInTwoRegions"}, Seed{484, "NeighboursThatTouch", true},
        Seed{458, "ContactOfANanometre"}, Seed{1049, "RegionsWhoseCouplingsAreMoreThanThemselves"},
        Seed{1264, "ContactBesideItsFirstGrid", true},
        Seed{1187, "LittleFrictionOnAnEndThatIsSoftSideways"},
        Seed{1345, "MdrOnABodyThatIsSoftSideways"}, Seed{1099, "PaperOnALongContactAskew", true},
        Seed{1148, "MdrWhereASideCutsABall", true}, Seed{1265, "MdrOnALongContactAskew", true},
        Seed{1344, "HardlyAnyForceAfterALongWay"}, Seed{1332, "BodyDraggedFromUnderTheTool"},
        Seed{1035, "RimOfAPlateThatWasNotFollowedUp", true},
        Seed{1250, "RoundedEdgesBesideSamples"}, Seed{20005, "MdrWhereABoxTurnsOntoAnEdge", true},
        Seed{20140, "MdrWhereEdgesMeet"}, Seed{20261, "MdrBetweenCoarseMeshes"},
        Seed{1085, "MdrOfAFaceOnAFace"}, Seed{20293, "MdrOnALongSliverOfABodyThatSways"},
        Seed{20011, "PatchWithMuchFriction", true}, Seed{20163, "PatchWithMuchFrictionOnAStick"},
        Seed{20119, "PatchWithMoreStaticFriction"}, Seed{21368, "RimOfACylinderInABall", true},
        Seed{21332, "RimOfACylinderOnABox"}, Seed{22057, "EdgeOnAFace"},
        Seed{30374, "MdrOfACylindersRim"}, Seed{30449, "MdrOfABallOfWhichOnlyASideIsSeen", true},
        Seed{22339, "SteepFaceOnAnEdge", true}, Seed{22013, "SteepFaceOfABox", true},
        Seed{24158, "CrookedBoxOnItsLongestEdge", true}, Seed{24179, "CapsuleOverARim"},
        Seed{21223, "FrictionOfTheLastStepOfAContact", true}, Seed{21347, "EdgeAlongAnEdge"},
        Seed{24096, "FaceBesideThatIsPressed", true}, Seed{23124, "NewCellsOnAnEdge", true},
        Seed{31027, "MdrOnTwoPartsThatMeetAtAnEdge"},
        Seed{72102, "BoxOfTrianglesSetDownFlat", true}, Seed{24035, "RimsOfTriangles"},
        // Of runs that differ by rounding alone one in twenty has a spike of a tenth and more.
        Seed{62103, "MdrPuckAndBallOnASoftBody"}, Seed{31238, "MdrTwoToolsOnASoftCapsule"},
        Seed{90181, "PaperOnABodyThatAnotherToolTilts", false, random_scene_at_edge},
        Seed{62088, "RimsOnABlockThatAnotherToolMoves"},
        Seed{33, "MdrAlongALineThatAnotherToolPushes", true, random_pinch},
        Seed{280, "MdrAlongALine", false, random_pinch},
        Seed{47, "PatchAlongALine", false, random_pinch},
        Seed{220, "PatchAlongALineWithoutFriction", false, random_pinch},
        Seed{263, "PatchOfABoxOnASlenderCylinder", false, random_pinch},
        Seed{274, "PatchThatThrowsAStickFromToolToTool", true, random_pinch}),
    [](const testing::TestParamInfo<Seed>& seed) { return std::string(seed.param.what); });

}  // namespace
}  // namespace torsion::engine::test
