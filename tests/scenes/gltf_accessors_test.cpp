#include "scenes/gltf_accessors.hpp"

#include <gtest/gtest.h>

#include "scenes/gltf_file.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

using nlohmann::json;

/// A file that holds one accessor, checked.
tinygltf::Model model_with(GltfBuilder& builder, const json& accessor) {
  builder.document["accessors"] = json::array({accessor});
  const TestFolder folder;
  std::vector<Problem> found;
  auto model = read_gltf_file(folder.write("a.gltf", builder.text()), found);
  EXPECT_TRUE(model.has_value()) << to_text(found);
  return model ? std::move(*model) : tinygltf::Model{};
}

template <class T>
std::vector<double> scalars(const std::vector<T>& values, int component_type, bool normalized) {
  GltfBuilder builder;
  const int view = builder.add_view(bytes_of(values));
  return read_numbers(model_with(builder, {{"bufferView", view},
                                           {"componentType", component_type},
                                           {"normalized", normalized},
                                           {"count", values.size()},
                                           {"type", "SCALAR"}}),
                      0);
}

TEST(GltfAccessorsTest, EveryComponentTypeIsReadAsItsNumber) {
  using Numbers = std::vector<double>;
  EXPECT_EQ(scalars<std::int8_t>({-128, 127}, 5120, false), (Numbers{-128, 127}));
  EXPECT_EQ(scalars<std::uint8_t>({0, 255}, 5121, false), (Numbers{0, 255}));
  EXPECT_EQ(scalars<std::int16_t>({-32768, 32767}, 5122, false), (Numbers{-32768, 32767}));
  EXPECT_EQ(scalars<std::uint16_t>({0, 65535}, 5123, false), (Numbers{0, 65535}));
  EXPECT_EQ(scalars<std::uint32_t>({0, 4294967295U}, 5125, false), (Numbers{0, 4294967295.0}));
  EXPECT_EQ(scalars<float>({-0.5F, 1e30F}, 5126, false),
            (Numbers{-0.5, static_cast<double>(1e30F)}));
}

TEST(GltfAccessorsTest, NormalisedIntegersGoFromMinusOneToOne) {
  // glTF 2.0, 3.6.2.2: f = max(c / 127, -1), c / 255, max(c / 32767, -1), c / 65535.
  using Numbers = std::vector<double>;
  EXPECT_EQ(scalars<std::int8_t>({-128, -127, 127}, 5120, true), (Numbers{-1, -1, 1}));
  EXPECT_EQ(scalars<std::uint8_t>({0, 51, 255}, 5121, true), (Numbers{0, 0.2, 1}));
  EXPECT_EQ(scalars<std::int16_t>({-32768, -32767, 32767}, 5122, true), (Numbers{-1, -1, 1}));
  EXPECT_EQ(scalars<std::uint16_t>({0, 13107, 65535}, 5123, true), (Numbers{0, 0.2, 1}));
}

TEST(GltfAccessorsTest, StridesAndOffsetsPassOverWhatLiesBetween) {
  GltfBuilder builder;
  const int view =
      builder.add_view(bytes_of<float>({9, 9, 9, 9, 1, 2, 3, 9, 9, 4, 5, 6, 9, 9, 7, 8, 10}));
  builder.document["bufferViews"][0]["byteStride"] = 20;
  const auto model = model_with(builder, {{"bufferView", view},
                                          {"byteOffset", 16},
                                          {"componentType", 5126},
                                          {"count", 3},
                                          {"type", "VEC3"}});
  EXPECT_EQ(read_numbers(model, 0), (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 10}));
}

TEST(GltfAccessorsTest, WithoutABufferViewEverythingIsZero) {
  GltfBuilder builder;
  const auto model = model_with(builder, {{"componentType", 5126}, {"count", 2}, {"type", "VEC3"}});
  EXPECT_EQ(read_numbers(model, 0), std::vector<double>(6, 0.0));
}

