#include "app/sweep/study_table.hpp"

#include <algorithm>

#include "app/scene_settings.hpp"
#include "app/split_text.hpp"
#include "app/table_file.hpp"

namespace torsion::engine {
namespace {

/// The hash's digits may be those of a number and are none.
constexpr std::string_view kAlwaysText = "world_hash";

std::vector<TableColumn> columns_of(const std::string& header,
                                    const std::map<std::uint64_t, std::string>& lines) {
  const std::vector<std::string> names = split_text(header, ',');
  std::vector<bool> numbers(names.size(), true);
  std::vector<std::size_t> longest(names.size(), 1);
  for (const auto& [run, line] : lines) {
    const std::vector<std::string> fields = split_text(line, ',');
    for (std::size_t k = 0; k < names.size(); ++k) {
      numbers[k] = numbers[k] && names[k] != kAlwaysText && read_number(fields[k]).has_value();
      longest[k] = std::max(longest[k], fields[k].size());
    }
  }
  std::vector<TableColumn> columns;
  for (std::size_t k = 0; k < names.size(); ++k) {
    columns.push_back({names[k], numbers[k] ? 0 : longest[k]});
  }
  return columns;
}

}  // namespace

Result<Done> write_study_table(const std::filesystem::path& path, const std::string& header,
                               const std::map<std::uint64_t, std::string>& lines) {
  Result<OutputFile> file = OutputFile::create(path);
  if (!file) {
    return file.error();
  }
  if (!is_hdf5(path)) {
    file.value().write(header + "\n");
    for (const auto& [run, line] : lines) {
      file.value().write(line + "\n");
    }
    return file.value().commit();
  }
  const Result<std::filesystem::path> place = file.value().place();
  if (!place) {
    return place.error();
  }
  const std::vector<TableColumn> columns = columns_of(header, lines);
  Result<Hdf5Table> table = Hdf5Table::create(place.value(), "runs", columns);
  if (!table) {
    return table.error();
  }
  for (const auto& [run, line] : lines) {
    const std::vector<std::string> fields = split_text(line, ',');
    std::vector<double> numbers;
    std::vector<std::string> texts;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns[k].text_size == 0) {
        numbers.push_back(*read_number(fields[k]));
      } else {
        texts.push_back(fields[k]);
      }
    }
    table.value().append(numbers, texts);
  }
  if (const Result<Done> done = table.value().finish(); !done) {
    return done.error();
  }
  return file.value().commit();
}

}  // namespace torsion::engine
