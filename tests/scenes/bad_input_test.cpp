// One fault in a good scene at a time: each must be refused with a message that names the place,
// the value and what would have been right.

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "scenes/load_gltf.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

using nlohmann::json;

struct BadInput {
  const char* name;
  std::function<void(GltfBuilder&)> spoil;
  std::vector<std::string> fragments;  // all are in the text of the problems
};

// Rows of good_scene(): nodes 0 cube, 1 block; accessors 0 positions and 1 indices of the cube,
// 2 and 3 of the block, 4 times and 5 values of the motion; buffer views likewise.

json& extras(GltfBuilder& scene, const char* node) {
  return scene.node(node)["extras"];
}

void put_float(GltfBuilder& scene, std::size_t offset, float value) {
  scene.bytes().replace(offset, 4,
                        std::string(reinterpret_cast<const char*>(&value), sizeof value));
}

const std::vector<BadInput>& bad_keys() {
  static const std::vector<BadInput> kInputs = {
      {"MisspeltKey",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_young_modulus"] = 1e5; },
       {"node \"cube\"", "torsion_young_modulus", "100000", "did you mean torsion_youngs_modulus"}},
      {"UnknownKey",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_flavour_of_ice_cream"] = 1; },
       {"torsion_flavour_of_ice_cream", "no such key", "docs/scenes.md"}},
      {"WrongTypeText",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_density"] = "heavy"; },
       {"node \"cube\"", "torsion_density", "\"heavy\"", "a number above 0 (kg/m^3)"}},
      {"WrongTypeBoolean",
       [](GltfBuilder& s) { extras(s, "block")["torsion_mass"] = true; },
       {"node \"block\"", "torsion_mass", "true", "a number above 0 (kg)"}},
      {"WrongTypeNull",
       [](GltfBuilder& s) { extras(s, "block")["torsion_mass"] = nullptr; },
       {"torsion_mass", "null", "a number above 0 (kg)"}},
      {"WrongTypeNumber",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_fixed"] = 3; },
       {"torsion_fixed", "is 3", "bottom_center, bottom_face, attribute, children"}},
      {"ModulusOfZero",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_youngs_modulus"] = 0; },
       {"torsion_youngs_modulus", "is 0", "above 0 (Pa)"}},
      {"NegativeModulus",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_youngs_modulus"] = -3e6; },
       {"torsion_youngs_modulus", "-3e+06", "above 0 (Pa)"}},
      {"PoissonRatioAboveAHalf",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_poisson_ratio"] = 0.51; },
       {"torsion_poisson_ratio", "0.51", "0 to 0.5"}},
      {"NegativePoissonRatio",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_poisson_ratio"] = -0.1; },
       {"torsion_poisson_ratio", "-0.1", "0 to 0.5"}},
      {"StaticFrictionBelowDynamic",
       [](GltfBuilder& s) {
         extras(s, "cube")["torsion_static_friction"] = 0.3;
         extras(s, "cube")["torsion_dynamic_friction"] = 0.4;
       },
       {"node \"cube\"", "torsion_static_friction", "0.3", "torsion_dynamic_friction", "0.4"}},
      {"MassOfZero",
       [](GltfBuilder& s) { extras(s, "block")["torsion_mass"] = 0; },
       {"node \"block\"", "torsion_mass", "is 0", "above 0 (kg)"}},
      {"CenterOfMassOfTwoNumbers",
       [](GltfBuilder& s) {
         extras(s, "block")["torsion_center_of_mass"] = {0.0, 1.0};
       },
       {"torsion_center_of_mass", "3 numbers"}},
      {"KeyOnTheWrongRole",
       [](GltfBuilder& s) { extras(s, "block")["torsion_youngs_modulus"] = 1e5; },
       {"node \"block\"", "torsion_youngs_modulus", "belongs to elastic", "this is tool"}},
      {"KeyOnANodeWithoutRole",
       [](GltfBuilder& s) {
         s.add_node({{"name", "lamp"}, {"extras", {{"torsion_mass", 1.0}}}});
       },
       {"node \"lamp\"", "torsion_mass", "belongs to tool", "without a torsion_role"}},
      {"MisspeltRole",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_role"] = "elastc"; },
       {"node \"cube\"", "torsion_role", "\"elastc\"", "did you mean \"elastic\""}},
      {"MisspeltShape",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_shape"] = "sphre"; },
       {"torsion_shape", "\"sphre\"", "did you mean \"sphere\""}},
      {"ShapeThatDoesNotFit",
       [](GltfBuilder& s) {
         extras(s, "cube")["torsion_shape"] = "sphere";
         s.node("cube")["scale"] = {1.0, 1.0, 1.5};
       },
       {"node \"cube\"", "0.1 x 0.1 x 0.15 m", "equal extents", "ellipsoid"}},
  };
  return kInputs;
}

