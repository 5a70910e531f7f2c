#include "scenes/load_gltf.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "device/scripted_motion.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

// Positions are floats of about 0.1 m in the file: half a unit in their last place is 4e-9 m.
constexpr double kFloatError = 1e-8;

const SceneDescription& scene_of(const LoadedScene& loaded) {
  EXPECT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  static const SceneDescription kNothing;
  return loaded.scene ? *loaded.scene : kNothing;
}

void expect_near(const glm::dvec3& is, const glm::dvec3& expected, double tolerance) {
  EXPECT_LE(glm::distance(is, expected), tolerance)
      << is.x << ' ' << is.y << ' ' << is.z << " is not " << expected.x << ' ' << expected.y << ' '
      << expected.z;
}

TEST(LoadGltfTest, PlainSceneHasTheDefaultsOfTheConventions) {
  const LoadedScene loaded = load_text(good_scene().text());
  const SceneDescription& scene = scene_of(loaded);
  ASSERT_EQ(scene.bodies.size(), 1U);
  ASSERT_EQ(scene.tools.size(), 1U);
  const BodyDescription& body = scene.bodies[0];
  EXPECT_EQ(body.node, "cube");
  EXPECT_EQ(body.elasticity.youngs_modulus, 3e6);
  EXPECT_EQ(body.elasticity.poisson_ratio, 0.5);
  EXPECT_EQ(body.elasticity.density, 1100.0);
  EXPECT_EQ(body.friction.static_friction, 0.75);
  EXPECT_EQ(body.friction.dynamic_friction, 0.75);
  EXPECT_EQ(body.models.contact, ContactModel::kAuto);
  EXPECT_EQ(body.models.body, BodyModel::kAuto);
  EXPECT_EQ(body.models.tolerance, 0.05);
  EXPECT_EQ(body.fixed.kind, FixedKind::kPoint);
  expect_near(body.fixed.point, {0.0, -0.05, 0.0}, kFloatError);
  ASSERT_EQ(body.parts.size(), 1U);
  EXPECT_EQ(body.parts[0].shape.kind, ShapeKind::kMesh);
  EXPECT_EQ(body.parts[0].surface.positions.size(), 8U);
  EXPECT_EQ(scene.tools[0].device, "animation");
  EXPECT_EQ(scene.tools[0].mass.mass, 1.0);
  EXPECT_EQ(scene.duration, 1.0);
}

TEST(LoadGltfTest, BinaryFileGivesTheSameSceneAsText) {
  const GltfBuilder builder = good_scene();
  const LoadedScene text = load_text(builder.text());
  const LoadedScene binary = load_text(builder.glb(), "scene.glb");
  ASSERT_EQ(scene_of(binary).bodies.size(), 1U);
  EXPECT_EQ(scene_of(binary).bodies[0].parts[0].surface.positions,
            scene_of(text).bodies[0].parts[0].surface.positions);
  EXPECT_EQ(scene_of(binary).tools[0].script.end_time, scene_of(text).tools[0].script.end_time);
}

TEST(LoadGltfTest, KeysOfABodyReachTheDescription) {
  GltfBuilder builder = good_scene();
  builder.node("cube")["extras"] = {
      {"torsion_role", "elastic"},        {"torsion_youngs_modulus", 2e4},
      {"torsion_poisson_ratio", 0.3},     {"torsion_density", 900},
      {"torsion_static_friction", 0.9},   {"torsion_dynamic_friction", 0.4},
      {"torsion_contact_model", "paper"}, {"torsion_body_model", "none"},
      {"torsion_tolerance", 0.01},        {"torsion_region_threshold", 0.002},
      {"torsion_shape", "box"},           {"torsion_fixed", "bottom_face"}};
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_EQ(scene_of(loaded).bodies.size(), 1U);
  const BodyDescription& body = scene_of(loaded).bodies[0];
  EXPECT_EQ(body.elasticity.youngs_modulus, 2e4);
  EXPECT_EQ(body.elasticity.poisson_ratio, 0.3);
  EXPECT_EQ(body.elasticity.density, 900.0);
  EXPECT_EQ(body.friction.static_friction, 0.9);
  EXPECT_EQ(body.friction.dynamic_friction, 0.4);
  EXPECT_EQ(body.models.contact, ContactModel::kPaper);
  EXPECT_EQ(body.models.body, BodyModel::kNone);
  EXPECT_EQ(body.models.tolerance, 0.01);
  EXPECT_EQ(body.models.region_threshold, 0.002);
  EXPECT_EQ(body.parts[0].shape.kind, ShapeKind::kBox);
  expect_near(body.parts[0].shape.half_extent, glm::dvec3(0.05), kFloatError);
  EXPECT_EQ(body.fixed.kind, FixedKind::kFace);
}

