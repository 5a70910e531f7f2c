#include "scenes/add_physics.hpp"

#include <string>

#include <gtest/gtest.h>

#include "device/scripted_motion.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine {
namespace {

using nlohmann::json;
using test::GltfBuilder;

/// Somebody's file: a cube and a block, without a word of physics.
GltfBuilder asset() {
  GltfBuilder builder = test::good_scene();
  builder.document.erase("animations");
  for (json& node : builder.document["nodes"]) {
    node.erase("extras");
  }
  return builder;
}

Result<PhysicsAdded> add_to(const GltfBuilder& builder, const PhysicsToAdd& add,
                            bool binary = false) {
  const test::TestFolder folder;
  const std::filesystem::path file = binary ? folder.write("asset.glb", builder.glb())
                                            : folder.write("asset.gltf", builder.text());
  return with_physics(file, add, binary);
}

TEST(AddPhysicsTest, ABallStandsAboveTheHighestPlaceAndPressesAndTurns) {
  for (const bool binary : {false, true}) {
    const Result<PhysicsAdded> added = add_to(asset(), {"cube", "", ""}, binary);
    ASSERT_TRUE(added.ok()) << added.error().text;
    const LoadedScene loaded =
        test::load_text(added.value().bytes, binary ? "scene.glb" : "scene.gltf");
    ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
    ASSERT_EQ(loaded.scene->bodies.size(), 1U);
    EXPECT_EQ(loaded.scene->bodies[0].node, "cube");
    EXPECT_EQ(loaded.scene->bodies[0].elasticity.youngs_modulus, 1e5);
    EXPECT_EQ(loaded.scene->bodies[0].fixed.kind, FixedKind::kFace);
    ASSERT_EQ(loaded.scene->tools.size(), 1U);
    const ToolDescription& ball = loaded.scene->tools[0];
    ASSERT_EQ(ball.parts.size(), 1U);
    EXPECT_EQ(ball.parts[0].shape.kind, ShapeKind::kSphere);
    const double radius = ball.parts[0].shape.half_extent.x;
    EXPECT_NEAR(radius, 0.15 * 0.1, 1e-9);  // of the cube's edge
    // The cube's top is at 0.1 m, over its middle.
    const Pose start = scripted_pose(ball.script, 0.0);
    EXPECT_NEAR(start.position.x, 0.0, 1e-7);
    EXPECT_NEAR(start.position.y, 0.1 + 1.05 * radius, 1e-7);
    EXPECT_NEAR(scripted_pose(ball.script, 1.0).position.y, 0.1 + 0.75 * radius, 1e-7);
    EXPECT_EQ(loaded.scene->duration, 5.0);
    EXPECT_EQ(added.value().assumed.size(), 2U);
  }
}

TEST(AddPhysicsTest, NodesThatAreThereBecomeBodyAndTool) {
  const Result<PhysicsAdded> added = add_to(asset(), {"cube", "block", "box"});
  ASSERT_TRUE(added.ok()) << added.error().text;
  const LoadedScene loaded = test::load_text(added.value().bytes);
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  EXPECT_EQ(loaded.scene->bodies[0].parts[0].shape.kind, ShapeKind::kBox);
  EXPECT_EQ(loaded.scene->tools[0].node, "block");
  EXPECT_EQ(loaded.scene->tools[0].device, "mouse");  // nothing animates it
}

TEST(AddPhysicsTest, WhatThereWasStays) {
  GltfBuilder builder = asset();
  builder.node("cube")["extras"] = {{"author", "somebody"}};
  const Result<PhysicsAdded> added = add_to(builder, {"cube", "", ""});
  ASSERT_TRUE(added.ok());
  const json file = json::parse(added.value().bytes);
  ASSERT_EQ(file["nodes"].size(), builder.document["nodes"].size() + 1);
  EXPECT_EQ(file["nodes"][0]["extras"]["author"], "somebody");
  EXPECT_EQ(file["meshes"].size(), builder.document["meshes"].size());
}

TEST(AddPhysicsTest, OneMeshNeedsNoName) {
  GltfBuilder builder = asset();
  builder.node("block").erase("mesh");
  EXPECT_TRUE(add_to(builder, {}).ok());
}

TEST(AddPhysicsTest, SaysWhichNodesThereAre) {
  const auto error = [](const PhysicsToAdd& add) {
    const Result<PhysicsAdded> added = add_to(asset(), add);
    return added.ok() ? "" : added.error().text;
  };
  for (const std::string& text :
       {error({}), error({"duck", "", ""}), error({"cube", "duck", ""})}) {
    EXPECT_NE(text.find("\"cube\", \"block\""), std::string::npos) << text;
  }
  EXPECT_NE(error({}).find("--body"), std::string::npos);
  EXPECT_NE(error({"cube", "duck", ""}).find("no node is named \"duck\""), std::string::npos);
}

TEST(AddPhysicsTest, ANodeWithoutASolidIsNoBody) {
  GltfBuilder builder = asset();
  builder.node("cube")["scale"] = {1.0, 0.0, 1.0};
  const Result<PhysicsAdded> added = add_to(builder, {"cube", "", ""});
  ASSERT_FALSE(added.ok());
  EXPECT_NE(added.error().text.find("node \"cube\" has no solid mesh"), std::string::npos)
      << added.error().text;
}

}  // namespace
}  // namespace torsion::engine
