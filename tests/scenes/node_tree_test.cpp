#include "scenes/node_tree.hpp"

#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

double largest_difference(const glm::dmat4& a, const glm::dmat4& b) {
  double largest = 0.0;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      largest = std::max(largest, std::abs(a[column][row] - b[column][row]));
    }
  }
  return largest;
}

glm::dmat4 matrix_of(const NodeTransform& transform) {
  return glm::translate(glm::dmat4(1.0), transform.translation) *
         glm::mat4_cast(transform.rotation) * glm::scale(glm::dmat4(1.0), transform.scale);
}

TEST(NodeTreeTest, SplitTransformsMultiplyBackWhateverTheirSigns) {
  const glm::dquat rotation = glm::angleAxis(2.5, glm::normalize(glm::dvec3(1.0, -2.0, 0.5)));
  for (int signs = 0; signs < 8; ++signs) {
    const glm::dvec3 scale((signs & 1) != 0 ? -0.5 : 0.5, (signs & 2) != 0 ? -2.0 : 2.0,
                           (signs & 4) != 0 ? -7.0 : 7.0);
    const glm::dmat4 matrix = matrix_of({{1.0, 2.0, 3.0}, rotation, scale});
    const auto split = split_transform(matrix);
    ASSERT_TRUE(split);
    EXPECT_LE(largest_difference(matrix_of(*split), matrix), 1e-13);
    EXPECT_GT(split->scale.y, 0.0);
    EXPECT_GT(split->scale.z, 0.0);
  }
}

TEST(NodeTreeTest, ShearAndFlatnessDoNotSplit) {
  glm::dmat4 sheared(1.0);
  sheared[1][0] = 1e-3;
  EXPECT_FALSE(split_transform(sheared));
  glm::dmat4 flat(1.0);
  flat[2][2] = 0.0;
  EXPECT_FALSE(split_transform(flat));
}

TEST(NodeTreeTest, MatrixIsColumnByColumn) {
  tinygltf::Node node;
  node.matrix = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1};
  const glm::dmat4 matrix = local_matrix(node);
  EXPECT_EQ(glm::dvec3(matrix * glm::dvec4(1.0, 0.0, 0.0, 1.0)), glm::dvec3(4.0, 6.0, 6.0));
}

TEST(NodeTreeTest, ScaleComesBeforeRotationBeforeTranslation) {
  tinygltf::Node node;
  node.translation = {1.0, 0.0, 0.0};
  node.rotation = {0.0, 0.0, std::numbers::sqrt2 / 2.0, std::numbers::sqrt2 / 2.0};
  node.scale = {3.0, 1.0, 1.0};
  const glm::dvec3 moved(local_matrix(node) * glm::dvec4(1.0, 0.0, 0.0, 1.0));
  EXPECT_LE(glm::distance(moved, glm::dvec3(1.0, 3.0, 0.0)), 1e-14);
}

tinygltf::Model tree() {
  // 0 root -> 1 tool -> 2 plain -> 3 plain; 4 elastic, a root of its own
  tinygltf::Model model;
  model.nodes.resize(5);
  model.nodes[0].children = {1};
  model.nodes[1].children = {2};
  model.nodes[2].children = {3};
  const auto role = [](const std::string& name) {
    return tinygltf::Value(tinygltf::Value::Object{{"torsion_role", tinygltf::Value(name)}});
  };
  model.nodes[1].extras = role("tool");
  model.nodes[4].extras = role("elastic");
  for (tinygltf::Node& node : model.nodes) {
    node.translation = {1.0, 0.0, 0.0};
  }
  return model;
}

TEST(NodeTreeTest, ParentsComeFirstAndOwnersReachDown) {
  const std::vector<SceneNode> nodes = list_scene_nodes(tree());
  ASSERT_EQ(nodes.size(), 5U);
  EXPECT_EQ(nodes[0].owner, SIZE_MAX);
  for (std::size_t node = 1; node < 4; ++node) {
    EXPECT_EQ(nodes[node].row, node);
    EXPECT_EQ(nodes[node].parent, node - 1);
    EXPECT_EQ(nodes[node].owner, 1U);
  }
  EXPECT_EQ(nodes[4].parent, SIZE_MAX);
  EXPECT_EQ(nodes[4].role, Role::kElastic);
  EXPECT_EQ(nodes[3].to_world[3].x, 4.0);
}

TEST(NodeTreeTest, OnlyTheSceneThatIsShownIsListed) {
  tinygltf::Model model = tree();
  model.scenes.resize(2);
  model.scenes[0].nodes = {0};
  model.scenes[1].nodes = {4};
  EXPECT_EQ(list_scene_nodes(model).size(), 4U);
  model.defaultScene = 1;
  const std::vector<SceneNode> nodes = list_scene_nodes(model);
  ASSERT_EQ(nodes.size(), 1U);
  EXPECT_EQ(nodes[0].row, 4U);
}

TEST(NodeTreeTest, ASceneListsRootNodesOnceAndNothingElse) {
  // Each would make a body twice, or one away from its parent's place.
  const auto problem_of = [](const nlohmann::json& nodes, bool below) {
    GltfBuilder scene = good_scene();
    if (below) {
      const int holder = scene.add_node({{"name", "holder"}});
      scene.put_below(0, holder);
    }
    scene.document["scenes"][0]["nodes"] = nodes;
    const LoadedScene loaded = load_text(scene.text());
    return loaded.scene ? std::string() : to_text(loaded.problems);
  };
  EXPECT_EQ(problem_of({0, 1}, false), "");
  EXPECT_EQ(problem_of({2, 1}, true), "");
  EXPECT_NE(problem_of({0, 1, 0}, false).find("is listed twice"), std::string::npos);
  EXPECT_NE(problem_of({0, 1, 2}, true).find("is a child of nodes[2]"), std::string::npos);
  EXPECT_NE(problem_of({0, 1}, true).find("is a child of nodes[2]"), std::string::npos);
}

TEST(NodeTreeTest, DeepTreesAreNoRecursion) {
  tinygltf::Model model;
  model.nodes.resize(100'000);
  for (std::size_t row = 0; row + 1 < model.nodes.size(); ++row) {
    model.nodes[row].children = {static_cast<int>(row) + 1};
  }
  EXPECT_EQ(list_scene_nodes(model).size(), 100'000U);
}

}  // namespace
}  // namespace torsion::engine::test
