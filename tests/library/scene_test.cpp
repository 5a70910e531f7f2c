// What other programs can make of scenes, and what they are told where they are wrong.

#include <gtest/gtest.h>

#include "tests/library/library_scenes.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/studies.hpp"

namespace torsion::test {
namespace {

/// What build() says of a scene that it refuses.
std::string refusal(const Scene& scene, const Options& options = {}) {
  const Result<std::shared_ptr<const Model>> model = build(scene, options);
  return model ? "" : model.error().message;
}

/// Whether a text has all of the words.
bool says(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* const word : words) {
    if (text.find(word) == std::string::npos) {
      ADD_FAILURE() << "no " << word << " in: " << text;
      return false;
    }
  }
  return true;
}

TEST(LibrarySceneTest, NumbersOutOfRangeAreNamedWithTheirPlace) {
  Scene scene = ball_on_pad("mdr");
  scene.bodies[0].material.youngs_modulus = -1.0;
  scene.bodies[0].material.poisson_ratio = 0.6;
  scene.tools[0].mass = 0.0;
  const std::string text = refusal(scene);
  says(text, {"body \"pad\"", "youngs_modulus is -1", "a number above 0 (Pa)",
              "poisson_ratio is 0.6", "tool \"ball\"", "mass is 0"});
}

TEST(LibrarySceneTest, ShapesThatCannotBeAreRefused) {
  Scene scene = ball_on_pad("mdr");
  scene.tools[0].parts[0].size = {0.02, 0.03, 0.02};
  says(refusal(scene), {"tool \"ball\", part 0", "three equal extents"});
  scene.tools[0].parts = {make_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}})};
  says(refusal(scene), {"tool \"ball\", part 0"});
  scene.tools[0].parts = {make_mesh({{{0, 0, 0}}, {{0, 1, 2}}})};
  says(refusal(scene), {"mesh.triangles", "rows below 1"});
  scene.tools.clear();
  says(refusal(scene), {"tools", "at least one"});
  scene = ball_on_pad("mdr");
  scene.bodies[0].parts.clear();
  says(refusal(scene), {"body \"pad\"", "parts", "at least one part"});
  scene = ball_on_pad("mdr");
  scene.tools[0].parts[0].pose.orientation = {1.0, 1.0, 0.0, 0.0};
  says(refusal(scene), {"pose", "length 1"});
}

TEST(LibrarySceneTest, ModelsThatAreNotThereAreRefused) {
  says(refusal(ball_on_pad("rubber")), {"contact_model is \"rubber\""});
  Options options;
  options.body_model = "bones";
  says(refusal(ball_on_pad("mdr"), options), {"body_model is \"bones\""});
  options = {};
  options.expected_poses = {{{}, {}}};
  says(refusal(ball_on_pad("mdr"), options), {"expected_poses", "2 poses", "1 tools"});
}

TEST(LibrarySceneTest, AFileThatIsNotThereIsSaidAsTheProgramSaysIt) {
  const Result<Scene> scene = load_scene("nowhere.gltf");
  ASSERT_FALSE(scene);
  says(scene.error().message, {"nowhere.gltf"});
}

TEST(LibrarySceneTest, AFilesMaterialsMayBeChanged) {
  Result<Scene> loaded = load_scene(engine::test::shipped_scene("ball_on_cube"));
  ASSERT_TRUE(loaded) << loaded.error().message;
  Scene& scene = loaded.value();
  ASSERT_EQ(scene.bodies.size(), 1U);
  ASSERT_EQ(scene.tools.size(), 1U);
  EXPECT_GT(scene.duration, 0.0);
  EXPECT_EQ(scene.body("nobody"), nullptr);
  Body* const cube = scene.body(scene.bodies[0].name);
  ASSERT_NE(cube, nullptr);
  cube->contact_model = "mdr";
  cube->body_model = "none";
  const double modulus = cube->material.youngs_modulus;
  std::vector<double> forces;
  for (const double factor : {1.0, 2.0}) {
    cube->material.youngs_modulus = factor * modulus;
    Simulation simulation = simulation_of(scene);
    EXPECT_EQ(simulation.model().contact_model(0), "mdr");
    double largest = 0.0;
    while (simulation.time() < scene.duration) {
      const Pose pose = animated_pose(scene, 0, simulation.time());
      simulation.step({&pose, 1});
      largest = std::max(largest, length(simulation.wrench(0).force));
    }
    forces.push_back(largest);
  }
  // The motion is imposed: every force goes with the modulus.
  EXPECT_NEAR(forces[1], 2.0 * forces[0], 1e-6 * forces[1]);
}

TEST(LibrarySceneTest, AFilesBodyMovesAsItsAnimationSaysAndNowhereElse) {
  Result<Scene> loaded =
      load_scene(engine::test::source_folder() + "/tests/library/rising_pad.gltf");
  ASSERT_TRUE(loaded) << loaded.error().message;
  Scene& scene = loaded.value();
  EXPECT_EQ(scene.duration, 1.0);
  // The pad comes up under a ball that stands still, by 1 mm from 0.5 mm below it.
  Options options;
  options.body_model = engine::test::kSanitized ? "none" : "auto";
  Simulation simulation = simulation_of(scene, options);
  const Pose still = animated_pose(scene, 0, 0.0);
  std::vector<double> forces;
  while (simulation.time() < scene.duration) {
    simulation.step({&still, 1});
    forces.push_back(length(simulation.wrench(0).force));
  }
  EXPECT_EQ(forces[forces.size() / 4], 0.0);
  EXPECT_GT(forces.back(), 0.1);
  scene.bodies[0].pose.position[0] += 0.01;
  says(refusal(scene), {"pose", "animation moves the body"});
}

TEST(LibrarySceneTest, AFilesBodyMayBeMovedAndHeldElsewhere) {
  Result<Scene> loaded = load_scene(engine::test::shipped_scene("ball_on_cube_soft"));
  ASSERT_TRUE(loaded) << loaded.error().message;
  Scene scene = loaded.value();
  const auto largest_force = [](const Scene& of, double lower) {
    Options options;
    options.contact_model = "mdr";
    options.body_model = "skeleton";
    Simulation simulation = simulation_of(of, options);
    double largest = 0.0;
    while (simulation.time() < of.duration) {
      Pose pose = animated_pose(of, 0, simulation.time());
      pose.position[1] -= lower;
      simulation.step({&pose, 1});
      largest = std::max(largest, length(simulation.wrench(0).force));
    }
    return largest;
  };
  const double as_in_file = largest_force(scene, 0.0);
  EXPECT_GT(as_in_file, 0.0);
  scene.bodies[0].pose.position[1] -= 0.5;
  EXPECT_NEAR(largest_force(scene, 0.5), as_in_file, 1e-6 * as_in_file);
  scene.bodies[0].pose.orientation = {2.0, 0.0, 0.0, 0.0};
  says(refusal(scene), {"pose", "length 1"});
  scene = loaded.value();
  scene.bodies[0].fixed = Fixed::kVolumes;
  says(refusal(scene), {"fixed_volumes", "at least one"});
  scene.bodies[0].fixed_volumes = {{FixedVolume::Kind::kBox, {10.0, 10.0, 10.0}, {}}};
  EXPECT_EQ(refusal(scene), "");
  Scene made = ball_on_pad("mdr");
  made.bodies[0].fixed = Fixed::kAsInFile;
  says(refusal(made), {"fixed", "no file describes"});
}

}  // namespace
}  // namespace torsion::test
