// Bad input and wrong usage: what the program says, its exit code, and that nothing is left behind.

#include <gtest/gtest.h>

#include "tests/app/program.hpp"

namespace torsion {
namespace {

using test::Folder;
using test::Ran;
using test::run_torsion;
using test::scene;
using test::write_text;

TEST(ProgramUsageTest, WrongUsageIsExitCodeTwo) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"fly"},
      {"simulate"},
      {"simulate", scene("ball_on_cube"), "--rate", "0"},
      {"simulate", scene("ball_on_cube"), "--contact-model", "mdr"},
      {"simulate", scene("ball_on_cube"), "--speed", "3"},
      {"export", scene("ball_on_cube"), "--at", "1"},
      {"export", scene("ball_on_cube"), "--at", "1", "--out", "x.obj"},
#ifdef TORSION_WITH_RENDER
      {"render", scene("ball_on_cube"), "--out", "x.png"},
      {"render", scene("ball_on_cube"), "--at", "1", "--out", "x.png", "--size", "12"},
#endif
  };
  for (const auto& words : wrong) {
    const Ran ran = run_torsion(words);
    EXPECT_EQ(ran.exit_code, 2) << testing::PrintToString(words);
    EXPECT_FALSE(ran.err.empty()) << testing::PrintToString(words);
  }
}

TEST(ProgramUsageTest, HelpIsExitCodeZero) {
  EXPECT_EQ(run_torsion({"--help"}).exit_code, 0);
  for (const char* command : {"simulate", "export", "check"}) {
    EXPECT_EQ(run_torsion({command, "--help"}).exit_code, 0) << command;
  }
}

TEST(ProgramBadInputTest, MissingSceneIsNamedAndNothingIsWritten) {
  const Folder folder;
  const Ran ran = run_torsion({"simulate", folder / "none.gltf", "--trace", folder / "t.csv"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("none.gltf"), std::string::npos);
  EXPECT_NE(ran.err.find("No such file"), std::string::npos);
  EXPECT_TRUE(folder.empty());
}

TEST(ProgramBadInputTest, EveryCommandRefusesABadScene) {
  const Folder folder;
  write_text(folder / "bad.gltf", R"({"asset": {"version": "1.0"}})");
  const std::vector<std::vector<std::string>> commands = {
      {"check", folder / "bad.gltf"},
      {"simulate", folder / "bad.gltf", "--trace", folder / "t.csv"},
      {"export", folder / "bad.gltf", "--at", "1", "--out", folder / "d.glb"},
#ifdef TORSION_WITH_RENDER
      {"render", folder / "bad.gltf", "--at", "1", "--out", folder / "p.png"},
#endif
  };
  for (const auto& words : commands) {
    const Ran ran = run_torsion(words);
    EXPECT_EQ(ran.exit_code, 1) << words[0];
    EXPECT_NE((ran.err + ran.out).find("asset.version"), std::string::npos) << words[0];
  }
  std::filesystem::remove(folder / "bad.gltf");
  EXPECT_TRUE(folder.empty());
}

TEST(ProgramBadInputTest, OutputThatCannotBeWrittenIsSaidAndLeavesNothing) {
  const Folder folder;
  write_text(folder / "file", "not a folder");
  const std::vector<std::vector<std::string>> commands = {
      {"simulate", scene("ball_on_cube"), "--seconds", "0.1", "--trace", folder / "file/t.csv"},
      {"export", scene("ball_on_cube"), "--at", "0", "--out", folder / "file/d.glb"},
#ifdef TORSION_WITH_RENDER
      {"render", scene("ball_on_cube"), "--at", "0", "--out", folder / "file/p.png"},
      {"render", scene("ball_on_cube"), "--seconds", "0.1", "--out", folder / "file/v.mp4"},
      {"render", scene("ball_on_cube"), "--seconds", "0.1", "--out", folder / "file/many"},
#endif
  };
  for (const auto& words : commands) {
    const Ran ran = run_torsion(words);
    EXPECT_EQ(ran.exit_code, 1) << testing::PrintToString(words);
    EXPECT_NE(ran.err.find("file/"), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("cannot be written"), std::string::npos) << ran.err;
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace torsion
