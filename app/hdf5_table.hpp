#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ecs/result.hpp"

namespace torsion::engine {

/// A column of a table file.
struct TableColumn {
  std::string name;
  std::size_t text_size = 0;  // 0: numbers; else texts of at most this many bytes
};

/// One table in an HDF5 file, in the form of the library's own "HDF5 Table" (a compound dataset
/// with its names), which PyTables and pandas read as a table and h5py as a structured array.
class Hdf5Table {
 public:
  /// @param place  a file that is there; it is written over
  /// @param name   of the table in the file
  static Result<Hdf5Table> create(const std::filesystem::path& place, const std::string& name,
                                  std::span<const TableColumn> columns);
  Hdf5Table(Hdf5Table&&) noexcept;
  Hdf5Table& operator=(Hdf5Table&&) noexcept;
  Hdf5Table(const Hdf5Table&) = delete;
  Hdf5Table& operator=(const Hdf5Table&) = delete;
  ~Hdf5Table();

  /// Remembers a failure for finish().
  /// @param numbers  one for each column of numbers, in their order
  /// @param texts    likewise of texts; longer ones are cut
  void append(std::span<const double> numbers, std::span<const std::string> texts);
  Result<Done> finish();

 private:
  struct Data;
  explicit Hdf5Table(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace torsion::engine
