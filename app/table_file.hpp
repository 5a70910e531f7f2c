#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/hdf5_table.hpp"
#include "app/output_file.hpp"

namespace torsion::engine {

/// Whether a path's ending, .h5 or .hdf5, asks for HDF5.
bool is_hdf5(const std::filesystem::path& path);

/// A table of numbers, written row by row as CSV, or as HDF5 where the path ends in .h5 or .hdf5.
/// The file appears when it is whole.
class TableFile {
 public:
  /// @param name  of the table in an HDF5 file
  static Result<TableFile> create(const std::filesystem::path& path, const std::string& name,
                                  std::span<const std::string> columns);

  /// One row. In CSV numbers have nine digits. Remembers a failure for finish().
  void append(std::span<const double> numbers);

  Result<Done> finish();

 private:
  explicit TableFile(OutputFile file) : file_(std::move(file)) {}
  OutputFile file_;
  std::optional<Hdf5Table> table_;
};

}  // namespace torsion::engine
