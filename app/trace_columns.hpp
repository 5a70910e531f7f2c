#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/trace.hpp"

namespace torsion::engine {

/// Work of a tool's holder since the first row, by what it was done against, J.
struct WorkByKind {
  double normal = 0.0;    // normal forces
  double friction = 0.0;  // friction forces
  double couple = 0.0;    // contact couples

  /// Adds that of a row, by the trapezoidal rule.
  void add(const TraceRow& before, const TraceRow& now);
};

/// A column of a trace that each tool has.
struct TraceColumn {
  std::string_view name;
  double (*of)(const TraceRow& row, const WorkByKind& work);
  bool usual = false;  // there unless others are asked for
};

/// All that there are, the usual ones first.
std::span<const TraceColumn> trace_columns();

/// Columns by their names, with commas between; "all" for all, "usual" for those that are there
/// unless others are asked for. The error has the names.
Result<std::vector<TraceColumn>> read_trace_columns(const std::string& names);

/// The usual ones.
std::vector<TraceColumn> usual_trace_columns();

}  // namespace torsion::engine
