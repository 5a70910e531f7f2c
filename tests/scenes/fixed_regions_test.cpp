#include "scenes/fixed_regions.hpp"

#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

constexpr double kFloatTolerance = 1e-8;  // m: positions of about 0.1 m are floats

BodyDescription body_of(const GltfBuilder& scene) {
  const LoadedScene loaded = load_text(scene.text());
  EXPECT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  return loaded.scene ? loaded.scene->bodies.at(0) : BodyDescription{};
}

void add_fixed_node(GltfBuilder& scene, const nlohmann::json& place, const char* role) {
  nlohmann::json node = place;
  node["name"] = "pin";
  node["extras"] = {{"torsion_role", role}};
  scene.put_below(scene.add_node(node), 0);
}

/// Of the cube's 8 vertices those for which `is_held`.
template <class Predicate>
void expect_held(const BodyDescription& body, const Predicate& is_held) {
  ASSERT_EQ(body.draw.fixed.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(body.draw.fixed[i], is_held(glm::dvec3(body.draw.positions[i]))) << i;
  }
}

void expect_near(const glm::dvec3& is, const glm::dvec3& expected) {
  EXPECT_LE(glm::distance(is, expected), kFloatTolerance) << is.x << ' ' << is.y << ' ' << is.z;
}

bool holds(const FixedVolume& volume, const glm::dvec3& point) {
  const glm::dvec3 unit = volume.to_unit * (point - volume.center);
  return volume.kind == VolumeKind::kSphere
             ? glm::length(unit) <= 1.0
             : std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)}) <= 1.0;
}

TEST(FixedRegionsTest, BottomCenterIsThePointBelowTheMiddle) {
  const BodyDescription body = body_of(good_scene());
  EXPECT_EQ(body.fixed.kind, FixedKind::kPoint);
  expect_near(body.fixed.point, {0.0, -0.05, 0.0});
  expect_held(body, [](const glm::dvec3&) { return false; });
}

TEST(FixedRegionsTest, BottomFaceHoldsItsVertices) {
  GltfBuilder scene = good_scene();
  scene.node("cube")["extras"]["torsion_fixed"] = "bottom_face";
  const BodyDescription body = body_of(scene);
  EXPECT_EQ(body.fixed.kind, FixedKind::kFace);
  expect_near(body.fixed.point, {0.0, -0.05, 0.0});
  expect_near(body.fixed.normal, {0.0, 1.0, 0.0});
  expect_held(body, [](const glm::dvec3& p) { return p.y < 0.0; });
}

TEST(FixedRegionsTest, BottomIsThatOfTheWorldWhenTheBodyLiesOnItsSide) {
  GltfBuilder scene = good_scene();
  const double root = std::sqrt(0.5);
  scene.node("cube")["rotation"] = {0.0, 0.0, root, root};  // a quarter about z: x goes up
  scene.node("cube")["extras"]["torsion_fixed"] = "bottom_face";
  const BodyDescription body = body_of(scene);
  expect_near(body.fixed.point, {-0.05, 0.0, 0.0});
  expect_near(body.fixed.normal, {1.0, 0.0, 0.0});
  expect_held(body, [](const glm::dvec3& p) { return p.x < 0.0; });
}

TEST(FixedRegionsTest, FixedPointIsWhereItsNodeIs) {
  GltfBuilder scene = good_scene();
  scene.node("cube")["scale"] = {2.0, 1.0, 1.0};
  add_fixed_node(scene, {{"translation", {0.01, 0.02, 0.03}}}, "fixed_point");
  const BodyDescription body = body_of(scene);
  EXPECT_EQ(body.fixed.kind, FixedKind::kPoint);
  expect_near(body.fixed.point, {0.02, 0.02, 0.03});  // below the body's scale
}

TEST(FixedRegionsTest, FixedBoxHoldsWhatLiesInItsImageOfTheUnitBox) {
  GltfBuilder scene = good_scene();
  // A plate around the cube's side at x = -0.05, turned a quarter about z.
  const double root = std::sqrt(0.5);
  add_fixed_node(scene,
                 {{"translation", {-0.05, 0.0, 0.0}},
                  {"rotation", {0.0, 0.0, root, root}},
                  {"scale", {0.06, 0.01, 0.06}}},
                 "fixed_box");
  const BodyDescription body = body_of(scene);
  EXPECT_EQ(body.fixed.kind, FixedKind::kVolumes);
  ASSERT_EQ(body.fixed_volumes.size(), 1U);
  EXPECT_EQ(body.fixed.volumes.first, 0U);
  EXPECT_EQ(body.fixed.volumes.count, 1U);
  expect_near(body.fixed.point, {-0.05, 0.0, 0.0});
  expect_held(body, [](const glm::dvec3& p) { return p.x < 0.0; });
  const FixedVolume& volume = body.fixed_volumes[0];
  EXPECT_TRUE(holds(volume, {-0.041, 0.059, 0.0}));
  EXPECT_FALSE(holds(volume, {-0.039, 0.0, 0.0}));
  EXPECT_FALSE(holds(volume, {-0.05, 0.061, 0.0}));
}

TEST(FixedRegionsTest, FixedSphereHoldsWhatLiesInItsImageOfTheUnitSphere) {
  GltfBuilder scene = good_scene();
  add_fixed_node(scene, {{"translation", {0.05, 0.05, 0.05}}, {"scale", {0.02, 0.03, 0.02}}},
                 "fixed_sphere");
  const BodyDescription body = body_of(scene);
  ASSERT_EQ(body.fixed_volumes.size(), 1U);
  EXPECT_EQ(body.fixed_volumes[0].kind, VolumeKind::kSphere);
  expect_near(body.fixed.point, glm::dvec3(0.05));
  expect_held(body, [](const glm::dvec3& p) { return p.x > 0.0 && p.y > 0.0 && p.z > 0.0; });
  EXPECT_TRUE(holds(body.fixed_volumes[0], {0.05, 0.079, 0.05}));
  EXPECT_FALSE(holds(body.fixed_volumes[0], {0.071, 0.05, 0.05}));
}

