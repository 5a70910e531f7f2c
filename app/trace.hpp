#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/output_file.hpp"
#include "ecs/world.hpp"

namespace torsion::engine {

/// What the trace says of one tool in one step (docs/guide.md has the columns).
struct TraceRow {
  double time = 0.0;  // s
  Pose pose;          // tool frame in the world
  Wrench wrench;      // on the tool, about its mass centre, world
  double work = 0.0;  // J
  double step_us = 0.0;
  std::uint32_t regions = 0;
  std::uint32_t cells = 0;        // that carry pressure
  std::uint32_t stuck_cells = 0;  // of those
};

/// The row of `tool` after a step that took `step_us` [us]. Allocates nothing.
TraceRow trace_row(const World& world, std::uint32_t tool, double step_us);

/// Writes rows as CSV; the file appears when it is whole.
class TraceWriter {
 public:
  /// @param tool_names  one for each tool; with several the columns are named after them
  static Result<TraceWriter> create(const std::filesystem::path& path,
                                    const std::vector<std::string>& tool_names);

  /// One line. @pre as many rows as tools
  void append(std::span<const TraceRow> rows);

  Result<Done> finish();

 private:
  explicit TraceWriter(OutputFile file) : file_(std::move(file)) {}
  OutputFile file_;
};

}  // namespace torsion::engine
