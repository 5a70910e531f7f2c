#include "app/table_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace torsion::engine {

bool is_hdf5(const std::filesystem::path& path) {
  return path.extension() == ".h5" || path.extension() == ".hdf5";
}

Result<TableFile> TableFile::create(const std::filesystem::path& path, const std::string& name,
                                    std::span<const std::string> columns) {
  Result<OutputFile> file = OutputFile::create(path);
  if (!file) {
    return file.error();
  }
  TableFile made(std::move(file).value());
  if (!is_hdf5(path)) {
    made.file_.write(fmt::format("{}\n", fmt::join(columns, ",")));
    return made;
  }
  const Result<std::filesystem::path> place = made.file_.place();
  if (!place) {
    return place.error();
  }
  std::vector<TableColumn> numbers;
  for (const std::string& column : columns) {
    numbers.push_back({column, 0});
  }
  Result<Hdf5Table> table = Hdf5Table::create(place.value(), name, numbers);
  if (!table) {
    return table.error();
  }
  made.table_ = std::move(table).value();
  return made;
}

void TableFile::append(std::span<const double> numbers) {
  if (table_) {
    table_->append(numbers, {});
    return;
  }
  fmt::memory_buffer line;
  for (const double number : numbers) {
    fmt::format_to(fmt::appender(line), "{}{:.9g}", line.size() > 0 ? "," : "", number);
  }
  line.push_back('\n');
  file_.write({line.data(), line.size()});
}

Result<Done> TableFile::finish() {
  if (table_) {
    if (const Result<Done> done = table_->finish(); !done) {
      return done.error();
    }
  }
  return file_.commit();
}

}  // namespace torsion::engine
