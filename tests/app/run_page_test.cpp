// The page that plays a run, in headless Chromium without a network.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/image_io.hpp"
#include "tests/app/browser.hpp"
#include "tests/app/program.hpp"
#include "tests/app/window_pictures.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine {
namespace {

using test::chromium;
using test::Folder;
using test::read_text;
using test::run_torsion;

/// A ball of 10 mm that is pressed 3 mm into a cube within a second. Its words are as bad as they
/// can be for a page.
std::string write_scene(const Folder& folder) {
  test::GltfBuilder builder = test::good_scene();
  builder.node("block")["extras"]["torsion_shape"] = "sphere";
  builder.document.erase("animations");
  builder.add_motion(1, "translation", {0.0F, 1.0F}, {0.0F, 0.11F, 0.0F, 0.0F, 0.107F, 0.0F});
  builder.document["scenes"][0]["extras"] = {
      {"torsion_title", "</script><b id='broken'>%DATA%"},
      {"torsion_caption", "<img src=x onerror='document.title=1'>"}};
  test::write_text(folder / "scene.gltf", builder.text());
  return folder / "scene.gltf";
}

TEST(RunPageTest, PlaysInABrowserWithoutANetwork) {
  const Folder folder;
  const std::string page = folder / "run.html";
  const test::Ran ran =
      run_torsion({"export", write_scene(folder), "--animate", "--fps", "4", "--out", page});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  // Nothing turns the ball: what its torque is of rounding must not fill a scale. A contact of a
  // ball of 10 mm pressed 3 mm deep is wider than 3 mm, and scales end at most 2.5 times above what
  // they hold.
  const std::string text = read_text(page);
  const auto number = [&text](const std::string& key) {
    const std::size_t at = text.find('"' + key + "\":");
    return at == std::string::npos ? 0.0 : std::stod(text.substr(at + key.size() + 3));
  };
  EXPECT_GT(number("full_force"), 0.1);
  EXPECT_GT(number("full_torque"), 0.01 * number("full_force") / 2.5 * 3e-3);
  // What it is once its scripts have run.
  ASSERT_EQ(chromium(folder, "--dump-dom", page, folder / "dom"), 0)
      << read_text(folder / "chromium.log");
  const std::string dom = read_text(folder / "dom");
  EXPECT_EQ(dom.find("id=\"broken\""), std::string::npos);
  EXPECT_EQ(dom.find("data-fault="), std::string::npos);
  const std::size_t at = dom.find("data-triangles=\"");
  ASSERT_NE(at, std::string::npos) << read_text(folder / "chromium.log");
  // The cube alone has more: a body of eight corners is cut for its dent.
  EXPECT_GT(std::stoi(dom.substr(at + 16)), 2000);
  EXPECT_NE(dom.find("<h1>&lt;/script&gt;"), std::string::npos);

  // Before the contact and at its deepest.
  for (const std::string moment : {"0", "1"}) {
    ASSERT_EQ(chromium(folder, "--screenshot=" + (folder / (moment + ".png")), page + "#" + moment,
                       folder / "out"),
              0);
  }
  const Result<Image> before = read_png(folder / "0.png");
  const Result<Image> pressed = read_png(folder / "1.png");
  ASSERT_TRUE(before && pressed);
  ASSERT_EQ(pressed.value().width, 640U);
  // The ball has come down, and the arrow of its force is there.
  EXPECT_GT(test::changed(before.value(), pressed.value(), 200, 100, 440, 340), 0.01);
}

/// The mean colour of a square in the middle of the cube's front, as its page shows it.
std::array<double, 3> cube_color(const Folder& folder, const std::string& page) {
  EXPECT_EQ(chromium(folder, "--screenshot=" + (folder / "shot.png"), page + "#0", folder / "out"),
            0);
  const Result<Image> shot = read_png(folder / "shot.png");
  std::array<double, 3> sums{};
  if (!shot) {
    return sums;
  }
  constexpr std::uint32_t kSide = 16;
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      const std::size_t pixel = std::size_t{210 + row} * shot.value().width + 312 + column;
      for (std::size_t lane = 0; lane < 3; ++lane) {
        sums[lane] += shot.value().rgba[4 * pixel + lane] / double{kSide * kSide};
      }
    }
  }
  return sums;
}

TEST(RunPageTest, ShowsMaterialsWithTheirTexturesWhereTheSceneDoes) {
  const Folder folder;
  test::GltfBuilder builder = test::good_scene();
  nlohmann::json& primitive = builder.document["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = builder.add_floats(std::vector<float>(16, 0.5F), "VEC2");
  primitive["material"] = 0;
  // Blue times white with a little red: only the texture is blue.
  const Image blue{1, 1, {30, 30, 250, 255}};
  ASSERT_TRUE(write_png(blue, folder / "blue.png"));
  builder.document["images"] = {{{"uri", "blue.png"}}};
  builder.document["textures"] = {{{"source", 0}}};
  builder.document["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0.0}}}}};
  builder.document["scenes"][0]["extras"] = {{"torsion_colors", "material"},
                                             {"torsion_lines", false}};
  test::write_text(folder / "scene.gltf", builder.text());
  const test::Ran ran = run_torsion({"export", folder / "scene.gltf", "--animate", "--fps", "4",
                                     "--seconds", "0.25", "--out", folder / "run.html"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto material = cube_color(folder, folder / "run.html");
  EXPECT_GT(material[2],
            2.0 * material[0]);  // the palette's middle, where nothing is twisted, is grey
}

TEST(RunPageTest, IsOfARunNotOfAMoment) {
  const Folder folder;
  const test::Ran ran =
      run_torsion({"export", write_scene(folder), "--at", "0.5", "--out", folder / "run.html"});
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_NE(ran.err.find("with --animate in .html"), std::string::npos) << ran.err;
}

// simulate's page is export's of the same moments, to the byte, and what it keeps is no part of the
// run.
TEST(RunPageTest, SimulateWritesThePageThatExportWrites) {
  const Folder folder;
  const std::string scene = write_scene(folder);
  const test::Ran plain = run_torsion({"simulate", scene, "--json"});
  const test::Ran paged =
      run_torsion({"simulate", scene, "--json", "--html", folder / "simulated.html"});
  ASSERT_EQ(paged.exit_code, 0) << paged.err;
  const auto hash = [](const std::string& json) {
    return json.substr(json.find("\"world_hash\""), 40);
  };
  EXPECT_EQ(hash(paged.out), hash(plain.out));
  EXPECT_NE(paged.out.find("simulated.html"), std::string::npos);
  // A second has 40 moments; its last step begins at 0.999 s.
  const test::Ran exported = run_torsion({"export", scene, "--animate", "--fps", "40", "--seconds",
                                          "0.975", "--out", folder / "exported.html"});
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_TRUE(read_text(folder / "simulated.html") == read_text(folder / "exported.html"));
  const test::Ran none =
      run_torsion({"simulate", scene, "--seconds", "0", "--html", folder / "none.html"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("nothing to show"), std::string::npos) << none.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "none.html"));
}

}  // namespace
}  // namespace torsion::engine
