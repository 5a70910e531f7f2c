// What `check` says of scenes that are legal and will disappoint.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.hpp"
#include "tests/scenes/gltf_builder.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

using nlohmann::json;
using test::Folder;
using test::Ran;
using test::read_text;
using test::run_torsion;
using test::scene;
using test::write_text;

/// The warnings of a scene; its exit code is 0.
std::vector<std::string> warnings_of(const test::GltfBuilder& builder,
                                     std::vector<std::string> options = {}) {
  const Folder folder;
  write_text(folder / "scene.gltf", builder.text());
  std::vector<std::string> words{"check", folder / "scene.gltf", "--json"};
  words.insert(words.end(), options.begin(), options.end());
  const Ran ran = run_torsion(words);
  EXPECT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  return json::parse(ran.out)["warnings"].get<std::vector<std::string>>();
}

bool any_says(const std::vector<std::string>& warnings, const std::string& words) {
  return std::ranges::any_of(warnings, [&](const std::string& warning) {
    return warning.find(words) != std::string::npos;
  });
}

/// A ball of so many meridians around the origin.
SurfaceMesh ball_mesh(double radius, std::uint32_t meridians) {
  SurfaceMesh ball;
  const std::uint32_t circles = meridians / 2;
  ball.positions.push_back({0.0, radius, 0.0});
  for (std::uint32_t i = 1; i < circles; ++i) {
    for (std::uint32_t j = 0; j < meridians; ++j) {
      const double polar = std::numbers::pi * i / circles;
      const double around = 2.0 * std::numbers::pi * j / meridians;
      ball.positions.push_back(radius * glm::dvec3(std::sin(polar) * std::sin(around),
                                                   std::cos(polar),
                                                   std::sin(polar) * std::cos(around)));
    }
  }
  ball.positions.push_back({0.0, -radius, 0.0});
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return i == 0         ? 0U
           : i == circles ? 1 + (circles - 1) * meridians
                          : 1 + (i - 1) * meridians + j % meridians;
  };
  for (std::uint32_t i = 0; i < circles; ++i) {
    for (std::uint32_t j = 0; j < meridians; ++j) {
      if (i + 1 < circles) {
        ball.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      }
      if (i > 0) {
        ball.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  return ball;
}

/// The cube of good_scene and a ball of 20 mm that comes down to `lowest` [m], its centre's height.
test::GltfBuilder ball_scene(double lowest, std::uint32_t meridians) {
  test::GltfBuilder builder = test::good_scene();
  builder.node("block")["mesh"] = builder.add_mesh(ball_mesh(0.02, meridians));
  builder.document["animations"] = json::array();
  builder.add_motion(1, "translation", {0.0F, 1.0F},
                     {0.0F, 0.13F, 0.0F, 0.0F, static_cast<float>(lowest), 0.0F});
  return builder;
}

/// The JSON blocks of the manual's page on scenes, in order.
std::vector<std::string> scenes_of_the_manual() {
  const std::string page = read_text(test::source_folder() + "/docs/scenes.md");
  const std::string begin = "```json\n";
  std::vector<std::string> scenes;
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at)) {
    at += begin.size();
    scenes.push_back(page.substr(at, page.find("```", at) - at));
  }
  return scenes;
}

TEST(CheckWarningTest, TheSmallestScenesOfTheManualRunAsTheyStandThere) {
  const std::vector<std::string> scenes = scenes_of_the_manual();
  ASSERT_EQ(scenes.size(), 2U);
  const Folder folder;
  const std::string file = folder / "small.gltf";
  for (const std::string& scene : scenes) {
    write_text(file, scene);
    const Ran check = run_torsion({"check", file});
    ASSERT_EQ(check.exit_code, 0) << check.out;
    EXPECT_NE(check.out.find("no problems\n"), std::string::npos) << check.out;
    const Ran ran = run_torsion({"simulate", file, "--seconds", "3"});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_EQ(ran.out.find("FAULTS"), std::string::npos) << ran.out;
    // Hertz at 1 mm: 4/3 E* sqrt(R d) d = 23.9 N; the body deflects by some percent of it.
    EXPECT_NE(ran.out.find("largest force 22."), std::string::npos) << ran.out;
  }
}