TEST(LoadGltfTest, KeysOfTheSceneSayHowAWindowShowsIt) {
  GltfBuilder builder = good_scene();
  const SceneView usual = scene_of(load_text(builder.text())).view;
  EXPECT_TRUE(usual.loop);
  EXPECT_EQ(usual.speed, 1.0);
  EXPECT_EQ(usual.colors, "");
  builder.document["scenes"][0]["extras"] = {
      {"torsion_title", "A title"}, {"torsion_caption", "Look here."}, {"torsion_loop", 0},
      {"torsion_speed", 0.2},       {"torsion_colors", "twist"},       {"torsion_stick_slip", true},
      {"torsion_lines", false}};
  const SceneView view = scene_of(load_text(builder.text())).view;
  EXPECT_EQ(view.title, "A title");
  EXPECT_EQ(view.caption, "Look here.");
  EXPECT_FALSE(view.loop);
  EXPECT_EQ(view.speed, 0.2);
  EXPECT_EQ(view.colors, "twist");
  EXPECT_TRUE(view.stick_slip);
  EXPECT_TRUE(usual.lines);
  EXPECT_FALSE(view.lines);
}

// A cube and a ball that are nodes with two keys each.
GltfBuilder meshless_scene() {
  GltfBuilder builder = good_scene();
  builder.node("cube").erase("mesh");
  builder.node("cube")["scale"] = {2.0, 1.0, 1.0};
  builder.node("cube")["extras"] = {
      {"torsion_role", "elastic"}, {"torsion_shape", "box"}, {"torsion_size", {0.1, 0.1, 0.12}}};
  builder.node("block").erase("mesh");
  builder.node("block")["extras"] = {
      {"torsion_role", "tool"}, {"torsion_shape", "sphere"}, {"torsion_size", {0.02, 0.02, 0.02}}};
  return builder;
}

TEST(LoadGltfTest, ShapesOfASizeNeedNoMesh) {
  const LoadedScene loaded = load_text(meshless_scene().text());
  ASSERT_EQ(scene_of(loaded).bodies.size(), 1U);
  const BodyDescription& body = scene_of(loaded).bodies[0];
  ASSERT_EQ(body.parts.size(), 1U);
  EXPECT_EQ(body.parts[0].shape.kind, ShapeKind::kBox);
  expect_near(body.parts[0].shape.half_extent, {0.1, 0.05, 0.06}, 1e-12);
  const ToolDescription& tool = scene_of(loaded).tools[0];
  EXPECT_EQ(tool.parts[0].shape.kind, ShapeKind::kSphere);
  EXPECT_EQ(tool.parts[0].shape.half_extent.x, 0.01);
  EXPECT_NE(body.draw.materials[0].color, tool.draw.materials[0].color);
}

TEST(LoadGltfTest, AShapeWithoutAMeshDrawsWhatIsFelt) {
  const LoadedScene loaded = load_text(meshless_scene().text());
  const DrawMesh& box = scene_of(loaded).bodies[0].draw;
  ASSERT_FALSE(box.triangles.empty());
  ASSERT_EQ(box.normals.size(), box.positions.size());
  for (std::size_t i = 0; i < box.positions.size(); ++i) {
    // On the face that its normal says: edges are sharp.
    const glm::vec3 on_face = box.positions[i] / glm::vec3(0.1F, 0.05F, 0.06F);
    EXPECT_NEAR(glm::dot(on_face, box.normals[i]), 1.0, 1e-6);
    const glm::vec3 size = glm::abs(box.normals[i]);
    EXPECT_NEAR(std::max({size.x, size.y, size.z}), 1.0, 1e-6);
  }
  const DrawMesh& ball = scene_of(loaded).tools[0].draw;
  for (std::size_t i = 0; i < ball.positions.size(); ++i) {
    EXPECT_NEAR(glm::length(ball.positions[i]), 0.01, 1e-8);
    EXPECT_GT(glm::dot(ball.normals[i], glm::normalize(ball.positions[i])), 0.999F);
  }
}

