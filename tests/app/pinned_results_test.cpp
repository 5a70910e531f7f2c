// Every shipped scene with every pair of models comes to the bits that it came to when
// tests/app/pinned_results.txt was last renewed. A change of layout or speed must keep them; a
// change of results renews the file by `./dev pin` and says in its commit why.

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/app/run_digest.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine::test {
namespace {

std::vector<std::string> pinned_lines() {
  std::ifstream file(pinned_file());
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Every third: of the ten runs of each scene three or four, and of each kind of run as many.
bool is_chosen(const PinnedRun& run) {
  const std::vector<PinnedRun> runs = pinned_runs();
  const auto row =
      std::ranges::find(runs, name_of(run), [](const auto& at) { return name_of(at); });
  return (row - runs.begin()) % 3 == 0;
}

TEST(PinnedRunsTest, EverySceneAndEveryKindOfRunIsAmongTheChosen) {
  std::set<std::string> scenes;
  std::set<std::string> chosen_scenes;
  std::set<std::string> kinds;
  std::set<std::string> chosen_kinds;
  for (const PinnedRun& run : pinned_runs()) {
    const std::string name = name_of(run);
    const std::string scene = name.substr(0, name.find(' '));
    const std::string kind = name.substr(name.find(' '));
    scenes.insert(scene);
    kinds.insert(kind);
    if (is_chosen(run)) {
      chosen_scenes.insert(scene);
      chosen_kinds.insert(kind);
    }
  }
  EXPECT_EQ(kinds.size(), 10U);  // nine pairs of models, and one that is held
  EXPECT_EQ(chosen_scenes, scenes);
  EXPECT_EQ(chosen_kinds, kinds);
}

class PinnedResultTest : public testing::TestWithParam<PinnedRun> {};

TEST_P(PinnedResultTest, IsTheSameToTheBit) {
  if (test::is_left_out(is_chosen(GetParam()))) {
    GTEST_SKIP() << test::kLeftOut;
  }
  const std::string line = pinned_line(GetParam(), digest_of(GetParam()));
  const std::vector<std::string> lines = pinned_lines();
  EXPECT_TRUE(std::ranges::find(lines, line) != lines.end())
      << "not in " << pinned_file() << ":\n"
      << line << "\nIf the result was meant to change, or this machine's instruction set is new "
      << "there, run ./dev pin and say in the commit why.";
}

std::string test_name(const testing::TestParamInfo<PinnedRun>& run) {
  std::string name = name_of(run.param);
  std::ranges::replace_if(
      name, [](unsigned char letter) { return std::isalnum(letter) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, PinnedResultTest, testing::ValuesIn(pinned_runs()), test_name);

}  // namespace
}  // namespace torsion::engine::test
