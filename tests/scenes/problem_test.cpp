#include "scenes/problem.hpp"

#include <gtest/gtest.h>

namespace torsion::engine::test {
namespace {

TEST(ProblemTest, TextHasEveryPartInTurn) {
  std::vector<Problem> found;
  const ProblemList problems{"dir/a.gltf", found};
  problems.add("node \"n\"", "torsion_mass", "-1", "expected a number above 0 (kg)", "raise it");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(to_text(found[0]),
            "dir/a.gltf: node \"n\": torsion_mass is -1, expected a number above 0 (kg)\n"
            "  to mend it: raise it");
}

TEST(ProblemTest, PartsThatAreEmptyLeaveNoTrace) {
  EXPECT_EQ(to_text(Problem{"a.gltf", "", "", "", "has no tool", ""}), "a.gltf: has no tool");
}

TEST(ProblemTest, SeveralStandOneUnderTheOther) {
  const std::vector<Problem> found = {{"a", "", "", "", "one", ""}, {"a", "", "", "", "two", ""}};
  EXPECT_EQ(to_text(found), "a: one\na: two\n");
}

}  // namespace
}  // namespace torsion::engine::test