const std::vector<BadInput>& bad_scenes() {
  static const std::vector<BadInput> kInputs = {
      {"NoElasticBody",
       [](GltfBuilder& s) { extras(s, "cube").erase("torsion_role"); },
       {"no elastic body", "torsion_role"}},
      {"NoTool",
       [](GltfBuilder& s) {
         extras(s, "block").erase("torsion_role");
         s.document.erase("animations");
       },
       {"no tool", "torsion_role"}},
      {"ToolWithoutMotion",
       [](GltfBuilder& s) { s.document.erase("animations"); },
       {"node \"block\"", "ever moves", "torsion_device"}},
      {"AnimationWithoutKeys",
       [](GltfBuilder& s) {
         s.document["accessors"][4]["count"] = 0;
         s.document["accessors"][5]["count"] = 0;
       },
       {"accessors[4].count", "is 0", "from 1"}},
      {"AnimationWithoutChannels",
       [](GltfBuilder& s) { s.document["animations"][0]["channels"] = json::array(); },
       {"animations[0].channels", "at least one"}},
      {"ScaledTool",
       [](GltfBuilder& s) {
         s.add_motion(1, "scale", {0.0F, 1.0F}, {1.0F, 1.0F, 1.0F, 2.0F, 2.0F, 2.0F});
       },
       {"node \"block\"", "scale", "rigid"}},
      {"AnimatedPartOfABody",
       [](GltfBuilder& s) {
         const int mesh = s.add_mesh(box_mesh(glm::dvec3(0.01)));
         const int part = s.add_node({{"name", "lump"}, {"mesh", mesh}});
         json& roots = s.document["scenes"][0]["nodes"];
         roots.erase(roots.size() - 1);
         s.node("cube")["children"] = {part};
         s.add_motion(part, "translation", {0.0F, 1.0F}, {0.0F, 0.05F, 0.0F, 0.0F, 0.06F, 0.0F});
       },
       {"node \"lump\"", "animation", "moves a part of the body"}},
      {"TwoToolsOfOneName",
       [](GltfBuilder& s) {
         const int mesh = s.add_mesh(box_mesh(glm::dvec3(0.01)));
         s.add_node({{"name", "block"},
                     {"mesh", mesh},
                     {"translation", {0.2, 0.0, 0.0}},
                     {"extras", {{"torsion_role", "tool"}, {"torsion_device", "mouse"}}}});
       },
       {"node \"block\"", "another tool"}},
      {"ToolBelowABody",
       [](GltfBuilder& s) { s.put_below(1, 0); },
       {"node \"block\"", "below node \"cube\"", "move it out"}},
      {"SizeBesideAMesh",
       [](GltfBuilder& s) {
         extras(s, "cube")["torsion_size"] = {0.1, 0.1, 0.1};
       },
       {"node \"cube\"", "torsion_size", "without a mesh"}},
      {"SizeWithoutAShape",
       [](GltfBuilder& s) {
         s.node("cube").erase("mesh");
         extras(s, "cube")["torsion_size"] = {0.1, 0.1, 0.1};
       },
       {"node \"cube\"", "torsion_size", "set torsion_shape"}},
      {"SizeOfNothing",
       [](GltfBuilder& s) {
         s.node("cube").erase("mesh");
         extras(s, "cube")["torsion_shape"] = "box";
         extras(s, "cube")["torsion_size"] = {0.1, 0.0, 0.1};
       },
       {"node \"cube\"", "torsion_size", "3 numbers above 0"}},
      {"KeyOfTheSceneOnANode",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_loop"] = true; },
       {"node \"cube\"", "torsion_loop", "belongs to the scene", "extras of the scene"}},
      {"KeyOfANodeOnTheScene",
       [](GltfBuilder& s) { s.document["scenes"][0]["extras"]["torsion_mass"] = 1.0; },
       {"torsion_mass", "belongs to tool", "this is the scene"}},
      {"SpeedBeyondRealTime",
       [](GltfBuilder& s) { s.document["scenes"][0]["extras"]["torsion_speed"] = 2.0; },
       {"torsion_speed", "2", "0.01 to 1"}},
      {"ToolWithoutMesh",
       [](GltfBuilder& s) { s.node("block").erase("mesh"); },
       {"node \"block\"", "mesh", "missing"}},
      {"FlattenedNode",
       [](GltfBuilder& s) {
         s.node("cube")["scale"] = {1.0, 0.0, 1.0};
       },
       {"node \"cube\"", "scale"}},
      {"ShearedNode",
       [](GltfBuilder& s) {
         s.node("cube").erase("translation");
         s.node("cube")["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
       },
       {"node \"cube\"", "scale", "sheared", "Apply"}},
      {"FixedNodeWithoutBody",
       [](GltfBuilder& s) {
         s.add_node({{"name", "pin"}, {"extras", {{"torsion_role", "fixed_point"}}}});
       },
       {"node \"pin\"", "elastic node above"}},
      {"FixedBoxThatHoldsNothing",
       [](GltfBuilder& s) {
         const int pin = s.add_node({{"name", "pin"},
                                     {"translation", {9.0, 0.0, 0.0}},
                                     {"extras", {{"torsion_role", "fixed_box"}}}});
         s.put_below(pin, 0);
       },
       {"node \"cube\"", "hold no vertex"}},
      {"FixedAttributeThatIsNotThere",
       [](GltfBuilder& s) { extras(s, "cube")["torsion_fixed"] = "attribute"; },
       {"node \"cube\"", "torsion_fixed", "_FIXED", "vertex groups"}},
  };
  return kInputs;
}

const std::vector<BadInput>& bad_files() {
  static const std::vector<BadInput> kInputs = {
      {"AccessorOutOfRange",
       [](GltfBuilder& s) { s.document["accessors"][0]["count"] = 9; },
       {"accessors[0].count", "is 9", "bufferView", "96 bytes"}},
      {"AccessorThatIsNotThere",
       [](GltfBuilder& s) {
         s.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 99;
       },
       {"meshes[0].primitives[0].attributes.POSITION", "is 99", "index of accessors", "6"}},
      {"AccessorIndexOf2To32",
       [](GltfBuilder& s) { s.document["meshes"][0]["primitives"][0]["indices"] = 4294967297; },
       {"meshes[0].primitives[0].indices", "4294967297", "index of accessors"}},
      {"NegativeNodeIndex",
       [](GltfBuilder& s) { s.document["scenes"][0]["nodes"][0] = -1; },
       {"scenes[0].nodes[0]", "-1", "index of nodes"}},
      {"VertexIndexOutOfRange",
       [](GltfBuilder& s) { s.bytes()[96] = 8; },
       {"meshes[0]", "primitive 0", "index", "is 8", "at most 7"}},
      {"PositionNotANumber",
       [](GltfBuilder& s) { put_float(s, 0, std::numeric_limits<float>::quiet_NaN()); },
       {"meshes[0]", "POSITION of vertex 0", "nan", "finite"}},
      {"PositionInfinite",
       [](GltfBuilder& s) { put_float(s, 16, std::numeric_limits<float>::infinity()); },
       {"POSITION of vertex 1", "inf", "finite"}},
      {"CountOf2To31",
       [](GltfBuilder& s) { s.document["accessors"][0]["count"] = 2147483648; },
       {"accessors[0].count", "2147483648", "whole number from 1 to"}},
      {"CountOf2To31WithoutBufferView",
       [](GltfBuilder& s) {
         s.document["accessors"][0]["count"] = 2147483648;
         s.document["accessors"][0].erase("bufferView");
       },
       {"accessors[0].count", "2147483648"}},
      {"ViewBeyondItsBuffer",
       [](GltfBuilder& s) { s.document["bufferViews"][5]["byteLength"] = 4096; },
       {"bufferViews[5].byteLength", "4096", "its buffer has"}},
      {"NodeThatIsItsOwnChild",
       [](GltfBuilder& s) { s.document["nodes"][1]["children"] = {1}; },
       {"nodes[1]", "cycle"}},
      {"NodesInACircle",
       [](GltfBuilder& s) {
         s.document["nodes"][0]["children"] = {1};
         s.document["nodes"][1]["children"] = {0};
       },
       {"nodes[0]", "own ancestor", "cycle"}},
      {"NodeWithTwoParents",
       [](GltfBuilder& s) {
         s.add_node({{"name", "a"}, {"children", {1}}});
         s.add_node({{"name", "b"}, {"children", {1}}});
       },
       {"nodes[3].children[0]", "child of nodes[2] already"}},
      {"TimesThatFall",
       [](GltfBuilder& s) {
         put_float(s, s.document["bufferViews"][4]["byteOffset"].get<std::size_t>() + 4, -1.0F);
       },
       {"animations[0].channels[0]", "input", "rise"}},
      {"TooFewValuesForTheKeys",
       [](GltfBuilder& s) {
         s.document["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE";
       },
       {"animations[0].channels[0]", "output", "2 values", "expected 6"}},
      {"UnknownInterpolation",
       [](GltfBuilder& s) { s.document["animations"][0]["samplers"][0]["interpolation"] = "SINE"; },
       {"animations[0].samplers[0].interpolation", "SINE", "LINEAR"}},
      {"ExtensionThatIsNotRead",
       [](GltfBuilder& s) { s.document["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
       {"extensionsRequired[0]", "KHR_draco_mesh_compression", "without mesh compression"}},
      {"OldVersion",
       [](GltfBuilder& s) { s.document["asset"]["version"] = "1.0"; },
       {"asset.version", "1.0", "2.0"}},
      {"ExternalBufferOutsideTheFolder",
       [](GltfBuilder& s) {
         s.document["buffers"] = {{{"byteLength", 640}, {"uri", "../../../etc/hostname"}}};
       },
       {"buffers[0].uri", "../../../etc/hostname", "in the folder of the scene"}},
      {"EncodedWayOutOfTheFolder",
       [](GltfBuilder& s) {
         s.document["buffers"] = {{{"byteLength", 640}, {"uri", "%2e%2e/secret.bin"}}};
       },
       {"buffers[0].uri", "in the folder of the scene"}},
      {"AbsolutePath",
       [](GltfBuilder& s) {
         s.document["buffers"] = {{{"byteLength", 640}, {"uri", "/etc/hostname"}}};
       },
       {"buffers[0].uri", "/etc/hostname", "in the folder of the scene"}},
      {"BufferIsAFolder",
       [](GltfBuilder& s) {
         s.document["buffers"] = {{{"byteLength", 640}, {"uri", "."}}};
       },
       {"buffers[0].uri"}},
      {"BufferThatIsMissing",
       [](GltfBuilder& s) {
         s.document["buffers"] = {{{"byteLength", 640}, {"uri", "missing.bin"}}};
       },
       {"buffers[0].uri", "missing.bin", "No such file"}},
      {"RotationOfLengthTwo",
       [](GltfBuilder& s) {
         s.node("cube")["rotation"] = {0.0, 0.0, 0.0, 2.0};
       },
       {"nodes[0].rotation", "unit quaternion"}},
      {"DeepNesting",
       [](GltfBuilder& s) {
         json deep = 1;
         for (int i = 0; i < 100; ++i) {
           deep = json::array({std::move(deep)});
         }
         extras(s, "cube")["other"] = std::move(deep);
       },
       {"nested deeper than 64"}},
  };
  return kInputs;
}

const std::vector<BadInput>& bad_meshes() {
  static const std::vector<BadInput> kInputs = {
      {"OpenMesh",
       [](GltfBuilder& s) {
         s.document["accessors"][1]["count"] = 30;  // the last face, at z = +0.05, is left out
       },
       {"node \"cube\"", "open", "4 edges", "0.05", "Fill Holes", "torsion_shape"}},
      {"MeshWithoutArea",
       [](GltfBuilder& s) { s.bytes().replace(0, 96, std::string(96, '\0')); },
       {"node \"cube\"", "no triangle with an area"}},
      {"MeshWithoutVolume",
       [](GltfBuilder& s) {
         const std::vector<std::uint32_t> there_and_back = {0, 1, 2, 0, 2, 1};
         s.document["meshes"][0]["primitives"][0]["indices"] = s.add_indices(there_and_back);
       },
       {"node \"cube\"", "encloses no volume"}},
      {"NeighboursThatFaceOppositeWays",
       [](GltfBuilder& s) {
         SurfaceMesh box = box_mesh(glm::dvec3(0.05));
         std::swap(box.triangles[0].y, box.triangles[0].z);
         s.document["nodes"][0]["mesh"] = s.add_mesh(box);
       },
       {"node \"cube\"", "opposite ways", "3 edges", "Normals"}},
      {"FaceInside",
       [](GltfBuilder& s) {
         SurfaceMesh box = box_mesh(glm::dvec3(0.05));
         box.triangles.emplace_back(0, 3, 7);
         box.triangles.emplace_back(0, 7, 4);
         s.document["nodes"][0]["mesh"] = s.add_mesh(box);
       },
       {"node \"cube\"", "more than two triangles"}},
      {"LooseEdges",
       [](GltfBuilder& s) { s.document["meshes"][0]["primitives"][0]["mode"] = 1; },
       {"node \"cube\"", "mode of primitive 0", "is 1", "triangles"}},
      {"NoPositions",
       [](GltfBuilder& s) {
         s.document["meshes"][0]["primitives"][0]["attributes"] = {{"NORMAL", 0}};
       },
       {"meshes[0].primitives[0].attributes.POSITION", "missing"}},
  };
  return kInputs;
}

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsRefusedWithAClearMessage) {
  GltfBuilder scene = good_scene();
  GetParam().spoil(scene);
  const LoadedScene loaded = load_text(scene.text());
  EXPECT_FALSE(loaded.scene.has_value());
  const std::string text = to_text(loaded.problems);
  EXPECT_NE(text.find("scene.gltf: "), std::string::npos) << text;
  for (const std::string& fragment : GetParam().fragments) {
    EXPECT_NE(text.find(fragment), std::string::npos) << '"' << fragment << "\" is not in\n"
                                                      << text;
  }
}

std::string name_of(const testing::TestParamInfo<BadInput>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Keys, BadInputTest, testing::ValuesIn(bad_keys()), name_of);
INSTANTIATE_TEST_SUITE_P(Scenes, BadInputTest, testing::ValuesIn(bad_scenes()), name_of);
INSTANTIATE_TEST_SUITE_P(Files, BadInputTest, testing::ValuesIn(bad_files()), name_of);
INSTANTIATE_TEST_SUITE_P(Meshes, BadInputTest, testing::ValuesIn(bad_meshes()), name_of);

}  // namespace
}  // namespace torsion::engine::test
