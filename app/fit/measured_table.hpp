#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ecs/result.hpp"

namespace torsion::engine {

/// A table of numbers with a name above each column.
struct MeasuredTable {
  std::filesystem::path path;
  std::vector<std::string> names;            // (columns)
  std::vector<std::vector<double>> columns;  // (columns) of (rows)

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns[0].size(); }
};

/// Reads a CSV file: a line of names, then lines of as many finite numbers. Lines without anything
/// are skipped. The error says in which row and column something else is.
Result<MeasuredTable> read_measured_table(const std::filesystem::path& path);

}  // namespace torsion::engine
