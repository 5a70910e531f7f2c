#include "scenes/mesh_parts.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

using nlohmann::json;

struct Read {
  std::vector<Problem> found;
  MeshTriangles mesh;
};

/// The first mesh of a document, as tinygltf gives it.
Read read(const GltfBuilder& builder, const glm::dmat4& to_owner = glm::dmat4(1.0)) {
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string errors;
  std::string warnings;
  const std::string text = builder.text();
  EXPECT_TRUE(loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(),
                                         static_cast<unsigned int>(text.size()), "."))
      << errors;
  Read result;
  result.mesh = read_mesh(model, model.meshes.at(0), to_owner, {read_images(model), {}},
                          "node \"n\"", {"f.gltf", result.found});
  return result;
}

/// One primitive with these corners; five vertices on a zigzag in the plane z = 0.
GltfBuilder zigzag(int mode, const std::vector<std::uint32_t>& corners) {
  GltfBuilder builder;
  const int positions = builder.add_floats({0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0}, "VEC3");
  json primitive = {{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
  if (!corners.empty()) {
    primitive["indices"] = builder.add_indices(corners);
  }
  builder.document["meshes"] = {{{"primitives", json::array({primitive})}}};
  return builder;
}

/// Twice the area of a triangle in the plane z = 0, positive when counter-clockwise seen from +z.
double signed_area(const MeshTriangles& mesh, const glm::uvec3& t) {
  return glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                    mesh.positions[t.z] - mesh.positions[t.x])
      .z;
}

TEST(MeshPartsTest, ListWithoutIndicesTakesVerticesInTurn) {
  GltfBuilder builder;
  const int positions = builder.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  builder.document["meshes"] = {
      {{"primitives", json::array({{{"attributes", {{"POSITION", positions}}}}})}}};
  const Read result = read(builder);
  ASSERT_EQ(result.mesh.triangles.size(), 1U);
  EXPECT_EQ(result.mesh.triangles[0], glm::uvec3(0, 1, 2));
}

TEST(MeshPartsTest, StripTurnsEverySecondTriangle) {
  const Read result = read(zigzag(TINYGLTF_MODE_TRIANGLE_STRIP, {}));
  ASSERT_EQ(result.mesh.triangles.size(), 3U);
  // glTF 2.0, 3.7.2.1: p_i = {v_i, v_(i + 1 + i % 2), v_(i + 2 - i % 2)}: all face one way.
  EXPECT_EQ(result.mesh.triangles[1], glm::uvec3(1, 3, 2));
  for (const glm::uvec3& triangle : result.mesh.triangles) {
    EXPECT_EQ(signed_area(result.mesh, triangle), -1.0);
  }
}

TEST(MeshPartsTest, StripPassesOverTheTrianglesThatJoinItsParts) {
  const Read result = read(zigzag(TINYGLTF_MODE_TRIANGLE_STRIP, {0, 1, 2, 2, 2, 3, 4}));
  // Of the 5 triangles of 7 corners those with a doubled corner have no area.
  ASSERT_EQ(result.mesh.triangles.size(), 2U);
  EXPECT_EQ(result.mesh.triangles[0], glm::uvec3(0, 1, 2));
  EXPECT_EQ(result.mesh.triangles[1], glm::uvec3(2, 3, 4));
}

TEST(MeshPartsTest, FanGoesAroundItsFirstVertex) {
  const Read result = read(zigzag(TINYGLTF_MODE_TRIANGLE_FAN, {1, 0, 2, 4}));
  ASSERT_EQ(result.mesh.triangles.size(), 2U);
  // glTF 2.0, 3.7.2.1: p_i = {v_(i + 1), v_(i + 2), v_0}.
  EXPECT_EQ(result.mesh.triangles[0], glm::uvec3(0, 2, 1));
  EXPECT_EQ(result.mesh.triangles[1], glm::uvec3(2, 4, 1));
  for (const glm::uvec3& triangle : result.mesh.triangles) {
    EXPECT_GT(signed_area(result.mesh, triangle), 0.0);
  }
}

TEST(MeshPartsTest, PointsAndLinesAreProblems) {
  for (const int mode : {TINYGLTF_MODE_POINTS, TINYGLTF_MODE_LINE, TINYGLTF_MODE_LINE_LOOP,
                         TINYGLTF_MODE_LINE_STRIP}) {
    const Read result = read(zigzag(mode, {}));
    ASSERT_EQ(result.found.size(), 1U) << mode;
    EXPECT_EQ(result.found[0].where, "node \"n\"");
    EXPECT_EQ(result.found[0].value, std::to_string(mode));
  }
}

TEST(MeshPartsTest, MirrorTurnsTheTrianglesAbout) {
  const GltfBuilder builder = zigzag(TINYGLTF_MODE_TRIANGLE_FAN, {1, 0, 2, 4});
  const Read result = read(builder, glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0, 1.0, 1.0)));
  for (const glm::uvec3& triangle : result.mesh.triangles) {
    EXPECT_GT(signed_area(result.mesh, triangle), 0.0);
  }
}

