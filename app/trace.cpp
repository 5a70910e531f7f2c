#include "app/trace.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

namespace torsion::engine {
namespace {

constexpr std::array kToolColumns = {
    "tool_x_m",    "tool_y_m",    "tool_z_m",    "tool_qx",        "tool_qy",   "tool_qz",
    "tool_qw",     "regions",     "cells",       "force_x_N",      "force_y_N", "force_z_N",
    "torque_x_Nm", "torque_y_Nm", "torque_z_Nm", "stick_fraction", "energy_J"};

/// A name without what would break a CSV header.
std::string plain(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char letter) { return std::isalnum(letter) == 0; }, '_');
  return name;
}

}  // namespace

TraceRow trace_row(const World& world, std::uint32_t tool, double step_us) {
  TraceRow row;
  row.time = world.state.clock.time;
  row.pose = world.state.tools.at<ToolPose>(tool).now;
  row.wrench = world.state.tools.at<ToolWrench>(tool).total;
  row.work = world.state.tools.at<ToolWrench>(tool).work;
  row.step_us = step_us;
  for (const RegionIdentity& region : world.state.regions.column<RegionIdentity>()) {
    if (region.tool != tool) {
      continue;
    }
    row.regions += 1;
    for (const CellTraction& cell : world.state.cells.rows<CellTraction>(region.cells)) {
      row.cells += cell.pressure > 0.0 ? 1U : 0U;
      row.stuck_cells += cell.pressure > 0.0 ? cell.sticks : 0U;
    }
  }
  return row;
}

Result<TraceWriter> TraceWriter::create(const std::filesystem::path& path,
                                        const std::vector<std::string>& tool_names) {
  Result<OutputFile> file = OutputFile::create(path);
  if (!file) {
    return file.error();
  }
  TraceWriter writer(std::move(file).value());
  std::string header = "time_s";
  for (const std::string& name : tool_names) {
    const std::string prefix = tool_names.size() > 1 ? plain(name) + "_" : "";
    for (const char* column : kToolColumns) {
      header += "," + prefix + column;
    }
  }
  writer.file_.write(header + ",step_us\n");
  return writer;
}

void TraceWriter::append(std::span<const TraceRow> rows) {
  fmt::memory_buffer line;
  const auto add = [&line](double number) {
    fmt::format_to(fmt::appender(line), ",{:.9g}", number);
  };
  fmt::format_to(fmt::appender(line), "{:.9g}", rows[0].time);
  for (const TraceRow& row : rows) {
    const glm::dquat& q = row.pose.rotation;
    for (const double number :
         {row.pose.position.x, row.pose.position.y, row.pose.position.z, q.x, q.y, q.z, q.w}) {
      add(number);
    }
    fmt::format_to(fmt::appender(line), ",{},{}", row.regions, row.cells);
    for (const double number : {row.wrench.force.x, row.wrench.force.y, row.wrench.force.z,
                                row.wrench.torque.x, row.wrench.torque.y, row.wrench.torque.z}) {
      add(number);
    }
    add(row.cells == 0 ? 0.0
                       : static_cast<double>(row.stuck_cells) / static_cast<double>(row.cells));
    add(row.work);
  }
  add(rows[0].step_us);
  line.push_back('\n');
  file_.write({line.data(), line.size()});
}

Result<Done> TraceWriter::finish() {
  return file_.commit();
}

}  // namespace torsion::engine
