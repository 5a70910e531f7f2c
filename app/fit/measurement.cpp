#include "app/fit/measurement.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/scene_settings.hpp"
#include "app/trace.hpp"
#include "device/scripted_motion.hpp"

namespace torsion::engine {
namespace {

constexpr std::array kPositionColumns = {"tool_x_m", "tool_y_m", "tool_z_m"};
constexpr std::array kRotationColumns = {"tool_qw", "tool_qx", "tool_qy", "tool_qz"};
constexpr std::array kWrenchColumns = {"force_x_N",   "force_y_N",   "force_z_N",
                                       "torque_x_Nm", "torque_y_Nm", "torque_z_Nm"};
constexpr double kUnitTolerance = 0.01;  // of a quaternion's length: more is no rounding

/// The table by our names.
class NamedColumns {
 public:
  NamedColumns(const MeasuredTable& table, std::span<const ColumnSource> sources)
      : table_(table), sources_(sources) {}

  /// Empty where the file has no such column.
  [[nodiscard]] std::vector<double> column(const std::string& name) const {
    const auto source = std::ranges::find(sources_, name, &ColumnSource::name);
    const std::string& in_file = source != sources_.end() ? source->column : name;
    const auto found = std::ranges::find(table_.names, in_file);
    if (found == table_.names.end()) {
      return {};
    }
    std::vector<double> values =
        table_.columns[static_cast<std::size_t>(found - table_.names.begin())];
    const double factor = source != sources_.end() ? source->factor : 1.0;
    for (double& value : values) {
      value *= factor;
    }
    return values;
  }

  /// The columns of these names, all or none; in part is an error.
  template <std::size_t N>
  Result<std::vector<std::vector<double>>> columns(const std::string& prefix,
                                                   const std::array<const char*, N>& names) const {
    std::vector<std::vector<double>> found;
    std::vector<std::string> missing;
    for (const char* const name : names) {
      found.push_back(column(prefix + name));
      if (found.back().empty()) {
        missing.push_back(prefix + name);
      }
    }
    if (missing.size() == N) {
      return std::vector<std::vector<double>>{};
    }
    if (!missing.empty()) {
      return Error{fmt::format("{}: there is no column {}; expected all of {} or none",
                               table_.path.string(), fmt::join(missing, ", "),
                               fmt::join(names, ", "))};
    }
    return found;
  }

 private:
  const MeasuredTable& table_;
  std::span<const ColumnSource> sources_;
};

Result<MeasuredMotion> read_motion(const NamedColumns& named, const std::string& path,
                                   const std::string& prefix) {
  MeasuredMotion motion;
  const auto positions = named.columns(prefix, kPositionColumns);
  if (!positions) {
    return positions.error();
  }
  const auto rotations = named.columns(prefix, kRotationColumns);
  if (!rotations) {
    return rotations.error();
  }
  if (const auto& p = positions.value(); !p.empty()) {
    for (std::size_t k = 0; k < p[0].size(); ++k) {
      motion.positions.emplace_back(p[0][k], p[1][k], p[2][k]);
    }
  }
  if (const auto& q = rotations.value(); !q.empty()) {
    for (std::size_t k = 0; k < q[0].size(); ++k) {
      const glm::dquat rotation(q[0][k], q[1][k], q[2][k], q[3][k]);
      const double length = glm::length(rotation);
      if (!(std::abs(length - 1.0) < kUnitTolerance)) {
        return Error{
            fmt::format("{}: row {}: the quaternion {}tool_qw to {}tool_qz has length "
                        "{:.6g}; expected 1",
                        path, k + 2, prefix, prefix, length)};
      }
      motion.rotations.push_back(rotation / length);
    }
  }
  return motion;
}

/// What in the sources is neither a name of ours nor a column of the file.
std::string source_problem(const MeasuredTable& table, const std::vector<std::string>& tools,
                           std::span<const ColumnSource> sources) {
  std::vector<std::string> known = {"time_s"};
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    const std::string prefix = trace_prefix(tools, tool);
    const auto add = [&](const auto& names) {
      for (const char* const name : names) {
        known.push_back(prefix + name);
      }
    };
    add(kPositionColumns);
    add(kRotationColumns);
    add(kWrenchColumns);
  }
  for (const ColumnSource& source : sources) {
    if (std::ranges::find(known, source.name) == known.end()) {
      return fmt::format("--column {}: expected one of {}", source.name, fmt::join(known, ", "));
    }
    if (std::ranges::find(table.names, source.column) == table.names.end()) {
      return fmt::format("{}: there is no column \"{}\", which --column {} names; it has {}",
                         table.path.string(), source.column, source.name,
                         fmt::join(table.names, ", "));
    }
  }
  return "";
}

std::string time_problem(const std::string& path, const std::vector<double>& times) {
  if (times.empty()) {
    return path + ": there is no column time_s; name another by --column time_s=NAME";
  }
  if (times.size() < kFewestRows) {
    return fmt::format("{}: {} rows of numbers; expected at least {}", path, times.size(),
                       kFewestRows);
  }
  for (std::size_t k = 1; k < times.size(); ++k) {
    if (!(times[k] > times[k - 1])) {
      return fmt::format("{}: row {}: time_s is {:.9g} after {:.9g}; expected rising times", path,
                         k + 2, times[k], times[k - 1]);
    }
  }
  return "";
}

}  // namespace

