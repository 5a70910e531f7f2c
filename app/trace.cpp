#include "app/trace.hpp"

#include <algorithm>
#include <cctype>

#include "app/trace_columns.hpp"

namespace torsion::engine {
namespace {

/// A name without what would break a CSV header.
std::string plain(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char letter) { return std::isalnum(letter) == 0; }, '_');
  return name;
}

}  // namespace

std::vector<std::string> tool_names(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const ToolDescription& tool : scene.tools) {
    names.push_back(tool.node);
  }
  return names;
}

std::string trace_prefix(const std::vector<std::string>& tool_names, std::size_t tool) {
  return tool_names.size() > 1 ? plain(tool_names[tool]) + "_" : "";
}

TraceRow trace_row(const World& world, std::uint32_t tool, double step_us) {
  const State& state = world.state;
  const ToolMotion& motion = state.tools.at<ToolMotion>(tool);
  TraceRow row;
  row.time = state.clock.time;
  row.pose = state.tools.at<ToolPose>(tool).now;
  row.wrench = state.tools.at<ToolWrench>(tool).total;
  row.work = state.tools.at<ToolWrench>(tool).work;
  row.step_us = step_us;
  row.faults = state.clock.faults;
  row.velocity = motion.velocity;
  row.angular_velocity = motion.angular_velocity;
  row.load = tool_load(state, tool, motion.mass_center);
  if (row.load.regions > 0) {
    const std::uint32_t region = row.load.main_region;
    row.depth = state.regions.at<Contact>(region).depth;
    row.turn = state.regions.at<RegionMotion>(region).turn;
    row.twist = state.regions.at<RegionFriction>(region).stick_turn;
  }
  for (const RegionIdentity& region : state.regions.column<RegionIdentity>()) {
    if (region.tool != tool) {
      continue;
    }
    for (const CellTraction& cell : state.cells.rows<CellTraction>(region.cells)) {
      row.cells += cell.pressure > 0.0 ? 1U : 0U;
      row.stuck_cells += cell.pressure > 0.0 ? cell.sticks : 0U;
    }
  }
  return row;
}

TraceWriter::TraceWriter(TableFile file, std::vector<TraceColumn> columns, std::size_t tools)
    : file_(std::move(file)), columns_(std::move(columns)), work_(tools) {}
TraceWriter::TraceWriter(TraceWriter&&) noexcept = default;
TraceWriter& TraceWriter::operator=(TraceWriter&&) noexcept = default;
TraceWriter::~TraceWriter() = default;

Result<TraceWriter> TraceWriter::create(const std::filesystem::path& path,
                                        const std::vector<std::string>& tool_names,
                                        std::vector<TraceColumn> columns) {
  std::vector<std::string> names = {"time_s"};
  for (std::size_t tool = 0; tool < tool_names.size(); ++tool) {
    const std::string prefix = trace_prefix(tool_names, tool);
    for (const TraceColumn& column : columns) {
      names.push_back(prefix + std::string(column.name));
    }
  }
  names.emplace_back("step_us");
  Result<TableFile> file = TableFile::create(path, "trace", names);
  if (!file) {
    return file.error();
  }
  return TraceWriter(std::move(file).value(), std::move(columns), tool_names.size());
}

void TraceWriter::append(std::span<const TraceRow> rows) {
  numbers_.assign(1, rows[0].time);
  for (std::size_t tool = 0; tool < rows.size(); ++tool) {
    if (!before_.empty()) {
      work_[tool].add(before_[tool], rows[tool]);
    }
    for (const TraceColumn& column : columns_) {
      numbers_.push_back(column.of(rows[tool], work_[tool]));
    }
  }
  numbers_.push_back(rows[0].step_us);
  file_.append(numbers_);
  before_.assign(rows.begin(), rows.end());
}

Result<Done> TraceWriter::finish() {
  return file_.finish();
}

}  // namespace torsion::engine
