// Variants of a scene share tables; what they compute is as if each were prepared alone.

#include "app/scene_variants.hpp"

#include <thread>

#include <gtest/gtest.h>

#include "app/session.hpp"
#include "device/scripted_motion.hpp"
#include "ecs/hash.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

using test::shipped_scene;
using test::source_folder;

constexpr double kRate = 200.0;        // Hz
constexpr std::uint64_t kSteps = 400;  // 2 s: in contact, turning

struct VariantCase {
  const char* scene;
  ContactModel contact;
  BodyModel body;
  std::vector<std::string> settings;
};

PrepareOptions options_for(const VariantCase& each, const SceneDescription& scene) {
  PrepareOptions options;
  options.rate = kRate;
  options.contact_model = each.contact;
  options.body_model = each.body;
  options.threads = 1;
  options.expected_poses = expected_poses(scene);
  return options;
}

std::uint64_t hash_after_run(Session& session) {
  for (std::uint64_t step = 0; step < kSteps; ++step) {
    step_scripted(session);
  }
  EXPECT_GT(session.simulation.world.state.regions.size(), 0U);
  return hash(session.simulation.world);
}

std::uint64_t hash_of_variant(const SceneVariants& variants,
                              const std::vector<std::string>& settings) {
  Result<SceneVariant> variant = variants.make(settings);
  EXPECT_TRUE(variant) << variant.error().text;
  Session session;
  session.scene = std::move(variant.value().scene);
  session.simulation = std::move(variant.value().simulation);
  session.tool_poses.resize(session.scene.tools.size());
  return hash_after_run(session);
}

TEST(SceneVariantsTest, AVariantHasTheBitsOfASceneOfItsOwn) {
  const std::vector<std::string> cube = {"cube.youngs_modulus=7e5", "cube.friction=0.4",
                                         "cube.density=900", "ball.mass=0.3"};
  const std::vector<std::string> falling = {"cube.static_friction=0.9",
                                            "cube.dynamic_friction=0.5"};
  const std::vector<std::string> tables = {"cube.poisson_ratio=0.4", "cube.youngs_modulus=2e6"};
  for (const VariantCase& each : std::vector<VariantCase>{
           {"ball_on_cube", ContactModel::kMdr, BodyModel::kNone, cube},
           {"ball_on_cube", ContactModel::kPatch, BodyModel::kCompliance, cube},
           {"ball_on_cube", ContactModel::kPaper, BodyModel::kSkeleton, cube},
           {"ball_on_cube", ContactModel::kWinkler, BodyModel::kNone, falling},
           {"ball_on_cube", ContactModel::kMdr, BodyModel::kCompliance, tables},
           {"ball_on_cube_soft", ContactModel::kAuto, BodyModel::kAuto, falling},
           {"blender/knob_on_pad.glb",
            ContactModel::kAuto,
            BodyModel::kAuto,
            {"pad.youngs_modulus=1e5", "pad.friction=1.2"}}}) {
    SCOPED_TRACE(std::string(each.scene) + " " + each.settings[0]);
    const std::string path = std::string(each.scene).ends_with(".glb")
                                 ? source_folder() + "/scenes/" + each.scene
                                 : shipped_scene(each.scene);
    Result<Session> opened = open_scene(path);
    ASSERT_TRUE(opened) << opened.error().text;
    const PrepareOptions options = options_for(each, opened.value().scene);
    const SceneVariants variants(opened.value().scene, options);
    Result<Session> alone = open_session(path, options, true, each.settings);
    ASSERT_TRUE(alone) << alone.error().text;
    const std::uint64_t expected = hash_after_run(alone.value());
    // Others before it, at the same time, and once more.
    EXPECT_NE(hash_of_variant(variants, {}), expected);
    std::uint64_t beside = 0;
    std::thread other([&] { beside = hash_of_variant(variants, each.settings); });
    EXPECT_EQ(hash_of_variant(variants, each.settings), expected);
    other.join();
    EXPECT_EQ(beside, expected);
  }
}

TEST(SceneVariantsTest, MoreTablesThanAreKeptAreMadeAgain) {
  Result<Session> opened = open_scene(shipped_scene("ball_on_cube"));
  ASSERT_TRUE(opened) << opened.error().text;
  const SceneVariants variants(
      opened.value().scene,
      options_for({"", ContactModel::kMdr, BodyModel::kNone, {}}, opened.value().scene));
  const std::uint64_t first = hash_of_variant(variants, {"cube.poisson_ratio=0.1"});
  for (int k = 0; k < 12; ++k) {
    const auto made = variants.make(
        std::vector<std::string>{"cube.poisson_ratio=" + std::to_string(0.2 + 0.02 * k)});
    EXPECT_TRUE(made) << made.error().text;
  }
  EXPECT_EQ(hash_of_variant(variants, {"cube.poisson_ratio=0.1"}), first);
}

TEST(SceneVariantsTest, WhatCannotBeIsAnError) {
  Result<Session> opened = open_scene(shipped_scene("ball_on_cube"));
  ASSERT_TRUE(opened) << opened.error().text;
  const SceneVariants variants(opened.value().scene, {});
  const auto made = variants.make(std::vector<std::string>{"cube.youngs_modulus=-1"});
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().text.find("a number above 0"), std::string::npos) << made.error().text;
}

}  // namespace
}  // namespace torsion::engine
