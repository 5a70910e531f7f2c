#include "scenes/motion.hpp"

#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "device/scripted_motion.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

const float kHalfRoot = static_cast<float>(std::sqrt(0.5));

/// The tool of a scene that must be good.
ToolDescription tool_of(const GltfBuilder& scene) {
  const LoadedScene loaded = load_text(scene.text());
  EXPECT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  return loaded.scene ? loaded.scene->tools.at(0) : ToolDescription{};
}

std::string problems_of(const GltfBuilder& scene) {
  const LoadedScene loaded = load_text(scene.text());
  EXPECT_FALSE(loaded.scene.has_value());
  return to_text(loaded.problems);
}

GltfBuilder scene_without_motion() {
  GltfBuilder scene = good_scene();
  scene.document.erase("animations");
  return scene;
}

/// Where the tool's first part has its vertices at `time`, world.
std::vector<glm::dvec3> vertices_at(const ToolDescription& tool, double time) {
  const Pose pose = scripted_pose(tool.script, time);
  std::vector<glm::dvec3> places;
  for (const glm::dvec3& position : tool.parts.at(0).surface.positions) {
    places.push_back(pose.rotation * position + pose.position);
  }
  return places;
}

/// The largest distance from a vertex of the box of good_scene(), moved by `to_world`, to the
/// nearest vertex of `places`.
double miss(const std::vector<glm::dvec3>& places, const glm::dmat4& to_world) {
  double largest = 0.0;
  for (const glm::dvec3& corner : box_mesh(glm::dvec3(0.01)).positions) {
    const glm::dvec3 expected(to_world * glm::dvec4(corner, 1.0));
    double nearest = 1e300;
    for (const glm::dvec3& place : places) {
      nearest = std::min(nearest, glm::distance(place, expected));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

// Keys and positions are floats of about 0.1: 1e-8; a turn by float quaternions adds 1e-7 * 0.1.
constexpr double kTolerance = 3e-8;

TEST(MotionTest, KeysAndInterpolationComeFromTheFile) {
  for (const auto& [name, kind] :
       {std::pair{"STEP", Interpolation::kStep}, std::pair{"LINEAR", Interpolation::kLinear}}) {
    GltfBuilder scene = scene_without_motion();
    scene.add_motion(1, "translation", {0.5F, 1.0F, 2.0F}, {0, 1, 0, 0, 2, 0, 0, 4, 0}, name);
    const ToolDescription tool = tool_of(scene);
    const MotionLink& link = tool.script.links.at(0);
    EXPECT_EQ(link.animated_translation.interpolation, kind);
    EXPECT_EQ(link.animated_translation.times, (std::vector<double>{0.5, 1.0, 2.0}));
    ASSERT_EQ(link.animated_translation.values.size(), 3U);
    EXPECT_EQ(link.animated_translation.values[2], glm::dvec4(0.0, 4.0, 0.0, 0.0));
    EXPECT_TRUE(link.animated_rotation.empty());
  }
}

TEST(MotionTest, CubicSplineHasTangentsAroundEachValue) {
  GltfBuilder scene = scene_without_motion();
  scene.add_motion(1, "translation", {0.0F, 2.0F},
                   {9, 9, 9, 0, 1, 0, 0, 3, 0, 0, -1, 0, 0, 5, 0, 9, 9, 9}, "CUBICSPLINE");
  const ToolDescription tool = tool_of(scene);
  ASSERT_EQ(tool.script.links.at(0).animated_translation.values.size(), 6U);
  // Hermite at the middle of 2 s: (1 + 5) / 2 + 2 / 8 (3 - (-1)) = 4.
  EXPECT_NEAR(scripted_pose(tool.script, 1.0).position.y, 4.0, 1e-12);
}

TEST(MotionTest, InterpolationIsLinearWhereTheFileSaysNothing) {
  GltfBuilder scene = good_scene();
  scene.document["animations"][0]["samplers"][0].erase("interpolation");
  EXPECT_EQ(tool_of(scene).script.links.at(0).animated_translation.interpolation,
            Interpolation::kLinear);
}

TEST(MotionTest, RotationIsReadAsXyzw) {
  GltfBuilder scene = scene_without_motion();
  scene.add_motion(1, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, kHalfRoot, 0, kHalfRoot});
  const Pose pose = scripted_pose(tool_of(scene).script, 1.0);
  const glm::dvec3 turned = pose.rotation * glm::dvec3(1.0, 0.0, 0.0);  // a quarter about y
  EXPECT_LE(glm::distance(turned, glm::dvec3(0.0, 0.0, -1.0)), 1e-7);
}

TEST(MotionTest, NormalisedIntegersAreRotationsToo) {
  GltfBuilder scene = scene_without_motion();
  scene.add_motion(1, "rotation", {0.0F}, {0, 0, 0, 1});
  const std::array<std::int16_t, 4> quarter = {0, 23170, 0, 23170};
  const int view = scene.add_view({reinterpret_cast<const char*>(quarter.data()), sizeof quarter});
  nlohmann::json& accessor = scene.document["accessors"].back();
  accessor["bufferView"] = view;
  accessor["componentType"] = 5122;
  accessor["normalized"] = true;
  const Pose pose = scripted_pose(tool_of(scene).script, 0.0);
  EXPECT_NEAR(pose.rotation.y, std::sqrt(0.5), 1e-12);  // the length 0.99998 is normalised
}

TEST(MotionTest, EndIsTheLastKeyOfAllChannelsOnTheWayToTheTool) {
  GltfBuilder scene = good_scene();
  const int arm = scene.add_node({{"name", "arm"}});
  scene.put_below(1, arm);
  scene.add_motion(arm, "rotation", {0.0F, 2.5F}, {0, 0, 0, 1, 0, 0, 0, 1});
  EXPECT_EQ(tool_of(scene).script.end_time, 2.5);
  const LoadedScene loaded = load_text(scene.text());
  EXPECT_EQ(loaded.scene->duration, 2.5);
}

TEST(MotionTest, FramesOfEveryNodeOnTheWayMultiply) {
  GltfBuilder scene = scene_without_motion();
  const int arm = scene.add_node({{"name", "arm"}, {"translation", {1.0, 0.0, 0.0}}});
  const int hand = scene.add_node({{"name", "hand"}, {"scale", {2.0, 2.0, 2.0}}});
  scene.put_below(1, hand);
  scene.put_below(hand, arm);
  scene.add_motion(arm, "rotation", {0.0F, 1.0F},
                   {0, 0, 0, 1, 0, 0, kHalfRoot, kHalfRoot});  // a quarter about z
  const ToolDescription tool = tool_of(scene);
  ASSERT_EQ(tool.script.links.size(), 3U);
  // The block's own translation (0, 0.13, 0), scaled by 2, turned to -x, moved by the arm's.
  const Pose pose = scripted_pose(tool.script, 1.0);
  EXPECT_LE(glm::distance(pose.position, glm::dvec3(0.74, 0.0, 0.0)), kTolerance);
  const glm::dmat4 to_world =
      glm::translate(glm::dmat4(1.0), glm::dvec3(0.74, 0.0, 0.0)) *
      glm::rotate(glm::dmat4(1.0), std::numbers::pi / 2.0, glm::dvec3(0.0, 0.0, 1.0)) *
      glm::scale(glm::dmat4(1.0), glm::dvec3(2.0));
  EXPECT_LE(miss(vertices_at(tool, 1.0), to_world), kTolerance);
}

TEST(MotionTest, NodeWithAMatrixRestsWhereTheMatrixPutsIt) {
  GltfBuilder scene = scene_without_motion();
  const int arm = scene.add_node(
      {{"name", "arm"}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.5, 0.25, 0, 1}}});
  scene.put_below(1, arm);
  scene.add_motion(1, "translation", {0.0F}, {0, 1, 0});
  const Pose pose = scripted_pose(tool_of(scene).script, 0.0);
  EXPECT_LE(glm::distance(pose.position, glm::dvec3(-0.5, 0.25, 0.0)), 1e-12);
}

