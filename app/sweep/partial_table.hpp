#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "ecs/result.hpp"

namespace torsion::engine {

/// The lines of a sweep that is under way, beside where its table is to be: each is written as soon
/// as its run is done, so that a sweep which is stopped goes on where it was. The first line says
/// of which study they are.
class PartialTable {
 public:
  /// Takes what is there of the same study; starts again where it is another one's.
  /// @param identity  one line, of all that the lines depend on
  static Result<PartialTable> open(const std::filesystem::path& table, const std::string& identity);

  [[nodiscard]] bool has(std::uint64_t run) const { return lines_.contains(run); }
  /// Lines by run.
  [[nodiscard]] const std::map<std::uint64_t, std::string>& lines() const { return lines_; }
  /// @param line  begins with the run's number and a comma
  Result<Done> add(std::uint64_t run, const std::string& line);
  /// Takes the file away: the table is there.
  void remove();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::map<std::uint64_t, std::string> lines_;
  std::ofstream file_;
};

}  // namespace torsion::engine