TEST(MeshPartsTest, ScaleBendsNormalsByItsInverse) {
  GltfBuilder builder;
  const int positions = builder.add_floats({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  const float third = 0.57735027F;
  const int normals =
      builder.add_floats({third, third, third, third, third, third, third, third, third}, "VEC3");
  builder.document["meshes"] = {
      {{"primitives",
        json::array({{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}}})}}};
  const Read result = read(builder, glm::scale(glm::dmat4(1.0), glm::dvec3(2.0, 1.0, 1.0)));
  // The plane x + y + z = 1 becomes x / 2 + y + z = 1. Normals are floats: 1e-7.
  const glm::dvec3 expected = glm::normalize(glm::dvec3(0.5, 1.0, 1.0));
  ASSERT_EQ(result.mesh.normals.size(), 3U);
  for (const glm::dvec3& normal : result.mesh.normals) {
    EXPECT_LE(glm::distance(normal, expected), 2e-7);
  }
}

TEST(MeshPartsTest, MissingNormalsAreAveragedFromTheFaces) {
  GltfBuilder builder;
  builder.add_mesh(box_mesh(glm::dvec3(1.0)));
  const Read result = read(builder);
  EXPECT_TRUE(result.mesh.normals.empty());
  DrawMesh draw;
  append_draw_mesh(result.mesh, draw);
  ASSERT_EQ(draw.normals.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(glm::length(draw.normals[i]), 1.0F, 1e-6F);
    // A corner has 3, 4, 5 or 6 triangles around it, 1 or 2 of each face: at least 1 / 3 of the
    // longest component along each axis.
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(draw.normals[i][axis] * draw.positions[i][axis], 0.3F);
    }
  }
}

TEST(MeshPartsTest, NormalsOfSomePrimitivesOnlyAreNotMixed) {
  GltfBuilder builder = zigzag(TINYGLTF_MODE_TRIANGLE_STRIP, {});
  const int normals = builder.add_floats(std::vector<float>(15, 0.57735027F), "VEC3");
  json& primitives = builder.document["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[0]["attributes"]["NORMAL"] = normals;
  const Read result = read(builder);
  EXPECT_EQ(result.mesh.positions.size(), 10U);
  EXPECT_TRUE(result.mesh.normals.empty());
  EXPECT_EQ(result.mesh.triangles.back(), glm::uvec3(7, 8, 9));
}

TEST(MeshPartsTest, FixedAttributeIsFoundUnderEveryNameThatExportersWrite) {
  for (const char* name : {"_FIXED", "__FIXED", "_fixed", "_Fixed", "_TORSION_FIXED"}) {
    GltfBuilder builder = zigzag(TINYGLTF_MODE_TRIANGLE_STRIP, {});
    const int marks = builder.add_floats({0.0F, 1.0F, 0.5F, 0.6F, 0.0F}, "SCALAR");
    builder.document["meshes"][0]["primitives"][0]["attributes"][name] = marks;
    DrawMesh draw;
    append_draw_mesh(read(builder).mesh, draw);
    EXPECT_EQ(draw.fixed, (std::vector<bool>{false, true, false, true, false})) << name;
  }
}

TEST(MeshPartsTest, FixedAttributeOfOnePrimitiveLeavesTheOthersFree) {
  GltfBuilder builder = zigzag(TINYGLTF_MODE_TRIANGLE_STRIP, {});
  const int marks = builder.add_floats({1, 1, 1, 1, 1}, "SCALAR");
  json& primitives = builder.document["meshes"][0]["primitives"];
  primitives = json::array({primitives[0], primitives[0], primitives[0]});
  primitives[1]["attributes"]["_FIXED"] = marks;
  const Read result = read(builder);
  ASSERT_EQ(result.mesh.fixed.size(), 15U);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(result.mesh.fixed[i], i / 5 == 1 ? 1.0 : 0.0);
  }
}

TEST(MeshPartsTest, MaterialsAreTheirs) {
  GltfBuilder builder = zigzag(TINYGLTF_MODE_TRIANGLE_STRIP, {});
  builder.document["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 0.75, 0.5}}}}}};
  builder.document["meshes"][0]["primitives"][0]["material"] = 0;
  DrawMesh draw;
  append_draw_mesh(read(builder).mesh, draw);
  ASSERT_EQ(draw.materials.size(), 1U);
  EXPECT_EQ(draw.materials[0].color, glm::vec4(0.25F, 0.5F, 0.75F, 0.5F));
  EXPECT_EQ(draw.materials[0].alpha_mode, AlphaMode::kOpaque);  // as glTF says of no alphaMode
  EXPECT_EQ(draw.materials[0].metallic, 1.0F);                  // likewise
}

TEST(MeshPartsTest, DrawnMeshesFollowEachOther) {
  GltfBuilder builder;
  builder.add_mesh(box_mesh(glm::dvec3(1.0)));
  const Read result = read(builder);
  DrawMesh draw;
  append_draw_mesh(result.mesh, draw);
  append_draw_mesh(result.mesh, draw);
  EXPECT_EQ(draw.positions.size(), 16U);
  ASSERT_EQ(draw.triangles.size(), 24U);
  EXPECT_EQ(draw.triangles[12], draw.triangles[0] + 8U);
}

}  // namespace
}  // namespace torsion::engine::test