Result<ColumnSource> read_column_source(const std::string& text) {
  ColumnSource source;
  const std::size_t equals = text.find('=');
  const std::size_t star = text.rfind('*');
  const bool has_factor = star != std::string::npos && equals != std::string::npos && star > equals;
  source.name = text.substr(0, equals);
  source.column = equals == std::string::npos
                      ? ""
                      : text.substr(equals + 1, has_factor ? star - equals - 1 : std::string::npos);
  const std::optional<double> factor = has_factor ? read_number(text.substr(star + 1)) : 1.0;
  if (source.name.empty() || source.column.empty() || !factor || *factor == 0.0) {
    return Error{"--column " + text +
                 ": expected NAME=COLUMN or NAME=COLUMN*FACTOR, as force_y_N=Fy*-1e-3"};
  }
  source.factor = *factor;
  return source;
}

Result<Measurement> read_measurement(const MeasuredTable& table, const SceneDescription& scene,
                                     std::span<const ColumnSource> sources) {
  const std::string path = table.path.string();
  const std::vector<std::string> tools = tool_names(scene);
  if (const std::string problem = source_problem(table, tools, sources); !problem.empty()) {
    return Error{problem};
  }
  const NamedColumns named(table, sources);
  Measurement measurement;
  measurement.times = named.column("time_s");
  if (const std::string problem = time_problem(path, measurement.times); !problem.empty()) {
    return Error{problem};
  }
  for (std::uint32_t tool = 0; tool < tools.size(); ++tool) {
    const std::string prefix = trace_prefix(tools, tool);
    Result<MeasuredMotion> motion = read_motion(named, path, prefix);
    if (!motion) {
      return motion.error();
    }
    measurement.motions.push_back(std::move(motion).value());
    for (std::uint32_t component = 0; component < kWrenchColumns.size(); ++component) {
      const std::string name = prefix + kWrenchColumns[component];
      std::vector<double> values = named.column(name);
      if (!values.empty()) {
        measurement.quantities.push_back({name, tool, component, std::move(values)});
      }
    }
  }
  if (measurement.quantities.empty()) {
    return Error{
        fmt::format("{}: there is no force and no torque; expected one of the columns {}, "
                    "or --column NAME=COLUMN",
                    path, fmt::join(kWrenchColumns, ", "))};
  }
  return measurement;
}

Pose measured_pose(const Measurement& measurement, const SceneDescription& scene,
                   std::uint32_t tool, double time) {
  const MeasuredMotion& motion = measurement.motions[tool];
  Pose pose;
  if (motion.positions.empty() || motion.rotations.empty()) {
    pose = scripted_pose(scene.tools[tool].script, time);
  }
  const std::vector<double>& times = measurement.times;
  const auto after = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(times, time) - times.begin(), 1,
                                 static_cast<std::ptrdiff_t>(times.size()) - 1));
  const double share =
      std::clamp((time - times[after - 1]) / (times[after] - times[after - 1]), 0.0, 1.0);
  if (!motion.positions.empty()) {
    pose.position = glm::mix(motion.positions[after - 1], motion.positions[after], share);
  }
  if (!motion.rotations.empty()) {
    pose.rotation = glm::slerp(motion.rotations[after - 1], motion.rotations[after], share);
  }
  return pose;
}

}  // namespace torsion::engine
