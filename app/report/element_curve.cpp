#include "app/report/element_curve.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>

#include "app/report/embedded_results.hpp"

namespace torsion::engine {
namespace {

constexpr std::string_view kFieldEnding = "_field";

/// A file's name taken apart: CASE_DIVISIONS or CASE_DIVISIONS_field.
struct NameParts {
  std::string_view case_name;
  int divisions = 0;
  bool is_field = false;
};

NameParts parts_of(std::string_view name) {
  NameParts parts;
  parts.is_field = name.ends_with(kFieldEnding);
  if (parts.is_field) {
    name.remove_suffix(kFieldEnding.size());
  }
  const std::size_t last = name.rfind('_');
  parts.case_name = name.substr(0, last);
  const std::string_view digits = name.substr(last + 1);
  std::from_chars(digits.data(), digits.data() + digits.size(), parts.divisions);
  return parts;
}

/// Numbers of a CSV after its header, row by row.
std::vector<std::vector<double>> rows_of(std::string_view text) {
  std::vector<std::vector<double>> rows;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    std::vector<double> values;
    const char* at = line.c_str();
    while (*at != '\0') {
      char* after = nullptr;
      const double value = std::strtod(at, &after);
      if (after == at) {
        break;  // the header
      }
      values.push_back(value);
      at = *after == ',' ? after + 1 : after;
    }
    if (!values.empty()) {
      rows.push_back(std::move(values));
    }
  }
  return rows;
}

ElementCurve curve_of(std::string_view name, int divisions) {
  ElementCurve curve;
  curve.divisions = divisions;
  for (const EmbeddedFile& file : element_results()) {
    const NameParts parts = parts_of(file.name);
    if (parts.case_name != name || parts.divisions != divisions) {
      continue;
    }
    for (const std::vector<double>& row : rows_of(file.text)) {
      if (parts.is_field && row.size() == 2) {
        curve.field.push_back({row[0], row[1]});
      } else if (!parts.is_field && row.size() == 6) {
        curve.rows.push_back({row[1], row[2], row[3], row[4], row[5]});
      }
    }
  }
  return curve;
}

std::optional<double> difference(const ElementCurve& fine, const ElementCurve& coarse,
                                 double ElementCurve::Row::*value) {
  double largest = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < std::min(fine.rows.size(), coarse.rows.size()); ++i) {
    largest = std::max(largest, std::abs(fine.rows[i].*value - coarse.rows[i].*value));
    scale = std::max(scale, std::abs(fine.rows[i].*value));
  }
  return scale > 0.0 ? std::optional(largest / scale) : std::nullopt;
}

}  // namespace

std::vector<std::string_view> element_case_names() {
  std::vector<std::string_view> names;
  for (const EmbeddedFile& file : element_results()) {
    names.push_back(parts_of(file.name).case_name);
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

ElementCurve finest_curve(std::string_view name) {
  std::vector<int> meshes;
  for (const EmbeddedFile& file : element_results()) {
    const NameParts parts = parts_of(file.name);
    if (parts.case_name == name && !parts.is_field) {
      meshes.push_back(parts.divisions);
    }
  }
  std::ranges::sort(meshes, std::greater<>{});
  ElementCurve finest = curve_of(name, meshes.front());
  if (meshes.size() > 1) {
    const ElementCurve coarser = curve_of(name, meshes[1]);
    finest.force_error = difference(finest, coarser, &ElementCurve::Row::force);
    finest.torque_error = difference(finest, coarser, &ElementCurve::Row::torque);
  }
  return finest;
}

double field_twist(const ElementCurve& curve, double radius) {
  const auto after =
      std::ranges::lower_bound(curve.field, radius, {}, &ElementCurve::FieldRow::radius);
  if (after == curve.field.begin() || after == curve.field.end()) {
    return after == curve.field.end() ? curve.field.back().twist : after->twist;
  }
  const auto before = after - 1;
  const double share = (radius - before->radius) / (after->radius - before->radius);
  return std::lerp(before->twist, after->twist, share);
}

}  // namespace torsion::engine