TEST(LoadGltfTest, PartsBelowAToolNeedNoMeshEither) {
  GltfBuilder builder = meshless_scene();
  const int handle = builder.add_node(
      {{"name", "handle"},
       {"translation", {0.0, 0.03, 0.0}},
       {"extras", {{"torsion_shape", "cylinder"}, {"torsion_size", {0.01, 0.05, 0.01}}}}});
  builder.put_below(handle, 1);
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_EQ(scene_of(loaded).tools.size(), 1U);
  const ToolDescription& tool = scene_of(loaded).tools[0];
  ASSERT_EQ(tool.parts.size(), 2U);
  EXPECT_EQ(tool.parts[1].shape.kind, ShapeKind::kCylinder);
  expect_near(tool.parts[1].shape.pose.position, {0.0, 0.03, 0.0}, 1e-12);
}

TEST(LoadGltfTest, StiffnessAsAWholeNumberAbove32BitsIsReadInFull) {
  GltfBuilder builder = good_scene();
  builder.node("cube")["extras"]["torsion_youngs_modulus"] = 200'000'000'000;
  for (const std::string& file : {builder.text(), builder.glb()}) {
    const LoadedScene loaded = load_text(file);
    ASSERT_EQ(scene_of(loaded).bodies.size(), 1U);
    EXPECT_EQ(scene_of(loaded).bodies[0].elasticity.youngs_modulus, 2e11);
  }
}

TEST(LoadGltfTest, OneFrictionCoefficientAloneHoldsForBoth) {
  GltfBuilder builder = good_scene();
  builder.node("cube")["extras"]["torsion_dynamic_friction"] = 0.9;
  const LoadedScene dynamic = load_text(builder.text());
  ASSERT_EQ(scene_of(dynamic).bodies.size(), 1U);
  EXPECT_EQ(scene_of(dynamic).bodies[0].friction.static_friction, 0.9);
  builder.node("cube")["extras"].erase("torsion_dynamic_friction");
  builder.node("cube")["extras"]["torsion_static_friction"] = 0.2;
  const LoadedScene lower = load_text(builder.text());
  ASSERT_EQ(scene_of(lower).bodies.size(), 1U);
  EXPECT_EQ(scene_of(lower).bodies[0].friction.dynamic_friction, 0.2);
}

TEST(LoadGltfTest, NodeScaleGoesIntoTheMeshAndNotIntoTheFrame) {
  GltfBuilder builder = good_scene();
  builder.node("cube")["scale"] = {2.0, 1.0, 0.5};
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_EQ(scene_of(loaded).bodies.size(), 1U);
  const BodyDescription& body = scene_of(loaded).bodies[0];
  expect_near(body.pose.position, {0.0, 0.05, 0.0}, kFloatError);
  EXPECT_NEAR(body.pose.rotation.w, 1.0, 1e-12);
  glm::dvec3 highest(0.0);
  for (const glm::dvec3& position : body.parts[0].surface.positions) {
    highest = glm::max(highest, position);
  }
  expect_near(highest, {0.1, 0.05, 0.025}, kFloatError);
}

TEST(LoadGltfTest, MeshesBelowAToolAreItsParts) {
  GltfBuilder builder = good_scene();
  const int mesh = builder.add_mesh(box_mesh(glm::dvec3(0.01)));
  const int grip =
      builder.add_node({{"name", "grip"},
                        {"mesh", mesh},
                        {"translation", {0.0, 0.03, 0.0}},
                        {"extras", {{"torsion_shape", "sphere"}, {"torsion_draw", "mesh"}}}});
  builder.put_below(grip, 1);
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_EQ(scene_of(loaded).tools.size(), 1U);
  const ToolDescription& tool = scene_of(loaded).tools[0];
  ASSERT_EQ(tool.parts.size(), 2U);
  EXPECT_EQ(tool.parts[0].shape.kind, ShapeKind::kMesh);
  EXPECT_EQ(tool.parts[1].node, "grip");
  EXPECT_EQ(tool.parts[1].shape.kind, ShapeKind::kSphere);
  expect_near(tool.parts[1].shape.pose.position, {0.0, 0.03, 0.0}, kFloatError);
  EXPECT_EQ(tool.draw.positions.size(), 16U);
}

