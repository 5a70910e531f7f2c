// What torsion report writes, and how large the errors that it measures may be.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/app/program.hpp"

namespace torsion {
namespace {

using test::Folder;
using test::Ran;
using test::read_text;
using test::run_torsion;

constexpr const char* kHeader =
    "scene,contact_model,body_model,cells,anchors,step_us_median,step_us_p99,force_error,"
    "torque_error,twist_error,memory_bytes";

/// Fields of one line; an empty last field counts.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

/// Lines of a report by "scene contact body cells".
std::map<std::string, std::vector<std::string>> rows_of(const std::string& csv) {
  std::map<std::string, std::vector<std::string>> rows;
  std::istringstream stream(csv);
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, kHeader);
  while (std::getline(stream, line)) {
    const std::vector<std::string> fields = fields_of(line);
    EXPECT_EQ(fields.size(), 11U) << line;
    const std::string key = fields[0] + " " + fields[1] + " " + fields[2] + " " + fields[3];
    EXPECT_TRUE(rows.emplace(key, fields).second) << "twice: " << key;
  }
  return rows;
}

/// Largest errors, shares of the largest value; negative: no such reference, the field is empty.
struct Bounds {
  const char* run;
  double force;
  double torque;
  double twist;
};

// What the quick report measures, and a third more: enough for a change of rounding or of the
// steps' order, not for one of a model. What limits each: mdr its layers of springs (torque) and
// the sphere that is no paraboloid (0.1 % of the force); patch the size of its cells, 8 or 12 over
// the contact; on the cubes also the reference's own error (the report states it) and, at nu = 0.3,
// the coupling of pressure and friction, which mdr leaves out (2.8 % of the force).
constexpr Bounds kBounds[] = {
    {"sphere_twist mdr none 256", 0.0002, 0.001, 0.0105},
    {"sphere_twist patch none 64", 0.009, 0.11, 0.07},
    {"sphere_twist patch none 144", 0.005, 0.015, 0.03},
    {"sphere_shear mdr none 256", 0.0016, -1.0, -1.0},
    {"sphere_shear patch none 144", 0.009, -1.0, -1.0},
    {"sphere_slide_and_spin mdr none 256", 0.0045, 0.0042, -1.0},
    // 1.5 % is the goal with 144 cells in contact; here are 76 in a grid of 144.
    {"sphere_slide_and_spin patch none 144", 0.0122, 0.015, -1.0},
    {"half_space mdr none 256", 0.002, 0.0035, 0.017},
    {"half_space patch none 144", 0.009, 0.015, 0.03},
    {"ball_on_cube_nu30 mdr none 256", 0.037, 0.037, 0.015},
    {"ball_on_cube_nu30 patch none 144", 0.02, 0.021, 0.032},
    {"ball_on_cube_nu49 mdr none 256", 0.0014, 0.0065, 0.0105},
    {"ball_on_cube_nu49 patch none 144", 0.01, 0.018, 0.025},
    {"mallet_on_ellipsoid mdr none 256", 0.022, 0.045, -1.0},
    // What auto takes mdr to miss of the torque (mdr_error): of these the overlap's radius over the
    // body's height is 0.06, 0.06, 0.7 and 0.62; the last two are long and slide while they turn.
    {"ball_on_cube_nu30 mdr compliance 256", 0.03, 0.038, 0.02},
    {"ball_on_cube_nu49 mdr compliance 256", 0.03, 0.006, 0.02},
    {"thin_layer mdr compliance 256", 0.04, 0.067, 0.02},
    {"soft_column mdr compliance 256", 0.03, 0.059, 0.045},
    {"mallet_on_ellipsoid mdr compliance 256", 0.03, 0.025, -1.0},
    {"compass_on_ellipsoid mdr compliance 256", 0.03, 0.036, -1.0},
    // Finite bodies: the goal of 3 % of force and torque, but for the mallet's torque, which is one
    // of cells (4.2 % with 12 a side, 1.4 with 16, 0.5 with 24). Of the drawn twist 2 % within a
    // half-space; where the whole body turns, what the discs of 12 cells make of a rim that sticks
    // is off by 3 %.
    {"ball_on_cube_nu30 patch compliance 144", 0.03, 0.03, 0.02},
    {"ball_on_cube_nu49 patch compliance 144", 0.03, 0.03, 0.02},
    {"thin_layer patch compliance 144", 0.03, 0.03, 0.02},
    {"soft_column patch compliance 144", 0.03, 0.03, 0.04},
    {"large_strain_linear patch compliance 144", 0.03, 0.03, 0.04},
    {"mallet_on_ellipsoid patch compliance 144", 0.03, 0.055, -1.0},
    {"compass_on_ellipsoid patch compliance 144", 0.03, 0.03, -1.0},
};

void expect_within(const std::string& field, double bound, const std::string& what) {
  if (bound < 0.0) {
    EXPECT_EQ(field, "") << what;
  } else {
    ASSERT_NE(field, "") << what;
    EXPECT_LE(std::stod(field), bound) << what;
  }
}

/// The first fault of a piece of XML: a tag that does not match, an identifier that was there
/// before. Empty: none.
std::string fault_of_xml(const std::string& xml, std::set<std::string>& identifiers) {
  static const std::regex kTag(
      R"(<(/?)([A-Za-z]+)((?:\s+[A-Za-z0-9:-]+\s*=\s*(?:'[^'<]*'|"[^"<]*"))*)\s*(/?)>)");
  static const std::regex kIdentifier(R"(\sid\s*=\s*['"]([^'"]*)['"])");
  std::vector<std::string> open;
  std::size_t tags = 0;
  for (auto tag = std::sregex_iterator(xml.begin(), xml.end(), kTag); tag != std::sregex_iterator();
       ++tag) {
    ++tags;
    const std::string name = (*tag)[2];
    const std::string attributes = (*tag)[3];
    std::smatch identifier;
    if (std::regex_search(attributes, identifier, kIdentifier) &&
        !identifiers.insert(identifier[1]).second) {
      return "two elements are called " + identifier[1].str();
    }
    if ((*tag)[1].length() == 0) {
      if ((*tag)[4].length() == 0) {
        open.push_back(name);
      }
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> closes nothing";
    } else {
      open.pop_back();
    }
  }
  const auto angles = static_cast<std::size_t>(std::count(xml.begin(), xml.end(), '<'));
  return angles != tags ? "something that is no tag"
                        : (open.empty() ? "" : open.back() + " is open");
}

