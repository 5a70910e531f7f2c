#include "scenes/extras.hpp"

#include <gtest/gtest.h>

#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

using Object = tinygltf::Value::Object;

struct Keys {
  std::vector<Problem> found;
  ProblemList problems{"f.gltf", found};
  NodeKeys keys;
};

tinygltf::Value one(const std::string& name, tinygltf::Value value) {
  return tinygltf::Value(Object{{name, std::move(value)}});
}

TEST(ExtrasTest, LaterKeysWin) {
  Keys read;
  read.keys.add(one("torsion_density", tinygltf::Value(500.0)), "material \"m\"", read.problems);
  read.keys.add(one("torsion_density", tinygltf::Value(700.0)), "mesh \"m\"", read.problems);
  EXPECT_EQ(read.keys.number("torsion_density"), 700.0);
  EXPECT_EQ(read.keys.where("torsion_density"), "mesh \"m\"");
  EXPECT_TRUE(read.found.empty());
}

TEST(ExtrasTest, KeyThatIsNotThereHasNoValue) {
  const Keys read;
  EXPECT_FALSE(read.keys.number("torsion_density").has_value());
  EXPECT_FALSE(read.keys.text("torsion_shape").has_value());
  EXPECT_FALSE(read.keys.vector("torsion_center_of_mass").has_value());
  EXPECT_EQ(read.keys.where("torsion_density"), "");
}

TEST(ExtrasTest, WholeNumbersAreNumbers) {
  Keys read;
  read.keys.add(one("torsion_density", tinygltf::Value(900)), "n", read.problems);
  EXPECT_EQ(read.keys.number("torsion_density"), 900.0);
}

TEST(ExtrasTest, KeysOfOthersAreLeftAlone) {
  Keys read;
  read.keys.add(one("my_torsion_density", tinygltf::Value(std::string("x"))), "n", read.problems);
  read.keys.add(tinygltf::Value(3.0), "n", read.problems);
  EXPECT_TRUE(read.found.empty());
}

TEST(ExtrasTest, ValueOutOfRangeIsNotedAndLeftOut) {
  Keys read;
  read.keys.add(one("torsion_poisson_ratio", tinygltf::Value(0.6)), "node \"n\"", read.problems);
  ASSERT_EQ(read.found.size(), 1U);
  EXPECT_EQ(read.found[0].where, "node \"n\"");
  EXPECT_EQ(read.found[0].key, "torsion_poisson_ratio");
  EXPECT_EQ(read.found[0].value, "0.6");
  EXPECT_FALSE(read.keys.number("torsion_poisson_ratio").has_value());
}

TEST(ExtrasTest, RangesIncludeTheirEndsWhereTheTableSaysSo) {
  Keys read;
  read.keys.add(one("torsion_poisson_ratio", tinygltf::Value(0.0)), "n", read.problems);
  read.keys.add(one("torsion_poisson_ratio", tinygltf::Value(0.5)), "n", read.problems);
  read.keys.add(one("torsion_dynamic_friction", tinygltf::Value(0.0)), "n", read.problems);
  EXPECT_TRUE(read.found.empty());
  read.keys.add(one("torsion_mass", tinygltf::Value(0.0)), "n", read.problems);
  EXPECT_EQ(read.found.size(), 1U);
}

TEST(ExtrasTest, VectorHasThreeNumbers) {
  Keys read;
  const tinygltf::Value::Array three = {tinygltf::Value(1), tinygltf::Value(2.5),
                                        tinygltf::Value(-3)};
  read.keys.add(one("torsion_center_of_mass", tinygltf::Value(three)), "n", read.problems);
  EXPECT_EQ(read.keys.vector("torsion_center_of_mass"), glm::dvec3(1.0, 2.5, -3.0));
}