TEST(LoadGltfTest, ToolHasTheMassPropertiesOfASolidBox) {
  GltfBuilder builder = good_scene();
  builder.node("block")["extras"]["torsion_mass"] = 2.0;
  builder.node("block")["scale"] = {1.0, 2.0, 3.0};
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_EQ(scene_of(loaded).tools.size(), 1U);
  const MassProperties& mass = scene_of(loaded).tools[0].mass;
  EXPECT_EQ(mass.mass, 2.0);
  expect_near(mass.center, glm::dvec3(0.0), kFloatError);
  // A cuboid of edges a, b, c: I_xx = m (b^2 + c^2) / 12. Edges are floats, exact within 1e-7.
  const glm::dvec3 edge(0.02, 0.04, 0.06);
  for (int i = 0; i < 3; ++i) {
    const double b = edge[(i + 1) % 3];
    const double c = edge[(i + 2) % 3];
    const double expected = 2.0 * (b * b + c * c) / 12.0;
    EXPECT_NEAR(mass.inertia[i][i], expected, 1e-6 * expected);
    EXPECT_NEAR(mass.inertia[i][(i + 1) % 3], 0.0, 1e-6 * expected);
  }
}

TEST(LoadGltfTest, CenterOfMassIsInTheScaledNodeFrame) {
  GltfBuilder builder = good_scene();
  builder.node("block")["extras"]["torsion_center_of_mass"] = {0.001, 0.0, 0.0};
  builder.node("block")["scale"] = {2.0, 2.0, 2.0};
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_EQ(scene_of(loaded).tools.size(), 1U);
  expect_near(scene_of(loaded).tools[0].mass.center, {0.002, 0.0, 0.0}, 1e-12);
}

TEST(LoadGltfTest, PhysicsExtensionGivesMassAndFrictionWhereKeysDoNot) {
  GltfBuilder builder = good_scene();
  builder.document["extensionsUsed"] = {"KHR_physics_rigid_bodies"};
  builder.document["extensions"]["KHR_physics_rigid_bodies"]["physicsMaterials"] = {
      {{"staticFriction", 0.6}, {"dynamicFriction", 0.5}}};
  builder.node("block")["extensions"]["KHR_physics_rigid_bodies"]["motion"] = {{"mass", 3.5}};
  builder.node("cube")["extensions"]["KHR_physics_rigid_bodies"]["collider"] = {
      {"physicsMaterial", 0}};
  builder.node("cube")["extras"]["torsion_dynamic_friction"] = 0.25;
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_EQ(scene_of(loaded).bodies.size(), 1U);
  EXPECT_EQ(scene_of(loaded).tools[0].mass.mass, 3.5);
  EXPECT_EQ(scene_of(loaded).bodies[0].friction.static_friction, 0.6);
  EXPECT_EQ(scene_of(loaded).bodies[0].friction.dynamic_friction, 0.25);
}

TEST(LoadGltfTest, OpenMeshIsFineWhereAnExactShapeIsFelt) {
  GltfBuilder builder = good_scene();
  builder.document["accessors"][1]["count"] = 30;  // without the face at z = +0.05
  builder.node("cube")["extras"]["torsion_shape"] = "box";
  builder.node("cube")["extras"]["torsion_draw"] = "mesh";
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_EQ(scene_of(loaded).bodies.size(), 1U);
  EXPECT_EQ(scene_of(loaded).bodies[0].draw.triangles.size(), 10U);
  expect_near(scene_of(loaded).bodies[0].parts[0].shape.half_extent, glm::dvec3(0.05), kFloatError);
}

