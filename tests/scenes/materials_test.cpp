#include "scenes/materials.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "scenes/write_gltf.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

using nlohmann::json;

/// The good scene with a texture on its body.
GltfBuilder textured_scene() {
  GltfBuilder builder = good_scene();
  const std::vector<float> uv = {0, 0, 1, 0, 0, 1, 1, 1, 0.5F, 0, 0, 0.5F, 0.5F, 1, 1, 0.5F};
  json& primitive = builder.document["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = builder.add_floats(uv, "VEC2");
  primitive["material"] = 0;
  builder.document["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
  builder.document["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  builder.document["textures"] = {{{"source", 0}, {"sampler", 0}}};
  builder.document["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}}},
         {"metallicFactor", 0.25},
         {"roughnessFactor", 0.75}}},
       {"alphaMode", "BLEND"},
       {"extensions",
        {{"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.4}}}}}}};
  return builder;
}

/// Of the body's first material.
std::shared_ptr<const EncodedImage> image_of(const LoadedScene& loaded, TextureRole role) {
  return loaded.scene->bodies[0].draw.materials[0].texture(role).image;
}

std::shared_ptr<const EncodedImage> base_image(const LoadedScene& loaded) {
  return image_of(loaded, TextureRole::kBaseColor);
}

TEST(MaterialsTest, AllThatIsDrawnIsRead) {
  const LoadedScene loaded = load_text(textured_scene().text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  const DrawMesh& draw = loaded.scene->bodies[0].draw;
  ASSERT_EQ(draw.materials.size(), 1U);
  const DrawMaterial& material = draw.materials[0];
  EXPECT_EQ(material.metallic, 0.25F);
  EXPECT_EQ(material.roughness, 0.75F);
  EXPECT_EQ(material.scattering, 0.4F);
  EXPECT_EQ(material.alpha_mode, AlphaMode::kBlend);
  const MaterialTexture& base = material.texture(TextureRole::kBaseColor);
  EXPECT_EQ(base.wrap_u, TextureWrap::kClamp);
  EXPECT_EQ(base.wrap_v, TextureWrap::kMirror);
  ASSERT_TRUE(base.image);
  EXPECT_EQ(base.image->bytes,
            (std::vector<unsigned char>{0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A}));
  ASSERT_EQ(draw.texcoords.size(), draw.positions.size());
  EXPECT_EQ(draw.texcoords[1], glm::vec2(1.0F, 0.0F));
  EXPECT_EQ(draw.texcoords[4], glm::vec2(0.5F, 0.0F));
  EXPECT_EQ(loaded.scene->tools[0].draw.materials[0].alpha_mode, AlphaMode::kUnsaid);
}

/// The textured scene with all five textures, of two images.
GltfBuilder fully_textured_scene() {
  GltfBuilder builder = textured_scene();
  builder.document["images"].push_back(
      {{"uri", "data:image/jpeg;base64,/9j/"}, {"name", "second"}});
  builder.document["textures"].push_back({{"source", 1}});
  json& material = builder.document["materials"][0];
  material["alphaMode"] = "MASK";
  material["alphaCutoff"] = 0.25;
  material["doubleSided"] = true;
  material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 1}};
  material["normalTexture"] = {{"index", 1}, {"scale", 0.5}};
  material["occlusionTexture"] = {{"index", 1}, {"strength", 0.75}};
  material["emissiveTexture"] = {{"index", 0}};
  material["emissiveFactor"] = {0.25, 0.5, 1.0};
  return builder;
}

TEST(MaterialsTest, AllFiveTexturesAndWhatGoesWithThemAreRead) {
  const LoadedScene loaded = load_text(fully_textured_scene().text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  const DrawMaterial& material = loaded.scene->bodies[0].draw.materials[0];
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(material.alpha_cutoff, 0.25F);
  EXPECT_TRUE(material.double_sided);
  EXPECT_EQ(material.normal_scale, 0.5F);
  EXPECT_EQ(material.occlusion_strength, 0.75F);
  EXPECT_EQ(material.emission, glm::vec3(0.25F, 0.5F, 1.0F));
  for (const TextureRole role :
       {TextureRole::kMetalRoughness, TextureRole::kNormal, TextureRole::kOcclusion}) {
    ASSERT_TRUE(image_of(loaded, role));
    EXPECT_EQ(image_of(loaded, role)->bytes.front(), 0xFF);
    EXPECT_EQ(image_of(loaded, role), image_of(loaded, TextureRole::kNormal));
  }
  EXPECT_EQ(image_of(loaded, TextureRole::kEmission), base_image(loaded));
  EXPECT_EQ(loaded.scene->bodies[0].draw.texcoords.size(),
            loaded.scene->bodies[0].draw.positions.size());
}

TEST(MaterialsTest, AllOfItIsWritten) {
  const LoadedScene loaded = load_text(fully_textured_scene().text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  const DrawMesh& draw = loaded.scene->bodies[0].draw;
  WrittenMesh mesh;
  mesh.positions = draw.positions;
  mesh.normals = draw.normals;
  mesh.triangles = draw.triangles;
  mesh.texcoords = draw.texcoords;
  mesh.materials = draw.materials;
  const Result<std::string> bytes = gltf_bytes({mesh}, false);
  ASSERT_TRUE(bytes) << bytes.error().text;
  const json document = json::parse(bytes.value());
  EXPECT_EQ(document["images"].size(), 2U);
  const json& material = document["materials"][0];
  EXPECT_EQ(material["alphaMode"], "MASK");
  EXPECT_EQ(material["alphaCutoff"], 0.25);
  EXPECT_EQ(material["doubleSided"], true);
  EXPECT_EQ(material["normalTexture"]["scale"], 0.5);
  EXPECT_EQ(material["occlusionTexture"]["strength"], 0.75);
  EXPECT_EQ(material["emissiveFactor"], json({0.25, 0.5, 1.0}));
  const auto image_of_texture = [&](const json& reference) {
    return document["textures"][reference["index"].get<std::size_t>()]["source"].get<int>();
  };
  const int base = image_of_texture(material["pbrMetallicRoughness"]["baseColorTexture"]);
  EXPECT_EQ(image_of_texture(material["emissiveTexture"]), base);
  EXPECT_EQ(image_of_texture(material["pbrMetallicRoughness"]["metallicRoughnessTexture"]),
            1 - base);
  EXPECT_EQ(image_of_texture(material["normalTexture"]), 1 - base);
  EXPECT_EQ(image_of_texture(material["occlusionTexture"]), 1 - base);
}

TEST(MaterialsTest, ATextureWithOtherCoordinatesThanTheFirstIsNotDrawnAndSaysWhy) {
  GltfBuilder builder = fully_textured_scene();
  builder.document["materials"][0]["normalTexture"]["texCoord"] = 1;
  builder.document["materials"][0]["emissiveTexture"]["extensions"] = {
      {"KHR_texture_transform", {{"scale", {2.0, 2.0}}}}};
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  for (const TextureRole role : {TextureRole::kNormal, TextureRole::kEmission}) {
    ASSERT_TRUE(image_of(loaded, role));
    EXPECT_TRUE(image_of(loaded, role)->bytes.empty());
    EXPECT_NE(image_of(loaded, role)->fault.find("coordinates"), std::string::npos);
  }
  EXPECT_TRUE(image_of(loaded, TextureRole::kOcclusion)->fault.empty());
}

TEST(MaterialsTest, ANormalTextureAloneHasItsCoordinates) {
  GltfBuilder builder = fully_textured_scene();
  json& material = builder.document["materials"][0];
  material = {{"normalTexture", {{"index", 1}}}};
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  EXPECT_FALSE(base_image(loaded));
  EXPECT_EQ(loaded.scene->bodies[0].draw.texcoords.size(),
            loaded.scene->bodies[0].draw.positions.size());
}

TEST(MaterialsTest, ATransformOfTheTextureMovesItsCoordinates) {
  GltfBuilder builder = textured_scene();
  builder.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
      {"KHR_texture_transform",
       {{"offset", {0.1, 0.2}}, {"rotation", 1.5707963267948966}, {"scale", {2.0, 3.0}}}}};
  const LoadedScene loaded = load_text(builder.text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  const std::vector<glm::vec2>& uv = loaded.scene->bodies[0].draw.texcoords;
  // The extension's own words: offset (0.1, 0.2), counter-clockwise turn with v downwards.
  EXPECT_NEAR(uv[1].x, 0.1, 1e-6);
  EXPECT_NEAR(uv[1].y, 0.2 - 2.0, 1e-6);
  EXPECT_NEAR(uv[2].x, 0.1 + 3.0, 1e-6);
  EXPECT_NEAR(uv[2].y, 0.2, 1e-6);
}

TEST(MaterialsTest, VertexColorsAreReadAsFloatsAndAsNormalizedBytes) {
  GltfBuilder builder = good_scene();
  json& attributes = builder.document["meshes"][0]["primitives"][0]["attributes"];
  std::vector<float> floats(24, 0.25F);
  floats[3] = 1.0F;
  floats[6] = std::numeric_limits<float>::quiet_NaN();
  attributes["COLOR_0"] = builder.add_floats(floats, "VEC3");
  LoadedScene loaded = load_text(builder.text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  const std::vector<glm::vec3>& colors = loaded.scene->bodies[0].draw.colors;
  ASSERT_EQ(colors.size(), loaded.scene->bodies[0].draw.positions.size());
  EXPECT_EQ(colors[0], glm::vec3(0.25F));
  EXPECT_EQ(colors[1], glm::vec3(1.0F, 0.25F, 0.25F));
  EXPECT_EQ(colors[2], glm::vec3(0.0F, 0.25F, 0.25F));
  EXPECT_TRUE(loaded.scene->tools[0].draw.colors.empty());

  std::string bytes(32, '\x33');  // 51 of 255; alpha is not drawn
  bytes[4] = '\xFF';
  json& accessors = builder.document["accessors"];
  attributes["COLOR_0"] = accessors.size();
  accessors.push_back({{"bufferView", builder.add_view(bytes)},
                       {"componentType", 5121},
                       {"normalized", true},
                       {"count", 8},
                       {"type", "VEC4"}});
  loaded = load_text(builder.text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  const glm::vec3& second = loaded.scene->bodies[0].draw.colors[1];
  EXPECT_NEAR(second.r, 1.0F, 1e-6F);
  EXPECT_NEAR(second.g, 0.2F, 1e-6F);
}

TEST(MaterialsTest, CoordinatesOfAnotherKindAreRefusedOrPassedOver) {
  GltfBuilder builder = textured_scene();
  json& primitive = builder.document["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] = primitive["attributes"]["POSITION"];
  const LoadedScene loaded = load_text(builder.text());
  EXPECT_TRUE(!loaded.scene || loaded.scene->bodies[0].draw.texcoords.empty());
  builder.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 3;
  const LoadedScene missing = load_text(builder.text());
  ASSERT_TRUE(missing.scene.has_value());
  EXPECT_TRUE(missing.scene->bodies[0].draw.texcoords.empty());
}

TEST(MaterialsTest, AnExactShapeIsDrawnAsItIsFeltUnlessToldOtherwise) {
  GltfBuilder builder = textured_scene();
  builder.node("cube")["extras"]["torsion_shape"] = "sphere";
  const auto farthest = [](const LoadedScene& loaded) {
    float largest = 0.0F;
    for (const glm::vec3& p : loaded.scene->bodies[0].draw.positions) {
      largest = std::max(largest, glm::length(p));
    }
    return largest;
  };
  const LoadedScene shape = load_text(builder.text());
  ASSERT_TRUE(shape.scene.has_value()) << to_text(shape.problems);
  EXPECT_NEAR(farthest(shape), 0.05, 1e-6);
  EXPECT_EQ(shape.scene->bodies[0].draw.materials[0].metallic, 0.25F);
  EXPECT_FALSE(base_image(shape));
  builder.node("cube")["extras"]["torsion_draw"] = "mesh";
  const LoadedScene mesh = load_text(builder.text());
  ASSERT_TRUE(mesh.scene.has_value());
  EXPECT_NEAR(farthest(mesh), 0.05 * std::sqrt(3.0), 1e-6);
  EXPECT_TRUE(base_image(mesh));
}

}  // namespace
}  // namespace torsion::engine::test
