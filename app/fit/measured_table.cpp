#include "app/fit/measured_table.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include <csv.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/scene_settings.hpp"

namespace torsion::engine {
namespace {

/// What the parser's callbacks build.
struct TableReader {
  MeasuredTable table;
  std::size_t row = 0;     // that is being read; 0: the names
  std::size_t column = 0;  // of the next field
  std::string problem;     // the first; empty: none

  [[nodiscard]] std::string place() const {
    return fmt::format("{}: row {}", table.path.string(), row + 1);
  }

  void add_field(const std::string& text) {
    if (!problem.empty()) {
      return;
    }
    const std::size_t at = column++;
    if (row == 0) {
      table.names.push_back(text);
      return;
    }
    if (at >= table.names.size()) {
      return;  // the end of the row says it
    }
    const std::optional<double> number = read_number(text);
    if (!number) {
      problem = fmt::format("{}, column {} ({}): \"{}\"; expected a finite number", place(), at + 1,
                            table.names[at], text);
      return;
    }
    table.columns[at].push_back(*number);
  }

  void end_row() {
    if (!problem.empty()) {
      return;
    }
    if (row == 0) {
      table.columns.resize(table.names.size());
      for (std::size_t k = 0; k < table.names.size(); ++k) {
        const auto first = std::ranges::find(table.names, table.names[k]);
        if (first != table.names.begin() + static_cast<std::ptrdiff_t>(k)) {
          problem = fmt::format("{}: two columns are named \"{}\"", place(), table.names[k]);
        }
      }
    } else if (column != table.names.size()) {
      problem = fmt::format("{} has {} fields; expected {}, as the names in row 1", place(), column,
                            table.names.size());
    }
    ++row;
    column = 0;
  }
};

void take_field(void* text, std::size_t size, void* reader) {
  static_cast<TableReader*>(reader)->add_field({static_cast<const char*>(text), size});
}

void take_end_of_row(int /*what ended it*/, void* reader) {
  static_cast<TableReader*>(reader)->end_row();
}

}  // namespace

Result<MeasuredTable> read_measured_table(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (file == nullptr) {
    return Error{fmt::format("{}: cannot be read: {}", path.string(),
                             std::generic_category().message(errno))};
  }
  TableReader reader;
  reader.table.path = path;
  csv_parser parser{};
  if (csv_init(&parser, CSV_STRICT) != 0) {
    return Error{path.string() + ": out of memory"};
  }
  const std::unique_ptr<csv_parser, void (*)(csv_parser*)> freed(&parser, csv_free);
  std::array<char, 65536> bytes{};
  std::size_t size = 0;
  bool parsed = true;
  while (parsed && reader.problem.empty() &&
         (size = std::fread(bytes.data(), 1, bytes.size(), file.get())) > 0) {
    parsed = csv_parse(&parser, bytes.data(), size, take_field, take_end_of_row, &reader) == size;
  }
  if (std::ferror(file.get()) != 0) {
    return Error{fmt::format("{}: cannot be read: {}", path.string(),
                             std::generic_category().message(errno))};
  }
  if (reader.problem.empty() &&
      (!parsed || csv_fini(&parser, take_field, take_end_of_row, &reader) != 0)) {
    reader.problem = fmt::format("{}: {}; expected fields with commas between", reader.place(),
                                 csv_strerror(csv_error(&parser)));
  }
  if (!reader.problem.empty()) {
    return Error{reader.problem};
  }
  if (reader.table.rows() == 0) {
    return Error{path.string() +
                 " has no rows of numbers; expected a line of names and lines of numbers"};
  }
  return std::move(reader.table);
}

}  // namespace torsion::engine
