// Values over what a scene says: --set of one run, and a sweep over many.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.hpp"

namespace torsion::engine {
namespace {

using nlohmann::json;
using test::fields_of;
using test::Folder;
using test::Process;
using test::Ran;
using test::read_text;
using test::run_torsion;
using test::scene;

std::vector<std::string> table_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// A sweep of ball_on_cube's first half second with mdr.
std::vector<std::string> sweep_words(const std::string& out,
                                     const std::vector<std::string>& settings) {
  std::vector<std::string> words = {"sweep",           scene("ball_on_cube"),
                                    "--contact-model", "mdr",
                                    "--body-model",    "none",
                                    "--seconds",       "0.5",
                                    "--out",           out};
  for (const std::string& setting : settings) {
    words.insert(words.end(), {"--set", setting});
  }
  return words;
}

TEST(SettingTest, AValueIsPutOverWhatTheSceneSays) {
  std::vector<double> forces;
  for (const char* const modulus : {"1e6", "2e6"}) {
    const Ran ran =
        run_torsion({"simulate", scene("ball_on_cube"), "--contact-model", "mdr", "--body-model",
                     "none", "--json", "--set", std::string("cube.youngs_modulus=") + modulus});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    forces.push_back(json::parse(ran.out)["peak_force_N"].get<double>());
  }
  // The animation imposes the poses: every force goes with the modulus.
  EXPECT_NEAR(forces[1], 2.0 * forces[0], 1e-6 * forces[1]);
}

TEST(SettingTest, WhatCannotBeSetIsSaid) {
  struct Case {
    const char* setting;
    int exit_code;
    std::vector<const char*> words;
  };
  for (const Case& each : std::vector<Case>{
           {"cube", 2, {"NODE.KEY=VALUE"}},
           {"cube.youngs_modulus", 2, {"NODE.KEY=VALUE"}},
           {"cub.youngs_modulus=1", 1, {"no elastic node or tool \"cub\"", "cube", "ball"}},
           {"cube.young_modulus=1", 1, {"did you mean \"youngs_modulus\"", "dynamic_friction"}},
           {"cube.youngs_modulus=soft", 1, {"a number above 0 (Pa)"}},
           {"cube.poisson_ratio=0.6", 1, {"a number from 0 to 0.5"}},
           {"cube.contact_model=rubber", 1, {"expected one of", "patch"}},
           {"cube.static_friction=0.1", 1, {"static_friction of 0.1", "set both"}},
           {"ball.mass=0", 1, {"a number above 0 (kg)"}},
           {"ball.density=1", 1, {"a tool has no \"density\""}}}) {
    SCOPED_TRACE(each.setting);
    const Ran ran = run_torsion({"simulate", scene("ball_on_cube"), "--set", each.setting});
    EXPECT_EQ(ran.exit_code, each.exit_code);
    for (const char* const word : each.words) {
      EXPECT_NE(ran.err.find(word), std::string::npos) << word << " in: " << ran.err;
    }
  }
  const Ran ran = run_torsion(
      {"simulate", scene("ball_on_cube"), "--set", "cube.density=1", "--record", "r.torsion"});
  EXPECT_EQ(ran.exit_code, 2);
}

TEST(SweepTest, EveryCombinationIsARowAndWorkersDoNotMatter) {
  const Folder folder;
  std::vector<std::string> tables;
  for (const char* const jobs : {"1", "2"}) {
    const std::string out = folder / (std::string("table") + jobs + ".csv");
    std::vector<std::string> words =
        sweep_words(out, {"cube.youngs_modulus=1e5:1e7:3log", "cube.dynamic_friction=0.2,0.4"});
    words.insert(words.end(), {"--jobs", jobs});
    const Ran ran = run_torsion(words);
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    tables.push_back(read_text(out));
    EXPECT_FALSE(std::filesystem::exists(out + ".partial"));
  }
  EXPECT_EQ(tables[0], tables[1]);
  const std::vector<std::string> lines = table_lines(tables[0]);
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[0].find("run,cube.youngs_modulus,cube.dynamic_friction,contact_models,"), 0U);
  const std::vector<std::string> first = fields_of(lines[1]);
  const std::vector<std::string> last = fields_of(lines[6]);
  ASSERT_EQ(first.size(), fields_of(lines[0]).size());
  EXPECT_EQ(first[1], "1e5");
  EXPECT_EQ(std::stod(fields_of(lines[3])[1]), 1e6);
  EXPECT_EQ(last[1], "1e7");
  EXPECT_EQ(last[2], "0.4");
  // A hundred times the modulus, and pressing alone: half a second goes straight down.
  EXPECT_NEAR(std::stod(last[8]), 100.0 * std::stod(first[8]), 1e-4 * std::stod(last[8]));
}

TEST(SweepTest, AStoppedSweepGoesOn) {
  const Folder folder;
  const std::string setting = "cube.dynamic_friction=0.1:0.7:60";
  const std::string out = folder / "stopped.csv";
  const std::string partial = out + ".partial";
  {
    Process process(test::torsion(sweep_words(out, {setting})));
    for (int wait = 0; wait < 1000; ++wait) {
      if (std::filesystem::exists(partial) && table_lines(read_text(partial)).size() > 3) {
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    process.send(SIGTERM);
    const Ran ran = process.wait();
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_NE(ran.err.find("the same command goes on"), std::string::npos) << ran.err;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
  const Ran ran = run_torsion(sweep_words(out, {setting}));
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.out.find(" 0 of them found done"), std::string::npos) << ran.out;
  const std::string whole = folder / "whole.csv";
  ASSERT_EQ(run_torsion(sweep_words(whole, {setting})).exit_code, 0);
  EXPECT_EQ(read_text(out), read_text(whole));
}

TEST(SweepTest, ValuesThatCannotBeAreSaidBeforeAnyRun) {
  const Folder folder;
  const std::string out = folder / "table.csv";
  for (const auto& [setting, word] : std::vector<std::pair<std::string, std::string>>{
           {"cube.youngs_modulus=1e4:1e6", "FIRST:LAST:COUNT"},
           {"cube.youngs_modulus=0:1e6:3log", "FIRST:LAST:COUNT"},
           {"cube.youngs_modulus=1e4,,1e5", "commas between"},
           {"cube.youngs_modulus=1:2:1000000000", "FIRST:LAST:COUNT"}}) {
    const Ran ran = run_torsion(sweep_words(out, {setting}));
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_NE(ran.err.find(word), std::string::npos) << ran.err;
  }
  const Ran ran = run_torsion(sweep_words(out, {"cube.density=1,2", "cube.density=3,4"}));
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("twice"), std::string::npos) << ran.err;
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace torsion::engine