TEST(LoadGltfTest, FaultOfAMeshIsSaidOnceWhateverTheShape) {
  GltfBuilder builder = good_scene();
  nlohmann::json& primitives = builder.document["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["mode"] = 1;
  builder.node("cube")["extras"]["torsion_shape"] = "box";
  EXPECT_EQ(load_text(builder.text()).problems.size(), 1U);
}

TEST(LoadGltfTest, CameraIsReadWithItsPlaceInTheTree) {
  GltfBuilder builder = good_scene();
  builder.document["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
  const int camera = builder.add_node({{"name", "eye"}, {"camera", 0}});
  const int arm = builder.add_node({{"translation", {0.0, 0.0, 2.0}}});
  builder.put_below(camera, arm);
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_EQ(scene_of(loaded).cameras.size(), 1U);
  const CameraDescription& eye = scene_of(loaded).cameras[0];
  EXPECT_EQ(eye.node, "eye");
  EXPECT_EQ(eye.vertical_field_of_view, 0.5);
  EXPECT_EQ(eye.near_plane, 0.1);
  EXPECT_EQ(eye.far_plane, 0.0);
  expect_near(eye.pose.position, {0.0, 0.0, 2.0}, 1e-12);
}

TEST(LoadGltfTest, EveryFaultOfAFileIsListedAtOnce) {
  GltfBuilder builder = good_scene();
  builder.node("cube")["extras"]["torsion_youngs_modulus"] = -1.0;
  builder.node("cube")["extras"]["torsion_densty"] = 1000.0;
  builder.node("block")["extras"]["torsion_mass"] = "heavy";
  builder.document.erase("animations");
  const LoadedScene loaded = load_text(builder.text());
  EXPECT_FALSE(loaded.scene.has_value());
  EXPECT_EQ(loaded.problems.size(), 4U) << to_text(loaded.problems);
}

TEST(LoadGltfTest, ABodyThatTurnsUnderAToolIsAToolThatTurnsTheOtherWay) {
  // The block stands still while the cube turns by 90 degrees about y.
  const float half = std::sqrt(0.5F);
  test::GltfBuilder turns = test::good_scene();
  turns.document.erase("animations");
  turns.node("block")["translation"] = {0.02, 0.105, 0.0};
  turns.add_motion(0, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, half, 0, half});
  const LoadedScene turning = test::load_text(turns.text());
  ASSERT_TRUE(turning.scene) << to_text(turning.problems);
  const auto poses = expected_poses(*turning.scene);
  ASSERT_FALSE(poses.empty());
  // In the world it stands still, which is what a camera is to see.
  const Pose in_world = scripted_poses(*turning.scene).back()[0];
  EXPECT_LT(glm::length(in_world.position - glm::dvec3(0.02, 0.105, 0.0)), 1e-7);
  const Pose& last = poses.back()[0];
  EXPECT_LT(glm::length(last.position - glm::dvec3(0.0, 0.105, 0.02)), 1e-7);
  EXPECT_NEAR(last.rotation.y, -std::sqrt(0.5), 1e-7);
  // Of two bodies of which one moves there is no such way.
  const int mesh = turns.add_mesh(test::box_mesh(glm::dvec3(0.01)));
  turns.add_node({{"name", "other"},
                  {"mesh", mesh},
                  {"translation", {1.0, 0.0, 0.0}},
                  {"extras", {{"torsion_role", "elastic"}}}});
  const LoadedScene two = test::load_text(turns.text());
  ASSERT_TRUE(two.scene) << to_text(two.problems);
  EXPECT_TRUE(expected_poses(*two.scene).empty());
}

TEST(LoadGltfTest, AnAnimationMayMoveABody) {
  test::GltfBuilder builder = test::good_scene();
  builder.add_motion(0, "translation", {0.0F, 4.0F}, {0.0F, 0.05F, 0.0F, 0.0F, 0.09F, 0.0F});
  const LoadedScene loaded = test::load_text(builder.text());
  ASSERT_TRUE(loaded.scene) << to_text(loaded.problems);
  const BodyDescription& body = loaded.scene->bodies[0];
  EXPECT_EQ(loaded.scene->duration, 4.0);
  EXPECT_LT(glm::length(scripted_pose(body.script, 1.0).position - glm::dvec3(0.0, 0.06, 0.0)),
            1e-8);
  // The tool's way as the body sees it, from where that is at rest.
  const auto poses = expected_poses(*loaded.scene);
  ASSERT_FALSE(poses.empty());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double time = 4.0 * static_cast<double>(i) / static_cast<double>(poses.size() - 1);
    const glm::dvec3 wanted = body.pose.position +
                              scripted_pose(loaded.scene->tools[0].script, time).position -
                              scripted_pose(body.script, time).position;
    EXPECT_LT(glm::length(poses[i][0].position - wanted), 1e-12) << time;
  }
  // One that nothing moves has no script.
  EXPECT_TRUE(test::load_text(test::good_scene().text()).scene->bodies[0].script.links.empty());
}

}  // namespace
}  // namespace torsion::engine::test
