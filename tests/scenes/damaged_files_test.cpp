// Thousands of damaged files, the same in every run: each is either a good scene or has problems,
// and none crashes, hangs, throws or, under sanitizers, reads beyond its buffers.

#include <random>

#include <gtest/gtest.h>

#include "scenes/load_gltf.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

using nlohmann::json;

/// A whole number below `count`, the same on every machine (distributions of the library differ).
std::size_t pick(std::mt19937& random, std::size_t count) {
  return random() % count;
}

GltfBuilder rich_scene() {
  GltfBuilder scene = good_scene();
  scene.document["materials"] = {{{"name", "rubber"}, {"extras", {{"torsion_density", 900}}}}};
  scene.document["meshes"][0]["primitives"][0]["material"] = 0;
  scene.document["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
  scene.add_node({{"name", "eye"}, {"camera", 0}});
  scene.put_below(scene.add_node({{"name", "pin"},
                                  {"translation", {0.0, -0.05, 0.0}},
                                  {"scale", {0.1, 0.01, 0.1}},
                                  {"extras", {{"torsion_role", "fixed_box"}}}}),
                  0);
  const int places = scene.add_view(std::string(1, '\0'));
  const int values = scene.add_view(std::string(scene.bytes(), 0, 12));
  scene.document["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", places}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  scene.add_motion(1, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 1, 0, 0});
  return scene;
}

void expect_verdict(const LoadedScene& loaded, const std::string& what) {
  EXPECT_NE(loaded.scene.has_value(), !loaded.problems.empty()) << what;
}

TEST(DamagedFilesTest, SceneThatIsDamagedIsGoodToBeginWith) {
  const LoadedScene loaded = load_text(rich_scene().text());
  EXPECT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
}

TEST(DamagedFilesTest, ChangedBytesOfABinaryFileGetAVerdict) {
  const TestFolder folder;
  const std::string whole = rich_scene().glb();
  std::mt19937 random(1);
  for (int run = 0; run < 2000; ++run) {
    std::string damaged = whole;
    for (std::size_t change = 0; change <= pick(random, 4); ++change) {
      damaged[pick(random, damaged.size())] = static_cast<char>(pick(random, 256));
    }
    expect_verdict(load_gltf(folder.write("a.glb", damaged)), "run " + std::to_string(run));
  }
}

TEST(DamagedFilesTest, RemovedAndDoubledStretchesGetAVerdict) {
  const TestFolder folder;
  const std::string whole = rich_scene().text();
  std::mt19937 random(2);
  for (int run = 0; run < 1000; ++run) {
    std::string damaged = whole;
    const std::size_t at = pick(random, damaged.size());
    const std::size_t length = pick(random, 40);
    if (run % 2 == 0) {
      damaged.erase(at, length);
    } else {
      damaged.insert(at, std::string(damaged, at, length));
    }
    expect_verdict(load_gltf(folder.write("a.gltf", damaged)), "run " + std::to_string(run));
  }
}

/// Every value of the document, the deepest last.
void list_values(json& value, std::vector<json*>& list) {
  list.push_back(&value);
  if (value.is_structured()) {
    for (json& member : value) {
      list_values(member, list);
    }
  }
}

TEST(DamagedFilesTest, EveryValueReplacedByEveryOddOneGetsAVerdict) {
  const TestFolder folder;
  const std::vector<json> odd = {nullptr,
                                 true,
                                 "",
                                 "x",
                                 json::array(),
                                 json::object(),
                                 -1,
                                 0,
                                 1,
                                 3,
                                 4294967296,
                                 9223372036854775807,
                                 18446744073709551615U,
                                 -1.5,
                                 1e308,
                                 json::array({0, 0, 0}),
                                 json::array({json::object()})};
  const GltfBuilder good = rich_scene();
  json document = good.document;
  std::vector<json*> values;
  list_values(document, values);
#ifdef TORSION_SANITIZED
  constexpr std::size_t kStride = 3;
#else
  constexpr std::size_t kStride = 1;
#endif
  for (std::size_t i = 0; i < values.size(); i += kStride) {
    const json kept = *values[i];
    for (const json& replacement : odd) {
      *values[i] = replacement;
      GltfBuilder damaged = good;
      damaged.document = document;
      // Without accessors or with a document that is no object there is nothing to add buffers to.
      const std::string text = document.is_object() ? damaged.text() : document.dump();
      expect_verdict(load_gltf(folder.write("a.gltf", text)), "value " + std::to_string(i) + " " +
                                                                  kept.dump().substr(0, 60) +
                                                                  " -> " + replacement.dump());
    }
    *values[i] = kept;
    // Members that the value had are new ones now.
    values.clear();
    list_values(document, values);
  }
}

}  // namespace
}  // namespace torsion::engine::test
