// What the columns of traces say, against each other and against exact solutions; the same numbers
// as CSV and as HDF5, which pandas reads.

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/app/program.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

using test::fields_of;
using test::Folder;
using test::Ran;
using test::read_text;
using test::run_torsion;
using test::scene;

/// Rows of a CSV file by their columns' names.
std::vector<std::map<std::string, double>> named_rows(const std::string& path) {
  std::istringstream lines(read_text(path));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = fields_of(line);
  std::vector<std::map<std::string, double>> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> fields = fields_of(line);
    EXPECT_EQ(fields.size(), names.size());
    auto& row = rows.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k) {
      row[names[k]] = std::stod(fields[k]);
    }
  }
  return rows;
}

TEST(TraceColumnsTest, PartsAddUpToWhatIsOutput) {
  const Folder folder;
  const std::string path = folder / "trace.csv";
  for (const char* const name : {"ball_on_cube", "compass_on_ellipsoid"}) {
    SCOPED_TRACE(name);
    const Ran ran = run_torsion({"simulate", scene(name), "--contact-model", "mdr", "--body-model",
                                 "none", "--trace", path, "--columns", "all", "--quiet"});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const auto rows = named_rows(path);
    double most_energy = 0.0;
    std::size_t in_contact = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      auto row = rows[k];
      most_energy = std::max(most_energy, std::abs(row["energy_J"]));
      // What events fade is over 10 ms after them: where the regions are those of 20 rows before.
      if (k < 20 || row["regions"] == 0.0 || rows[k - 20].at("regions") != row["regions"]) {
        continue;
      }
      ++in_contact;
      const double force = std::abs(row["normal_force_N"]);
      for (const char axis : {'x', 'y', 'z'}) {
        const auto at = [&](const char* form) {
          return row[fmt::format(fmt::runtime(form), axis)];
        };
        EXPECT_NEAR(at("force_{}_N"), at("normal_force_{}_N") + at("friction_{}_N"), 1e-7 * force);
        EXPECT_NEAR(at("torque_{}_Nm"), at("couple_{}_Nm") + at("lever_torque_{}_Nm"),
                    1e-8 * force);
      }
      EXPECT_LE(
          std::hypot(row["normal_force_x_N"], row["normal_force_y_N"], row["normal_force_z_N"]),
          force * (1.0 + 1e-6));
    }
    EXPECT_GT(in_contact, 1000U);
    auto last = rows.back();
    // The parts do without the fades of the first contact and the last.
    EXPECT_NEAR(last["work_normal_J"] + last["work_friction_J"] + last["work_couple_J"],
                last["energy_J"], 2e-3 * most_energy);
    EXPECT_EQ(last["faults"], 0.0);
  }
}