// But for the bar on two cubes, whose contact is longer than any number of cells is measured for.
TEST(CheckWarningTest, ShippedScenesHaveNone) {
  for (const char* name : {"ball_on_cube", "ball_on_cube_soft", "compass_on_ellipsoid_soft",
                           "mallet_on_ellipsoid", "many_regions", "two_bodies"}) {
    const Ran ran = run_torsion({"check", scene(name), "--body-model", "none", "--json"});
    for (const json& warning : json::parse(ran.out)["warnings"]) {
      EXPECT_EQ(std::string(name), "two_bodies") << warning;
      EXPECT_NE(warning.get<std::string>().find("more than torsion_tolerance"), std::string::npos)
          << warning;
    }
  }
}

TEST(CheckWarningTest, AToolThatNeverTouchesIsNamedWithHowNearItComes) {
  const auto warnings = warnings_of(ball_scene(0.125, 48));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(
      any_says(warnings, "tool \"block\" never touches anything on its way: it comes within 5"))
      << warnings[0];
  EXPECT_TRUE(any_says(warnings, "of \"cube\"")) << warnings[0];
}

TEST(CheckWarningTest, FacetsLongerThanTheContactAreSaid) {
  // 1 mm deep: the overlap's radius is 6.2 mm; 12 meridians make facets of 10 mm, 160 of 0.8 mm.
  EXPECT_TRUE(
      any_says(warnings_of(ball_scene(0.119, 12)), "\"block\" is a round surface of facets"));
  EXPECT_FALSE(any_says(warnings_of(ball_scene(0.119, 160)), "facets"));
}

TEST(CheckWarningTest, AnExactShapeThatIsDrawnAsAnotherIsSaid) {
  test::GltfBuilder builder = test::good_scene();
  builder.node("block")["extras"]["torsion_shape"] = "sphere";
  EXPECT_FALSE(any_says(warnings_of(builder), "drawn as another"));
  builder.node("block")["extras"]["torsion_draw"] = "mesh";  // a cube
  EXPECT_TRUE(
      any_says(warnings_of(builder), "\"block\" is felt as an exact shape but drawn as another"));
  test::GltfBuilder same = test::good_scene();
  same.node("block")["extras"]["torsion_shape"] = "box";
  EXPECT_FALSE(any_says(warnings_of(same), "drawn as another"));
}

TEST(CheckWarningTest, ATextureThatCannotBeDrawnIsSaid) {
  const auto warnings_with = [](const nlohmann::json& image, const nlohmann::json& texture) {
    test::GltfBuilder builder = test::good_scene();
    builder.document["images"] = {image};
    builder.document["textures"] = {texture};
    builder.document["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    return warnings_of(builder);
  };
  const nlohmann::json first = {{"source", 0}};
  const auto cut = warnings_with({{"uri", "data:image/png;base64,iVBORw0KGgo="}}, first);
  EXPECT_TRUE(
      any_says(cut, "\"cube\" is drawn without its texture \"images[0]\": it is a damaged PNG"));
  EXPECT_FALSE(any_says(cut, "\"block\" is drawn"));
  const auto missing = warnings_with({{"uri", "nowhere.png"}}, first);
  EXPECT_TRUE(any_says(missing, "its texture \"nowhere.png\": its file is missing or empty"));
  const auto of_extension = warnings_with({{"uri", "nowhere.png"}}, nlohmann::json::object());
  EXPECT_TRUE(any_says(of_extension, "its texture \"textures[0]\": its image is of an extension"));
  const auto good = warnings_with(
      {{"uri",
        "data:image/"
        "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmM"
        "IQAAAABJRU5ErkJggg=="}},
      first);
  EXPECT_FALSE(any_says(good, "texture"));
}

TEST(CheckWarningTest, AToleranceThatIsNotReachedIsSaid) {
  test::GltfBuilder builder = ball_scene(0.119, 160);
  builder.node("cube")["extras"]["torsion_tolerance"] = 0.001;
  EXPECT_TRUE(any_says(warnings_of(builder), "more than torsion_tolerance (0.1 %)"));
  builder.node("cube")["extras"]["torsion_tolerance"] = 0.01;
  EXPECT_FALSE(any_says(warnings_of(builder), "torsion_tolerance"));
  EXPECT_TRUE(any_says(warnings_of(builder, {"--cells", "30"}), "cells a side are fewer than"));
}

}  // namespace
}  // namespace torsion::engine