TEST(MotionTest, SurfaceStaysOnTheMeshWhateverTheSignsOfTheScale) {
  for (int signs = 0; signs < 8; ++signs) {
    const glm::dvec3 scale((signs & 1) != 0 ? -1.0 : 1.0, (signs & 2) != 0 ? -2.0 : 2.0,
                           (signs & 4) != 0 ? -3.0 : 3.0);
    GltfBuilder scene = scene_without_motion();
    // A mesh off its origin, so that a turn by half a circle shows.
    scene.node("block")["scale"] = {scale.x, scale.y, scale.z};
    SurfaceMesh box = box_mesh(glm::dvec3(0.01));
    for (glm::dvec3& position : box.positions) {
      position += glm::dvec3(0.02, 0.03, 0.04);
    }
    scene.node("block")["mesh"] = scene.add_mesh(box);
    scene.add_motion(1, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, kHalfRoot, 0, kHalfRoot});
    const ToolDescription tool = tool_of(scene);
    const glm::dmat4 mesh_to_world =
        glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.13, 0.0)) *
        glm::rotate(glm::dmat4(1.0), std::numbers::pi / 2.0, glm::dvec3(0.0, 1.0, 0.0)) *
        glm::scale(glm::dmat4(1.0), scale) *
        glm::translate(glm::dmat4(1.0), glm::dvec3(0.02, 0.03, 0.04));
    EXPECT_LE(miss(vertices_at(tool, 1.0), mesh_to_world), kTolerance) << signs;
  }
}

