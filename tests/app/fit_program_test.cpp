// torsion fit: what it reads, writes and refuses.

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.hpp"

namespace torsion::engine {
namespace {

TEST(FitProgramTest, ATraceOfTheProgramGivesBackItsScene) {
  const test::Folder folder;
  const std::string trace = folder / "trace.csv";
  const std::vector<std::string> models = {"--contact-model", "mdr", "--body-model", "none"};
  std::vector<std::string> words = {
      "simulate", test::scene("ball_on_cube"), "--set",   "cube.youngs_modulus=1.2e6",
      "--set",    "cube.friction=0.4",         "--trace", trace,
      "--quiet"};
  words.insert(words.end(), models.begin(), models.end());
  ASSERT_EQ(test::run_torsion(words).exit_code, 0);
  words = {"fit",
           test::scene("ball_on_cube"),
           trace,
           "--free",
           "cube.youngs_modulus,cube.friction",
           "--json",
           "--report",
           folder / "fit.html",
           "--out",
           folder / "fit.csv"};
  words.insert(words.end(), models.begin(), models.end());
  const test::Ran ran = test::run_torsion(words);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const nlohmann::json found = nlohmann::json::parse(ran.out);
  // A trace has nine digits.
  EXPECT_NEAR(found["parameters"]["cube.youngs_modulus"]["value"].get<double>(), 1.2e6, 1e2);
  EXPECT_NEAR(found["parameters"]["cube.friction"]["value"].get<double>(), 0.4, 1e-4);
  EXPECT_TRUE(found["warnings"].empty()) << found["warnings"];
  const std::string page = test::read_text(folder / "fit.html");
  for (const char* const word :
       {"<svg", "cube.youngs_modulus (Pa)", "torque_y_Nm", "Correlation"}) {
    EXPECT_NE(page.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(page.find("http"), page.find("http://www.w3.org"));  // nothing is loaded
  const std::string table = test::read_text(folder / "fit.csv");
  EXPECT_EQ(table.find("time_s,force_x_N,force_x_N_model,"), 0U);
}

TEST(FitProgramTest, ColumnsOfOtherNamesUnitsAndPlacesAreRead) {
  const test::Folder folder;
  const std::string trace = folder / "trace.csv";
  ASSERT_EQ(test::run_torsion({"simulate", test::scene("ball_on_cube"), "--contact-model", "mdr",
                               "--body-model", "none", "--trace", trace, "--quiet"})
                .exit_code,
            0);
  // The vertical force in mN downwards, the torque about a point of the ball's equator, which turns
  // with it; where the ball is, the file's own animation says.
  std::string text = "t,fz,tz\n";
  std::istringstream lines(test::read_text(trace));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = test::fields_of(line);
  while (std::getline(lines, line)) {
    const std::vector<std::string> row = test::fields_of(line);
    const auto at = [&](const char* name) {
      return std::stod(
          row[static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())]);
    };
    // T - p x F for p = 0.02 m (cos, 0, -sin) of the turn about y.
    const double cosine = 1.0 - 2.0 * at("tool_qy") * at("tool_qy");
    const double force = at("force_y_N");
    text += fmt::format("{},{},{}\n", at("time_s"), -1e3 * force,
                        at("torque_z_Nm") - 0.02 * cosine * force);
  }
  test::write_text(folder / "lab.csv", text);
  const test::Ran ran = test::run_torsion({"fit",
                                           test::scene("ball_on_cube"),
                                           folder / "lab.csv",
                                           "--free",
                                           "cube.youngs_modulus",
                                           "--set",
                                           "cube.youngs_modulus=1e5",
                                           "--contact-model",
                                           "mdr",
                                           "--body-model",
                                           "none",
                                           "--json",
                                           "--column",
                                           "time_s=t",
                                           "--column",
                                           "force_y_N=fz*-1e-3",
                                           "--column",
                                           "torque_z_Nm=tz",
                                           "--torque-about",
                                           "0.02,0,0"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const nlohmann::json found = nlohmann::json::parse(ran.out);
  EXPECT_NEAR(found["parameters"]["cube.youngs_modulus"]["value"].get<double>(), 3e6, 3e2);
  EXPECT_GT(found["largest_torque_Nm"].get<double>(), 0.1);
  EXPECT_LT(found["torque_deviation_Nm"].get<double>(),
            1e-5 * found["largest_torque_Nm"].get<double>());
}

TEST(FitProgramTest, WhatIsWrongIsSaid) {
  const test::Folder folder;
  const std::string path = folder / "measured.csv";
  std::string good = "time_s,force_y_N\n";
  for (int k = 0; k < 12; ++k) {
    good += fmt::format("{},{}\n", 0.01 * k, 0.1 * k);
  }
  struct Case {
    std::string text;
    std::vector<std::string> words;
    int exit_code;
    const char* expected;
  };
  const std::vector<std::string> modulus = {"--free", "cube.youngs_modulus"};
  for (const Case& each : std::vector<Case>{
           {"", modulus, 1, "has no rows of numbers"},
           {"time_s,force_y_N\n", modulus, 1, "has no rows of numbers"},
           {"time_s,force_y_N\n0,1\n1\n", modulus, 1, "row 3 has 1 fields; expected 2"},
           {"time_s,force_y_N\n0,1\n1,2,3\n", modulus, 1, "row 3 has 3 fields; expected 2"},
           {"time_s,force_y_N\n0,nan\n", modulus, 1, "column 2 (force_y_N): \"nan\""},
           {"time_s,force_y_N\n0,\"1\n", modulus, 1, "row 2"},
           {"time_s,time_s\n0,1\n", modulus, 1, "two columns are named \"time_s\""},
           {"time_s,force_y_N\n0,1\n1,2\n", modulus, 1, "expected at least 10"},
           {good + "0.05,1\n", modulus, 1, "row 14: time_s is 0.05 after 0.11"},
           {"t" + good, modulus, 1, "--column time_s=NAME"},
           {"time_s,load\n0,1\n", modulus, 1, "expected at least 10"},
           {good, {"--free", "cube.stiffness"}, 1, "has no \"stiffness\""},
           {good, {"--free", "cub.friction"}, 1, "no elastic node or tool \"cub\""},
           {good, {"--free", "friction"}, 1, "expected NODE.KEY"},
           {good, {"--free", "cube.friction,cube.friction"}, 1, "named twice"},
           {good, {"--free", "cube.friction", "--column", "force_z_N=Fz"}, 1, "no column \"Fz\""},
           {good,
            {"--free", "cube.friction", "--column", "forcez=force_y_N"},
            1,
            "expected one of"},
           {good, {"--free", "cube.friction", "--column", "force_y_N"}, 1, "NAME=COLUMN*FACTOR"},
           {good, {"--free", "cube.friction", "--column", "time_s=time_s*1e6"}, 1, "is it in s?"},
           {good,
            {"--free", "cube.friction", "--out", path + "/fit.csv"},
            1,
            "measured.csv/fit.csv"},
           {good, modulus, 1, "no tool touches a body"},  // a tenth of a second: still above it
           {good, {}, 2, "--free"}}) {
    SCOPED_TRACE(each.expected);
    test::write_text(path, each.text);
    std::vector<std::string> words = {"fit", test::scene("ball_on_cube"), path};
    words.insert(words.end(), each.words.begin(), each.words.end());
    const test::Ran ran = test::run_torsion(words);
    EXPECT_EQ(ran.exit_code, each.exit_code) << ran.err;
    EXPECT_NE(ran.err.find(each.expected), std::string::npos) << ran.err;
  }
  EXPECT_EQ(test::run_torsion({"fit", test::scene("ball_on_cube"), folder / "none.csv", "--free",
                               "cube.friction"})
                .exit_code,
            1);
}

}  // namespace
}  // namespace torsion::engine
