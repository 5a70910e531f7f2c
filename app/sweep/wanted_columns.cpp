#include "app/sweep/wanted_columns.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "app/split_text.hpp"

namespace torsion::engine {
namespace {

struct NamedStatistic {
  std::string_view name;
  Statistic statistic;
};
constexpr NamedStatistic kStatistics[] = {{"first", Statistic::kFirst},
                                          {"last", Statistic::kLast},
                                          {"min", Statistic::kLeast},
                                          {"max", Statistic::kMost},
                                          {"mean", Statistic::kMean}};

double gathered(Statistic statistic, double before, double now, bool first) {
  switch (statistic) {
    case Statistic::kFirst:
      return first ? now : before;
    case Statistic::kLast:
      return now;
    case Statistic::kLeast:
      return first ? now : std::min(before, now);
    case Statistic::kMost:
      return first ? now : std::max(before, now);
    case Statistic::kMean:
      return first ? now : before + now;
  }
  return now;
}

}  // namespace

Result<std::vector<WantedColumn>> read_wanted_columns(const std::string& text) {
  std::vector<WantedColumn> wanted;
  if (text.empty()) {
    return wanted;
  }
  for (const std::string& word : split_text(text, ',')) {
    const std::size_t colon = word.find(':');
    const auto* const statistic =
        std::ranges::find(kStatistics, word.substr(0, colon), &NamedStatistic::name);
    if (colon == std::string::npos || statistic == std::end(kStatistics)) {
      return Error{
          fmt::format("--columns {}: expected STATISTIC:COLUMN with first, last, min, max "
                      "or mean, as max:couple_y_Nm",
                      word)};
    }
    const Result<std::vector<TraceColumn>> columns = read_trace_columns(word.substr(colon + 1));
    if (!columns) {
      return Error{"--columns " + word + ": " + columns.error().text};
    }
    for (const TraceColumn& column : columns.value()) {
      wanted.push_back(
          {fmt::format("{}:{}", statistic->name, column.name), statistic->statistic, column});
    }
  }
  return wanted;
}

std::vector<std::string> wanted_names(std::span<const WantedColumn> wanted,
                                      const std::vector<std::string>& tools) {
  std::vector<std::string> names;
  for (const WantedColumn& column : wanted) {
    for (std::size_t tool = 0; tool < tools.size(); ++tool) {
      const std::size_t colon = column.name.find(':') + 1;
      names.push_back(column.name.substr(0, colon) + trace_prefix(tools, tool) +
                      column.name.substr(colon));
    }
  }
  return names;
}

WantedValues::WantedValues(std::span<const WantedColumn> wanted, std::size_t tools)
    : wanted_(wanted), work_(tools), gathered_(wanted.size() * tools) {}

void WantedValues::add(const World& world) {
  if (wanted_.empty()) {
    return;
  }
  const std::size_t tools = work_.size();
  const bool first = steps_++ == 0;
  before_.resize(tools);
  for (std::size_t tool = 0; tool < tools; ++tool) {
    const TraceRow row = trace_row(world, static_cast<std::uint32_t>(tool), 0.0);
    if (!first) {
      work_[tool].add(before_[tool], row);
    }
    for (std::size_t k = 0; k < wanted_.size(); ++k) {
      double& value = gathered_[k * tools + tool];
      value = gathered(wanted_[k].statistic, value, wanted_[k].column.of(row, work_[tool]), first);
    }
    before_[tool] = row;
  }
}

std::vector<double> WantedValues::values() const {
  std::vector<double> values = gathered_;
  const std::size_t tools = work_.size();
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] /=
        wanted_[k / tools].statistic == Statistic::kMean ? static_cast<double>(steps_) : 1.0;
  }
  return values;
}

}  // namespace torsion::engine