TEST(MotionTest, EvenScaleOfAnySignAboveATurningToolKeepsItOnItsPath) {
  for (const double scale : {2.0, -2.0}) {
    GltfBuilder scene = scene_without_motion();
    const int arm = scene.add_node({{"name", "arm"}, {"scale", {scale, scale, scale}}});
    scene.put_below(1, arm);
    SurfaceMesh box = box_mesh(glm::dvec3(0.01));
    for (glm::dvec3& position : box.positions) {
      position += glm::dvec3(0.02, 0.03, 0.04);
    }
    scene.node("block")["mesh"] = scene.add_mesh(box);
    scene.add_motion(1, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0, kHalfRoot, kHalfRoot});
    const glm::dmat4 to_world =
        glm::scale(glm::dmat4(1.0), glm::dvec3(scale)) *
        glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.13, 0.0)) *
        glm::rotate(glm::dmat4(1.0), std::numbers::pi / 2.0, glm::dvec3(0.0, 0.0, 1.0)) *
        glm::translate(glm::dmat4(1.0), glm::dvec3(0.02, 0.03, 0.04));
    EXPECT_LE(miss(vertices_at(tool_of(scene), 1.0), to_world), kTolerance) << scale;
  }
}

TEST(MotionTest, MirrorAboveATurningToolIsRefused) {
  GltfBuilder scene = scene_without_motion();
  const int arm = scene.add_node({{"name", "arm"}, {"scale", {1.0, -1.0, 1.0}}});
  scene.put_below(1, arm);
  scene.add_motion(1, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0, kHalfRoot, kHalfRoot});
  const std::string text = problems_of(scene);
  EXPECT_NE(text.find("node \"arm\": scale is 1, -1, 1"), std::string::npos) << text;
}

TEST(MotionTest, TurningBelowAnUnevenScaleIsRefused) {
  // The tool would change its shape as it turns.
  GltfBuilder scene = scene_without_motion();
  const int arm = scene.add_node({{"name", "arm"}, {"scale", {1.0, 2.0, 1.0}}});
  scene.put_below(1, arm);
  scene.add_motion(1, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0, kHalfRoot, kHalfRoot});
  const std::string text = problems_of(scene);
  EXPECT_NE(text.find("node \"arm\""), std::string::npos) << text;
  EXPECT_NE(text.find("scale"), std::string::npos) << text;
}

TEST(MotionTest, ShiftingBelowAnUnevenScaleIsFine) {
  GltfBuilder scene = good_scene();
  const int arm = scene.add_node({{"name", "arm"}, {"scale", {1.0, 2.0, 1.0}}});
  scene.put_below(1, arm);
  EXPECT_LE(
      glm::distance(scripted_pose(tool_of(scene).script, 1.0).position, glm::dvec3(0.0, 0.18, 0.0)),
      kTolerance);
}

TEST(MotionTest, TwoChannelsForOnePropertyAreRefused) {
  GltfBuilder scene = good_scene();
  scene.add_motion(1, "translation", {0.0F}, {0, 1, 0});
  const std::string text = problems_of(scene);
  EXPECT_NE(text.find("node \"block\": translation"), std::string::npos) << text;
}

TEST(MotionTest, PartThatMovesWithinAToolIsRefused) {
  GltfBuilder scene = good_scene();
  const int mesh = scene.add_mesh(box_mesh(glm::dvec3(0.01)));
  const int finger = scene.add_node({{"name", "finger"}, {"mesh", mesh}});
  scene.put_below(finger, 1);
  scene.add_motion(finger, "translation", {0.0F}, {0, 1, 0});
  const std::string text = problems_of(scene);
  EXPECT_NE(text.find("node \"finger\""), std::string::npos) << text;
  EXPECT_NE(text.find("rigid tool node \"block\""), std::string::npos) << text;
}

TEST(MotionTest, ToolOfADeviceNeedsNoAnimation) {
  GltfBuilder scene = scene_without_motion();
  scene.node("block")["extras"]["torsion_device"] = "mouse";
  const ToolDescription tool = tool_of(scene);
  EXPECT_EQ(tool.device, "mouse");
  EXPECT_EQ(tool.script.end_time, 0.0);
  EXPECT_LE(glm::distance(scripted_pose(tool.script, 0.0).position, glm::dvec3(0.0, 0.13, 0.0)),
            1e-12);
}

TEST(MotionTest, FirstKeyOfBlenderMayBeAfterTheStart) {
  GltfBuilder scene = scene_without_motion();
  scene.add_motion(1, "translation", {0.041667F, 1.0F}, {0, 0.2F, 0, 0, 0.1F, 0});
  EXPECT_NEAR(scripted_pose(tool_of(scene).script, 0.0).position.y, 0.2, kTolerance);
}

}  // namespace
}  // namespace torsion::engine::test
