// Which models a body gets where scene and user leave it open.

#include "systems/model/choose_models.hpp"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"

namespace torsion::engine {
namespace {

/// A contact of radius 1 on a body 100 high, round, that only turns.
ExpectedContact round_contact() {
  ExpectedContact contact;
  contact.known = contact.any = true;
  contact.radius = 1.0;
  contact.body_depth = 100.0;
  return contact;
}

ModelChoice chosen(const ExpectedContact& contact, double tolerance, double poisson_ratio = 0.5) {
  BodyModels scene;
  scene.tolerance = tolerance;
  return choose_models(scene, {}, contact, poisson_ratio);
}

TEST(ChooseModelsTest, TheCheapestModelWithinTheToleranceIsTaken) {
  ExpectedContact contact = round_contact();
  EXPECT_EQ(chosen(contact, 0.005).models.contact, ContactModel::kMdr);
  EXPECT_EQ(chosen(contact, 0.002).models.contact, ContactModel::kPatch);
  EXPECT_EQ(chosen(contact, 0.05, 0.3).models.contact, ContactModel::kMdr);
  EXPECT_EQ(chosen(contact, 0.03, 0.3).models.contact, ContactModel::kPatch);  // coupling
  contact.single = false;
  EXPECT_EQ(chosen(contact, 0.005).models.contact, ContactModel::kMdr);
  contact.slides = true;
  EXPECT_EQ(chosen(contact, 0.08).models.contact, ContactModel::kMdr);
  EXPECT_EQ(chosen(contact, 0.05).models.contact, ContactModel::kPatch);
  contact.smooth = false;
  EXPECT_EQ(chosen(contact, 0.5).models.contact, ContactModel::kPatch);
  EXPECT_EQ(chosen(ExpectedContact{}, 0.5).models.contact, ContactModel::kPatch);
}

TEST(ChooseModelsTest, AWideContactTakesTheBodyIn) {
  ExpectedContact contact = round_contact();
  EXPECT_EQ(chosen(contact, 0.05).models.body, BodyModel::kNone);
  contact.body_depth = 20.0;
  EXPECT_EQ(chosen(contact, 0.05).models.body, BodyModel::kCompliance);
  EXPECT_EQ(chosen(contact, 0.05).models.contact, ContactModel::kMdr);
  contact.body_depth = 1.5;  // as wide as the body is high: mdr does not know the pressure's shape
  EXPECT_EQ(chosen(contact, 0.05).models.contact, ContactModel::kPatch);
  EXPECT_NE(chosen(contact, 0.05).contact_why.find("error of mdr 6.3 %, tolerance 5 %"),
            std::string::npos);
}

/// What a tool on the middle of a cube gets when it turns there by 0.1 rad and slides on by
/// `slide`.
ModelChoice choice_for(std::vector<PartDescription> tool, const glm::dvec3& slide) {
  SceneDescription scene = test::ball_on_cube();
  scene.bodies[0].models.body = BodyModel::kNone;
  scene.bodies[0].models.contact = ContactModel::kAuto;
  scene.tools[0] = test::make_tool(std::move(tool));
  PrepareOptions options;
  const glm::dvec3 place(0.0, 0.1195, 0.0);
  options.expected_poses = {{{place, glm::dquat(1.0, 0.0, 0.0, 0.0)}},
                            {{place + slide, glm::angleAxis(0.1, glm::dvec3(0.0, 1.0, 0.0))}}};
  test::Hand hand(scene, options);
  return hand.simulation().choices[0];
}

// By the part that touches, not by all that the tool has: the box is a handle high above.
TEST(ChooseModelsTest, ThePartThatTouchesCounts) {
  const Pose up{glm::dvec3(0.0, 0.06, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)};
  const PartDescription handle = test::make_part(ShapeKind::kBox, glm::dvec3(0.02), up);
  const PartDescription ball = test::make_part(ShapeKind::kSphere, glm::dvec3(0.02));
  const PartDescription block = test::make_part(ShapeKind::kBox, glm::dvec3(0.02));
  const glm::dvec3 stays(0.0);
  const glm::dvec3 slides(0.01, 0.0, 0.0);
  const auto why = [&](const PartDescription& foot, const glm::dvec3& slide) {
    return choice_for({foot, handle}, slide).contact_why;
  };
  EXPECT_EQ(why(ball, stays), "auto: one round contact, error of mdr 0.38 %, tolerance 5 %");
  EXPECT_EQ(why(ball, slides),
            "auto: one round contact that slides while it turns, error of mdr 7 %, tolerance 5 %");
  EXPECT_EQ(why(block, stays), "auto: a contact with edges or of a mesh, tolerance 5 %");
  const PartDescription pin = test::make_part(ShapeKind::kCapsule, {0.02, 0.04, 0.02},
                                              {stays, glm::angleAxis(1.5708, glm::dvec3(0, 0, 1))});
  EXPECT_EQ(why(pin, stays), "auto: one smooth contact, error of mdr 2.5 %, tolerance 5 %");
  // Longer than the cube's top of 0.1 m: its edges end the contact, which no paraboloid has.
  const PartDescription bar = test::make_part(ShapeKind::kCapsule, {0.02, 0.08, 0.02},
                                              {stays, glm::angleAxis(1.5708, glm::dvec3(0, 0, 1))});
  const std::string of_long =
      "auto: a long contact with edges, error of patch up to 7 %, tolerance 5 %";
  EXPECT_EQ(why(bar, stays),
            "auto: a long contact with edges, error of patch up to 9 %, tolerance 5 %");
  const PartDescription blade = test::make_part(ShapeKind::kBox, {0.02, 0.02, 0.004});
  EXPECT_EQ(why(blade, stays), of_long);
}

/// Of a ball that goes on by `way` and turns about the world's z by `turn`, in ten poses.
ExpectedContact ball_goes_on(double way, double turn) {
  SceneDescription scene = test::ball_on_cube();
  scene.bodies[0].models.body = BodyModel::kNone;
  scene.bodies[0].models.contact = ContactModel::kAuto;
  scene.tools[0] = test::make_tool({test::make_part(ShapeKind::kSphere, glm::dvec3(0.02))});
  test::Hand hand(scene);
  std::vector<std::vector<Pose>> poses;
  for (int i = 0; i <= 10; ++i) {
    poses.push_back({{{0.1 * i * way, 0.1195, 0.0},
                      glm::angleAxis(0.1 * i * turn, glm::dvec3(0.0, 0.0, 1.0))}});
  }
  return expect_contact(hand.world().model, 0, poses);
}

TEST(ChooseModelsTest, RollingIsWhatAContactGoesOverBothSurfaces) {
  constexpr double kWay = 0.001;
  const double radius = ball_goes_on(0.0, 0.0).radius;
  EXPECT_EQ(ball_goes_on(0.0, 0.0).rolled, 0.0);
  EXPECT_NEAR(ball_goes_on(kWay, 0.0).rolled, 0.0, 1e-9);  // slides
  // The chord over the ball leans by half its turn, 1.3 %; the radius is that of the samples.
  EXPECT_NEAR(ball_goes_on(kWay, -kWay / 0.02).rolled * radius, kWay, 0.04 * kWay);
  // Half as fast as it would have to be: as much of the way slips.
  EXPECT_NEAR(ball_goes_on(kWay, -0.5 * kWay / 0.02).rolled * radius, 0.5 * kWay, 0.04 * kWay);
  EXPECT_NEAR(ball_goes_on(0.0, -kWay / 0.02).rolled, 0.0, 1e-9);  // turns on its place
}

TEST(ChooseModelsTest, ARollingContactIsPatchs) {
  ExpectedContact contact = round_contact();
  contact.rolled = 0.04;
  EXPECT_EQ(chosen(contact, 0.05).models.contact, ContactModel::kMdr);
  contact.rolled = 0.1;
  EXPECT_EQ(chosen(contact, 0.05).models.contact, ContactModel::kPatch);
  EXPECT_EQ(chosen(contact, 0.05).contact_why,
            "auto: one round contact that rolls, error of mdr 9.8 %, tolerance 5 %");
  contact.rolled = 50.0;
  EXPECT_NE(chosen(contact, 0.05).contact_why.find("error of mdr 100 %"), std::string::npos);
}

TEST(ChooseModelsTest, ALongContactGetsMoreCells) {
  const auto side_for = [](const glm::dvec3& half_size) {
    const std::vector<ModelChoice> choices{
        choice_for({test::make_part(ShapeKind::kBox, half_size)}, glm::dvec3(0.0))};
    return choose_grid_side(choices);
  };
  EXPECT_EQ(side_for({0.02, 0.02, 0.02}), 12U);
  EXPECT_EQ(side_for({0.02, 0.02, 0.004}), 20U);
}

// Its bed is as deep as the body: with a body model that would deflect twice.
TEST(ChooseModelsTest, WinklerGetsNoBodyModelUnlessOneIsAskedFor) {
  const ExpectedContact by_hand;
  BodyModels scene;
  scene.contact = ContactModel::kPatch;
  EXPECT_EQ(choose_models(scene, {}, by_hand, 0.5).models.body, BodyModel::kCompliance);
  scene.contact = ContactModel::kWinkler;
  const ModelChoice choice = choose_models(scene, {}, by_hand, 0.5);
  EXPECT_EQ(choice.models.body, BodyModel::kNone);
  EXPECT_EQ(choose_grid_side(std::vector<ModelChoice>{choice}), 16U);
  scene.body = BodyModel::kSkeleton;
  EXPECT_EQ(choose_models(scene, {}, by_hand, 0.5).models.body, BodyModel::kSkeleton);
}

}  // namespace
}  // namespace torsion::engine
