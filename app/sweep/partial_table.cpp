#include "app/sweep/partial_table.hpp"

#include <charconv>
#include <system_error>

namespace torsion::engine {
namespace {

/// The run that a whole line begins with; a line that was cut off has no end of line, or no comma.
bool read_run(const std::string& line, std::uint64_t& run) {
  const char* const end = line.data() + line.size();
  const auto read = std::from_chars(line.data(), end, run);
  return read.ec == std::errc{} && read.ptr != end && *read.ptr == ',';
}

std::map<std::uint64_t, std::string> lines_in(const std::filesystem::path& path,
                                              const std::string& identity) {
  std::map<std::uint64_t, std::string> lines;
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line != identity) {
    return lines;
  }
  while (std::getline(file, line) && !file.eof()) {  // the last one has an end, or it was cut off
    std::uint64_t run = 0;
    if (read_run(line, run)) {
      lines[run] = line;
    }
  }
  return lines;
}

}  // namespace

Result<PartialTable> PartialTable::open(const std::filesystem::path& table,
                                        const std::string& identity) {
  PartialTable partial;
  partial.path_ = table;
  partial.path_ += ".partial";
  partial.lines_ = lines_in(partial.path_, identity);
  // Written again, without a line that was cut off.
  partial.file_.open(partial.path_, std::ios::trunc);
  partial.file_ << identity << '\n';
  for (const auto& [run, line] : partial.lines_) {
    partial.file_ << line << '\n';
  }
  partial.file_.flush();
  if (!partial.file_) {
    return Error{partial.path_.string() + ": cannot be written; choose another place for --out"};
  }
  return partial;
}

Result<Done> PartialTable::add(std::uint64_t run, const std::string& line) {
  file_ << line << '\n';
  file_.flush();
  if (!file_) {
    return Error{path_.string() + ": cannot be written any more; is the disk full?"};
  }
  lines_[run] = line;
  return Done{};
}

void PartialTable::remove() {
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace torsion::engine
