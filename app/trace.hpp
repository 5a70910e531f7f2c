#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/table_file.hpp"
#include "ecs/scene_description.hpp"
#include "ecs/world.hpp"
#include "systems/contact/tool_load.hpp"

namespace torsion::engine {

/// What a trace may say of one tool in one step (docs/guide.md has the columns).
struct TraceRow {
  double time = 0.0;  // s
  Pose pose;          // tool frame in the world
  Wrench wrench;      // on the tool, about its mass centre, world
  double work = 0.0;  // J
  double step_us = 0.0;
  std::uint32_t cells = 0;        // that carry pressure
  std::uint32_t stuck_cells = 0;  // of those
  std::uint32_t faults = 0;       // of the step
  ToolLoad load;                  // about the mass centre
  // Of the region with the largest normal force; without one zero.
  double depth = 0.0;                // m
  double turn = 0.0;                 // rad: of the tool since the region formed
  double twist = 0.0;                // rad: of the body's surface where it sticks
  glm::dvec3 velocity{0.0};          // m/s, world: of the mass centre
  glm::dvec3 angular_velocity{0.0};  // rad/s, world
};

/// Names of the scene's tools, in their order.
std::vector<std::string> tool_names(const SceneDescription& scene);

/// What stands before a tool's columns: nothing where there is one tool, else its name and "_".
std::string trace_prefix(const std::vector<std::string>& tool_names, std::size_t tool);

/// The row of `tool` after a step that took `step_us` [us]. Allocates nothing.
TraceRow trace_row(const World& world, std::uint32_t tool, double step_us);

struct TraceColumn;  // app/trace_columns.hpp
struct WorkByKind;

/// Writes rows as CSV or HDF5; the file appears when it is whole.
class TraceWriter {
 public:
  /// @param tool_names  one for each tool; with several the columns are named after them
  /// @param columns     of each tool; there are also time_s and step_us
  static Result<TraceWriter> create(const std::filesystem::path& path,
                                    const std::vector<std::string>& tool_names,
                                    std::vector<TraceColumn> columns);
  TraceWriter(TraceWriter&&) noexcept;
  TraceWriter& operator=(TraceWriter&&) noexcept;
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;
  ~TraceWriter();

  /// One line. @pre as many rows as tools
  void append(std::span<const TraceRow> rows);

  Result<Done> finish();

 private:
  TraceWriter(TableFile file, std::vector<TraceColumn> columns, std::size_t tools);
  TableFile file_;
  std::vector<TraceColumn> columns_;
  std::vector<WorkByKind> work_;  // (tools)
  std::vector<TraceRow> before_;  // (tools); none before the first
  std::vector<double> numbers_;
};

}  // namespace torsion::engine
