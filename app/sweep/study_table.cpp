#include "app/sweep/study_table.hpp"

#include <algorithm>
#include <sstream>

#include "app/scene_settings.hpp"
#include "app/table_file.hpp"

namespace torsion::engine {
namespace {

std::vector<std::string> fields_in(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream words(line);
  for (std::string field; std::getline(words, field, ',');) {
    fields.push_back(field);
  }
  return fields;
}

/// The hash's digits may be those of a number and are none.
constexpr std::string_view kAlwaysText = "world_hash";

std::vector<TableColumn> columns_of(const std::string& header,
                                    const std::map<std::uint64_t, std::string>& lines) {
  std::vector<TableColumn> columns;
  for (const std::string& name : fields_in(header)) {
    columns.push_back({name, 0});
  }
  for (std::size_t k = 0; k < columns.size(); ++k) {
    bool numbers = columns[k].name != kAlwaysText;
    std::size_t longest = 1;
    for (const auto& [run, line] : lines) {
      const std::string field = fields_in(line)[k];
      numbers = numbers && read_number(field).has_value();
      longest = std::max(longest, field.size());
    }
    columns[k].text_size = numbers ? 0 : longest;
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
    const std::vector<std::string> fields = fields_in(line);
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