TEST(ReportTest, QuickErrorsStayWithinTheirBounds) {
  const Folder folder;
  const Ran ran = run_torsion({"report", "--quick", "--quiet", "--out", folder / "made"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.out, "");
  const auto rows = rows_of(read_text(folder / "made/report.csv"));
  for (const Bounds& bounds : kBounds) {
    const std::string run = bounds.run;
    const auto row = rows.find(run);
    ASSERT_NE(row, rows.end()) << run;
    expect_within(row->second[7], bounds.force, run + ": force");
    expect_within(row->second[8], bounds.torque, run + ": torque");
    expect_within(row->second[9], bounds.twist, run + ": twist");
  }
  for (const auto& [run, fields] : rows) {
    const double median = std::stod(fields[5]);
    EXPECT_GT(median, 0.0) << run;
    EXPECT_GE(std::stod(fields[6]), median) << run;
    EXPECT_GT(std::stod(fields[10]), 1000.0) << run;
    EXPECT_TRUE(fields[7].empty() || std::isfinite(std::stod(fields[7]))) << run;
  }
}

TEST(ReportTest, QuickPageNeedsNothingElse) {
  const Folder folder;
  const Ran ran = run_torsion({"report", "--quick", "--out", folder / "made"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.out, (folder / "made/report.csv") + "\n" + (folder / "made/report.html") + "\n");
  const std::string page = read_text(folder / "made/report.html");
  for (const char* outside :
       {"http://", "https://", "file:", "<script", "<link", "@import", "url(h"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  const std::string source = "src=\"";
  for (std::size_t at = page.find(source); at != std::string::npos;
       at = page.find(source, at + 1)) {
    EXPECT_EQ(page.compare(at + source.size(), 5, "data:"), 0) << page.substr(at, 60);
  }
  std::set<std::string> identifiers;
  std::size_t plots = 0;
  for (std::size_t at = page.find("<svg"); at != std::string::npos;
       at = page.find("<svg", at + 1)) {
    const std::string end = "</svg>";
    const std::size_t stop = page.find(end, at);
    ASSERT_NE(stop, std::string::npos);
    const std::string svg = page.substr(at, stop + end.size() - at);
    EXPECT_EQ(fault_of_xml(svg, identifiers), "") << "plot " << plots;
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    ++plots;
  }
  // Two over all cases; three for each of the exact ones, and a field for the first of them, less
  // the loop that sliding has not.
  EXPECT_GE(plots, 11U);
  EXPECT_NE(page.find("@media print"), std::string::npos);
  // Nobody is to take the cells of a grid for those in contact.
  EXPECT_NE(page.find("<th>grid cells</th>"), std::string::npos);
  EXPECT_EQ(page.find("<th>cells</th>"), std::string::npos);
  EXPECT_NE(page.find("<dt>grid cells</dt>"), std::string::npos);
  EXPECT_NE(page.find("Numbers at patch: grid cells of a region."), std::string::npos);
  EXPECT_EQ(page.find("Numbers at patch: cells"), std::string::npos);
}

TEST(ReportTest, FolderThatCannotBeMadeIsSaid) {
  const Folder folder;
  test::write_text(folder / "file", "");
  const Ran ran = run_torsion({"report", "--quick", "--out", folder / "file/report"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("file"), std::string::npos) << ran.err;
}

/// How long something took, s.
template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The whole report takes minutes: it is over within this only if nothing was measured.
constexpr double kWithoutMeasuring = 15.0;  // s

TEST(ReportTest, FileThatCannotBeWrittenIsSaidBeforeMeasuring) {
  for (const char* name : {"report.csv", "report.html"}) {
    const Folder folder;
    std::filesystem::create_directory(folder / name);
    Ran ran;
    EXPECT_LT(seconds_of([&] {
                ran = run_torsion({"report", "--out", folder / ""});
              }),
              kWithoutMeasuring);
    EXPECT_EQ(ran.exit_code, 1) << name;
    EXPECT_NE(ran.err.find(std::string(name) + ": cannot be written: it is a folder"),
              std::string::npos)
        << ran.err;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << name;
  }
}

TEST(ReportTest, MissingGnuplotIsSaidBeforeMeasuring) {
  const Folder folder;
  std::vector<std::string> words = test::torsion({"report", "--out", folder / "made"});
  words.insert(words.begin(), {"/usr/bin/env", "PATH=" + (folder / "nothing")});
  Ran ran;
  EXPECT_LT(seconds_of([&] { ran = test::Process(words).wait(); }), kWithoutMeasuring);
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("install the package gnuplot-nox"), std::string::npos) << ran.err;
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace torsion
