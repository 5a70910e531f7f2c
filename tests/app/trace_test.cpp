#include <algorithm>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

#include "app/trace_columns.hpp"

namespace torsion::engine {
namespace {

std::string written(const std::vector<std::string>& tools, const std::vector<TraceRow>& rows) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("torsion_trace_" + std::to_string(::getpid()) + ".csv");
  Result<TraceWriter> writer = TraceWriter::create(path, tools, usual_trace_columns());
  EXPECT_TRUE(writer.ok());
  writer.value().append(rows);
  EXPECT_TRUE(writer.value().finish().ok());
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::filesystem::remove(path);
  return text;
}

TEST(TraceTest, WritesNineDigitsAndTheShareThatSticks) {
  TraceRow row;
  row.time = 0.123;
  row.pose.position = {1.0 / 3.0, -2e-7, 0.0};
  row.wrench.force.y = 12.5;
  row.load.regions = 1;
  row.cells = 200;
  row.stuck_cells = 50;
  row.work = -1.5;
  row.step_us = 17.25;
  const std::string text = written({"ball"}, {row});
  EXPECT_EQ(text.substr(text.find('\n') + 1),
            "0.123,0.333333333,-2e-07,0,0,0,0,1,1,200,0,12.5,0,0,0,0,0.25,-1.5,17.25\n");
}

TEST(TraceTest, SeveralToolsHaveColumnsNamedAfterThem) {
  const std::string text = written({"left hand", "right,hand"}, {TraceRow{}, TraceRow{}});
  const std::string header = text.substr(0, text.find('\n'));
  EXPECT_EQ(header.rfind("time_s,left_hand_tool_x_m,", 0), 0U);
  EXPECT_NE(header.find(",right_hand_energy_J,step_us"), std::string::npos);
  // time, twice 17 columns, the step's time
  EXPECT_EQ(std::ranges::count(header, ','), 35);
  EXPECT_EQ(std::ranges::count(text, ','), 70);
}

}  // namespace
}  // namespace torsion::engine
