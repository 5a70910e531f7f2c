#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "app/trace_columns.hpp"

namespace torsion::engine {

enum class Statistic : std::uint32_t { kFirst, kLast, kLeast, kMost, kMean };

/// One number that a run of a study is to give besides what all give: a statistic of a trace's
/// column over the run's steps.
struct WantedColumn {
  std::string name;  // as it was asked for: STATISTIC:COLUMN
  Statistic statistic = Statistic::kLast;
  TraceColumn column;
};

/// "STATISTIC:COLUMN" with commas between, where STATISTIC is first, last, min, max or mean; empty:
/// none. The error says what was expected.
Result<std::vector<WantedColumn>> read_wanted_columns(const std::string& text);

/// Their names in the table, for each tool: with several the tool's name stands before the
/// column's.
std::vector<std::string> wanted_names(std::span<const WantedColumn> wanted,
                                      const std::vector<std::string>& tools);

/// Gathers them over the steps of a run.
class WantedValues {
 public:
  WantedValues(std::span<const WantedColumn> wanted, std::size_t tools);
  void add(const World& world);
  /// In the order of wanted_names. @pre add() was called
  [[nodiscard]] std::vector<double> values() const;

 private:
  std::span<const WantedColumn> wanted_;
  std::vector<TraceRow> before_;  // (tools); none before the first step
  std::vector<WorkByKind> work_;  // (tools)
  std::vector<double> gathered_;  // (wanted) of (tools): a sum where the mean is wanted
  std::uint64_t steps_ = 0;
};

}  // namespace torsion::engine