TEST(FixedRegionsTest, SeveralVolumesHoldTogether) {
  GltfBuilder scene = good_scene();
  for (const double x : {-0.05, 0.05}) {
    add_fixed_node(scene, {{"translation", {x, -0.05, 0.05}}, {"scale", {0.01, 0.01, 0.01}}},
                   "fixed_box");
  }
  const BodyDescription body = body_of(scene);
  EXPECT_EQ(body.fixed.volumes.count, 2U);
  expect_near(body.fixed.point, {0.0, -0.05, 0.05});
  expect_held(body, [](const glm::dvec3& p) { return p.y < 0.0 && p.z > 0.0; });
}

TEST(FixedRegionsTest, FixedPointBesideVolumesMovesTheirPoint) {
  GltfBuilder scene = good_scene();
  add_fixed_node(scene, {{"translation", {0.05, 0.05, 0.05}}, {"scale", {0.01, 0.01, 0.01}}},
                 "fixed_box");
  add_fixed_node(scene, {{"translation", {0.01, 0.0, 0.0}}}, "fixed_point");
  const BodyDescription body = body_of(scene);
  EXPECT_EQ(body.fixed.kind, FixedKind::kVolumes);
  expect_near(body.fixed.point, {0.01, 0.0, 0.0});
}

TEST(FixedRegionsTest, MarkedVerticesAreHeld) {
  GltfBuilder scene = good_scene();
  // Corners of box_mesh(): bit 1 is x, bit 2 is y, bit 4 is z; the side at +x is marked.
  const int marks = scene.add_floats({0, 1, 0, 1, 0, 1, 0, 1}, "SCALAR");
  scene.document["meshes"][0]["primitives"][0]["attributes"]["__FIXED"] = marks;
  scene.node("cube")["extras"]["torsion_fixed"] = "attribute";
  const BodyDescription body = body_of(scene);
  EXPECT_EQ(body.fixed.kind, FixedKind::kVolumes);
  expect_near(body.fixed.point, {0.05, 0.0, 0.0});
  expect_held(body, [](const glm::dvec3& p) { return p.x > 0.0; });
  ASSERT_EQ(body.fixed_volumes.size(), 1U);
  for (const glm::dvec3& p : body.parts[0].surface.positions) {
    EXPECT_EQ(holds(body.fixed_volumes[0], p), p.x > 0.0);
  }
}

TEST(FixedRegionsTest, MarksThatNothingAsksForHoldNothing) {
  GltfBuilder scene = good_scene();
  const int marks = scene.add_floats({1, 1, 1, 1, 1, 1, 1, 1}, "SCALAR");
  scene.document["meshes"][0]["primitives"][0]["attributes"]["_FIXED"] = marks;
  expect_held(body_of(scene), [](const glm::dvec3&) { return false; });
}

std::string problems_of_pins(const GltfBuilder& scene) {
  const LoadedScene loaded = load_text(scene.text());
  EXPECT_FALSE(loaded.scene.has_value());
  return to_text(loaded.problems);
}

TEST(FixedRegionsTest, NodesThatWouldDoNothingAreRefused) {
  GltfBuilder scene = good_scene();
  scene.node("cube")["extras"]["torsion_fixed"] = "bottom_face";
  add_fixed_node(scene, {}, "fixed_point");
  const std::string text = problems_of_pins(scene);
  EXPECT_NE(text.find("would do nothing"), std::string::npos) << text;
}

TEST(FixedRegionsTest, ChildrenThatAreNotThereAreMissed) {
  GltfBuilder scene = good_scene();
  scene.node("cube")["extras"]["torsion_fixed"] = "children";
  const std::string text = problems_of_pins(scene);
  EXPECT_NE(text.find("fixed_point, fixed_box or fixed_sphere"), std::string::npos) << text;
}

TEST(FixedRegionsTest, SecondFixedPointIsRefused) {
  GltfBuilder scene = good_scene();
  add_fixed_node(scene, {{"translation", {0.0, 0.0, 0.0}}}, "fixed_point");
  add_fixed_node(scene, {{"translation", {0.01, 0.0, 0.0}}}, "fixed_point");
  const std::string text = problems_of_pins(scene);
  EXPECT_NE(text.find("this is the second"), std::string::npos) << text;
}

TEST(FixedRegionsTest, FlatVolumeIsRefused) {
  GltfBuilder scene = good_scene();
  add_fixed_node(scene, {{"scale", {0.1, 0.0, 0.1}}}, "fixed_box");
  const std::string text = problems_of_pins(scene);
  EXPECT_NE(text.find("no extent along one axis"), std::string::npos) << text;
}

TEST(FixedRegionsTest, SmallVolumeIsNotFlat) {
  // A tenth of a micrometre along each axis is an odd pin, but it has an extent.
  GltfBuilder scene = good_scene();
  add_fixed_node(scene, {{"translation", {0.05, 0.05, 0.05}}, {"scale", {1e-7, 1e-7, 1e-7}}},
                 "fixed_sphere");
  expect_held(body_of(scene),
              [](const glm::dvec3& p) { return p.x > 0.0 && p.y > 0.0 && p.z > 0.0; });
}

}  // namespace
}  // namespace torsion::engine::test