TEST(TraceColumnsTest, RegionsAreThoseOfTheTrace) {
  const Folder folder;
  const std::string trace = folder / "trace.csv";
  const std::string regions = folder / "regions.csv";
  const Ran ran = run_torsion({"simulate", scene("compass_on_ellipsoid"), "--contact-model", "mdr",
                               "--body-model", "none", "--trace", trace, "--columns", "all",
                               "--regions", regions, "--quiet"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  std::map<double, std::map<std::string, double>> sums;
  for (auto row : named_rows(regions)) {
    auto& sum = sums[row["time_s"]];
    sum["regions"] += 1.0;
    sum["force"] += row["normal_force_N"];
    sum["y"] += row["couple_Nm"] * row["normal_y"];
    EXPECT_NEAR(std::hypot(row["normal_x"], row["normal_y"], row["normal_z"]), 1.0, 1e-8);
    EXPECT_NEAR(row["normal_x"] * row["tangent_x"] + row["normal_y"] * row["tangent_y"] +
                    row["normal_z"] * row["tangent_z"],
                0.0, 1e-8);
    // Coulomb, and no couple beyond that of sliding everywhere.
    const double friction = std::hypot(row["friction_1_N"], row["friction_2_N"]);
    EXPECT_LE(friction, 0.75 * row["normal_force_N"] * (1.0 + 1e-6));
    EXPECT_LE(std::abs(row["couple_Nm"]), 3.0 * std::numbers::pi / 16.0 * 0.75 *
                                              row["normal_force_N"] * row["radius_m"] *
                                              (1.0 + 1e-3));
  }
  double most = 0.0;
  for (auto row : named_rows(trace)) {
    most = std::max(most, row["regions"]);
    auto sum = sums[row["time_s"]];
    EXPECT_EQ(sum["regions"], row["regions"]);
    EXPECT_NEAR(sum["force"], row["normal_force_N"], 1e-7 * sum["force"]);
    EXPECT_NEAR(sum["y"], row["couple_y_Nm"], 1e-9 * sum["force"]);
  }
  EXPECT_EQ(most, 2.0);
}

TEST(TraceColumnsTest, TheyAreAsAskedForAndInThatOrder) {
  const Folder folder;
  const std::string path = folder / "trace.csv";
  const auto header = [&](const std::string& columns) {
    const Ran ran = run_torsion({"simulate", scene("ball_on_cube"), "--seconds", "0.01", "--trace",
                                 path, "--columns", columns, "--quiet"});
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    const std::string text = read_text(path);
    return text.substr(0, text.find('\n'));
  };
  EXPECT_EQ(header("turn_rad,depth_m"), "time_s,turn_rad,depth_m,step_us");
  EXPECT_EQ(header("usual").find("time_s,tool_x_m,"), 0U);
  EXPECT_NE(header("usual,couple_y_Nm").find(",energy_J,couple_y_Nm,step_us"), std::string::npos);
}

TEST(TraceColumnsTest, WhatCannotBeIsSaid) {
  const Folder folder;
  struct Case {
    std::vector<std::string> words;
    int exit_code;
    const char* expected;
  };
  for (const Case& each : std::vector<Case>{
           {{"--trace", folder / "t.csv", "--columns", "depth"}, 1, "no column \"depth\""},
           {{"--trace", folder / "t.csv", "--columns", "dept_m"}, 1, "did you mean \"depth_m\""},
           {{"--trace", folder / "t.csv", "--columns", "usual,force_x_N"}, 1, "named twice"},
           {{"--columns", "depth_m"}, 2, "--trace"},
           {{"--trace", "/dev/null/t.h5"}, 1, "/dev/null/t.h5"},
           {{"--regions", folder / "r.csv", "--realtime"}, 2, "--realtime"}}) {
    SCOPED_TRACE(each.expected);
    std::vector<std::string> words = {"simulate", scene("ball_on_cube"), "--seconds", "0.01"};
    words.insert(words.end(), each.words.begin(), each.words.end());
    const Ran ran = run_torsion(words);
    EXPECT_EQ(ran.exit_code, each.exit_code);
    EXPECT_NE((ran.err + ran.out).find(each.expected), std::string::npos) << ran.err;
  }
  EXPECT_TRUE(folder.empty());
}

TEST(TraceColumnsTest, HasTheSameNumbersAsHdf5WhichPandasReads) {
  const Folder folder;
  for (const char* const ending : {".csv", ".h5"}) {
    Ran ran =
        run_torsion({"simulate", scene("ball_on_cube"), "--trace", folder / "trace" + ending,
                     "--columns", "all", "--regions", folder / "regions" + ending, "--quiet"});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    ran = run_torsion({"sweep", scene("ball_on_cube"), "--set", "cube.contact_model=mdr,winkler",
                       "--set", "cube.friction=0.2:0.8:3", "--body-model", "none", "--columns",
                       "max:couple_y_Nm,mean:stick_fraction", "--out", folder / "runs" + ending,
                       "--quiet"});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
  }
  // Debian's Python, which has its pandas.
  const Ran ran =
      test::Process({"/usr/bin/python3", test::source_folder() + "/tests/app/compare_hdf5.py",
                     folder.path().string()})
          .wait();
  EXPECT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("runs: 6 rows"), std::string::npos) << ran.out;
}

}  // namespace
}  // namespace torsion::engine