TEST(GltfAccessorsTest, SparseValuesReplaceThoseBelow) {
  for (const bool has_base : {true, false}) {
    GltfBuilder builder;
    const int base = builder.add_view(bytes_of<float>({1, 2, 3, 4, 5, 6, 7, 8, 9}));
    const int places = builder.add_view(bytes_of<std::uint16_t>({0, 2}));
    const int values = builder.add_view(bytes_of<float>({10, 20, 30, 70, 80, 90}));
    json accessor = {{"componentType", 5126},
                     {"count", 3},
                     {"type", "VEC3"},
                     {"sparse",
                      {{"count", 2},
                       {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}}}};
    if (has_base) {
      accessor["bufferView"] = base;
    }
    const auto model = model_with(builder, accessor);
    const std::vector<double> expected = has_base
                                             ? std::vector<double>{10, 20, 30, 4, 5, 6, 70, 80, 90}
                                             : std::vector<double>{10, 20, 30, 0, 0, 0, 70, 80, 90};
    EXPECT_EQ(read_numbers(model, 0), expected);
    EXPECT_EQ(read_sparse_indices(model, 0), (std::vector<std::uint32_t>{0, 2}));
  }
}

TEST(GltfAccessorsTest, IndicesOfEveryWidthAreRead) {
  GltfBuilder builder;
  const int view = builder.add_view(bytes_of<std::uint8_t>({3, 1, 2, 250}));
  const auto model = model_with(
      builder, {{"bufferView", view}, {"componentType", 5121}, {"count", 4}, {"type", "SCALAR"}});
  EXPECT_EQ(read_indices(model, 0), (std::vector<std::uint32_t>{3, 1, 2, 250}));
}

TEST(GltfAccessorsTest, SparsePositionsReachTheBody) {
  GltfBuilder scene = good_scene();
  // The cube's corner 7 (+,+,+) is drawn out to 0.08 m along x, 0.05 along the others.
  const int places = scene.add_view(bytes_of<std::uint8_t>({7}));
  const int values = scene.add_view(bytes_of<float>({0.08F, 0.05F, 0.05F}));
  scene.document["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", places}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  const LoadedScene loaded = load_text(scene.text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  double highest = 0.0;
  for (const glm::dvec3& position : loaded.scene->bodies[0].parts[0].surface.positions) {
    highest = std::max(highest, position.x);
  }
  EXPECT_NEAR(highest, 0.08, 1e-8);
}

TEST(GltfAccessorsTest, QuantisedPositionsReachTheBody) {
  GltfBuilder scene = good_scene();
  std::vector<std::int16_t> corners;
  for (const glm::dvec3& corner : box_mesh(glm::dvec3(32767.0)).positions) {
    for (int i = 0; i < 3; ++i) {
      corners.push_back(static_cast<std::int16_t>(corner[i]));
    }
    corners.push_back(0);  // rows are a multiple of 4 bytes
  }
  const int view = scene.add_view(bytes_of(corners));
  scene.document["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 8;
  json& accessor = scene.document["accessors"][0];
  accessor["bufferView"] = view;
  accessor["componentType"] = 5122;
  accessor["normalized"] = true;
  scene.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  scene.document["extensionsUsed"] = {"KHR_mesh_quantization"};
  scene.node("cube")["scale"] = {0.05, 0.05, 0.05};
  const LoadedScene loaded = load_text(scene.text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  for (const glm::dvec3& position : loaded.scene->bodies[0].parts[0].surface.positions) {
    EXPECT_NEAR(std::abs(position.x), 0.05, 1e-12);
  }
  // Without the extension's name they are not glTF: who wrote them may mean something else.
  scene.document.erase("extensionsRequired");
  scene.document.erase("extensionsUsed");
  const LoadedScene refused = load_text(scene.text());
  ASSERT_FALSE(refused.scene.has_value());
  EXPECT_NE(to_text(refused.problems).find("KHR_mesh_quantization"), std::string::npos);
}

}  // namespace
}  // namespace torsion::engine::test
