#include "scenes/physics_extension.hpp"

#include <gtest/gtest.h>

#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

using nlohmann::json;

/// What is read of a node with this extension, in a file with these materials.
PhysicsExtension read(const json& extension,
                      const json& materials = json::array({json::object()})) {
  GltfBuilder builder;
  builder.add_node({{"name", "n"}, {"extensions", {{"KHR_physics_rigid_bodies", extension}}}});
  builder.document["extensions"]["KHR_physics_rigid_bodies"]["physicsMaterials"] = materials;
  tinygltf::Model model;
  std::string errors;
  std::string warnings;
  const std::string text = builder.text();
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadASCIIFromString(&model, &errors, &warnings, text.data(),
                                                       static_cast<unsigned int>(text.size()), "."))
      << errors;
  return read_physics_extension(model, model.nodes.at(0));
}

TEST(PhysicsExtensionTest, MassAndItsCenterAreRead) {
  const PhysicsExtension physics =
      read({{"motion", {{"mass", 2.5}, {"centerOfMass", {0.1, 0, -0.2}}}}});
  EXPECT_EQ(physics.mass, 2.5);
  EXPECT_EQ(physics.mass_center, glm::dvec3(0.1, 0.0, -0.2));
}

TEST(PhysicsExtensionTest, MassOfZeroMeansNoneIsSaid) {
  EXPECT_FALSE(read({{"motion", {{"mass", 0}}}}).mass);
}

TEST(PhysicsExtensionTest, FrictionComesFromTheMaterialOfTheCollider) {
  const json materials = {{{"staticFriction", 0.1}, {"dynamicFriction", 0.1}},
                          {{"staticFriction", 0.8}, {"dynamicFriction", 0.6}}};
  const PhysicsExtension physics = read({{"collider", {{"physicsMaterial", 1}}}}, materials);
  EXPECT_EQ(physics.static_friction, 0.8);
  EXPECT_EQ(physics.dynamic_friction, 0.6);
}

TEST(PhysicsExtensionTest, StaticFrictionIsRaisedToTheDynamicOne) {
  const json materials = {{{"staticFriction", 0.3}, {"dynamicFriction", 0.6}}};
  EXPECT_EQ(read({{"collider", {{"physicsMaterial", 0}}}}, materials).static_friction, 0.6);
}

TEST(PhysicsExtensionTest, DraftsThatSaySomethingElseAreNoHarm) {
  for (const json& odd : {json({{"motion", 3}}), json({{"motion", {{"mass", "x"}}}}),
                          json({{"motion", {{"centerOfMass", {1, 2}}}}}),
                          json({{"motion", {{"centerOfMass", {1, "y", 3}}}}}),
                          json({{"collider", "z"}}), json({{"collider", {{"physicsMaterial", 7}}}}),
                          json({{"collider", {{"physicsMaterial", -1}}}}),
                          json({{"collider", {{"physicsMaterial", "0"}}}})}) {
    const PhysicsExtension physics = read(odd);
    EXPECT_FALSE(physics.mass || physics.mass_center || physics.static_friction ||
                 physics.dynamic_friction)
        << odd.dump();
  }
}

}  // namespace
}  // namespace torsion::engine::test