TEST(ExtrasTest, EveryKeyIsRefusedOnEveryRoleThatItDoesNotBelongTo) {
  const tinygltf::Value::Array three = {tinygltf::Value(1), tinygltf::Value(2), tinygltf::Value(3)};
  const auto good_value = [&](const SceneKey& key) {
    if (key.kind == KeyKind::kNumber) {
      return tinygltf::Value(0.5);
    }
    if (key.kind == KeyKind::kFlag) {
      return tinygltf::Value(true);
    }
    const std::string first(key.allowed.substr(0, key.allowed.find(' ')));
    return key.kind == KeyKind::kVector ? tinygltf::Value(three) : tinygltf::Value(first);
  };
  for (const SceneKey& key : kSceneKeys) {
    for (const Role role : {Role::kElastic, Role::kTool, Role::kFixedPoint, Role::kFixedBox,
                            Role::kFixedSphere, Role::kPart, Role::kScene}) {
      Keys read;
      read.keys.add(one(std::string(key.name), good_value(key)), "n", read.problems);
      ASSERT_TRUE(read.found.empty()) << key.name;
      read.keys.check_role(role, read.problems);
      EXPECT_EQ(read.found.empty(), (key.roles & bits(role)) != 0) << key.name;
    }
  }
}

TEST(ExtrasTest, NearWordsAreOfferedAndFarOnesAreNot) {
  const std::vector<std::string_view> known = {"torsion_mass", "torsion_shape"};
  EXPECT_EQ(did_you_mean("torsion_mas", known), "torsion_mass");
  EXPECT_EQ(did_you_mean("torsion_shap", known), "torsion_shape");
  EXPECT_FALSE(did_you_mean("xyz", known).has_value());
  EXPECT_EQ(did_you_mean("maas", {"mass"}), "mass");
  EXPECT_EQ(did_you_mean("amss", {"mass"}), "mass");  // two letters that changed places
  EXPECT_FALSE(did_you_mean("mud", {"mass"}).has_value());
  EXPECT_FALSE(did_you_mean("", {"a"}).has_value());
}

TEST(ExtrasTest, TheBeginningOfAllKeysMakesNoneNearer) {
  for (const auto& [name, advice] :
       {std::pair("torsion_cells", "docs/scenes.md"), std::pair("torsion_", "docs/scenes.md"),
        std::pair("torsion_friction",
                  "did you mean torsion_static_friction or torsion_dynamic_friction?"),
        std::pair("torsion_rol", "did you mean torsion_role?"),
        std::pair("torsion_densty", "did you mean torsion_density?")}) {
    Keys read;
    read.keys.add(one(name, tinygltf::Value(1)), "node \"n\"", read.problems);
    ASSERT_EQ(read.found.size(), 1U);
    EXPECT_NE(read.found[0].mend.find(advice), std::string::npos) << read.found[0].mend;
  }
}

TEST(ExtrasTest, NamelessElementsAreCalledByTheirRow) {
  EXPECT_EQ(called("node", "nodes", 3, ""), "nodes[3]");
  EXPECT_EQ(called("node", "nodes", 3, "cube"), "node \"cube\"");
}

TEST(ExtrasTest, MaterialThenMeshThenNodeWinsInAWholeScene) {
  GltfBuilder scene = good_scene();
  scene.document["materials"] = {{{"extras",
                                   {{"torsion_youngs_modulus", 1e4},
                                    {"torsion_density", 800},
                                    {"torsion_poisson_ratio", 0.1}}}}};
  nlohmann::json& mesh = scene.document["meshes"][0];
  mesh["primitives"][0]["material"] = 0;
  mesh["extras"] = {{"torsion_density", 850}, {"torsion_poisson_ratio", 0.2}};
  scene.node("cube")["extras"]["torsion_poisson_ratio"] = 0.3;
  const LoadedScene loaded = load_text(scene.text());
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  const Elasticity& elasticity = loaded.scene->bodies[0].elasticity;
  EXPECT_EQ(elasticity.youngs_modulus, 1e4);
  EXPECT_EQ(elasticity.density, 850.0);
  EXPECT_EQ(elasticity.poisson_ratio, 0.3);
}

}  // namespace
}  // namespace torsion::engine::test
