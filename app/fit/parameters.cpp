#include "app/fit/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "app/scene_settings.hpp"

namespace torsion::engine {
namespace {

constexpr std::string_view kOffset = "offset_";
// Steps of numerical derivatives: large beside what an iteration's residual leaves open in a force
// (a thousandth), small beside what bends the curves of forces over a parameter.
constexpr double kRelativeStep = 0.01;
constexpr double kRatioStep = 0.005;  // of Poisson's ratio
constexpr double kOffsetStep = 2e-4;  // of the tool's size

struct Offset {
  std::size_t tool = 0;
  glm::length_t axis = 0;
};

/// What NODE.offset_AXIS names; none for another key.
std::optional<Offset> offset_of(const std::string& name, const SceneDescription& scene) {
  const std::size_t dot = name.rfind('.');
  const std::string key = dot == std::string::npos ? "" : name.substr(dot + 1);
  if (!key.starts_with(kOffset) || key.size() != kOffset.size() + 1) {
    return std::nullopt;
  }
  const std::size_t axis = std::string_view("xyz").find(key.back());
  const auto tool = std::ranges::find(scene.tools, name.substr(0, dot), &ToolDescription::node);
  if (axis == std::string_view::npos || tool == scene.tools.end()) {
    return std::nullopt;
  }
  return Offset{static_cast<std::size_t>(tool - scene.tools.begin()),
                static_cast<glm::length_t>(axis)};
}

double size_of(const ToolDescription& tool) {
  glm::dvec3 least(std::numeric_limits<double>::infinity());
  glm::dvec3 most = -least;
  for (const PartDescription& part : tool.parts) {
    for (const glm::dvec3& position : part.surface.positions) {
      least = glm::min(least, position);
      most = glm::max(most, position);
    }
  }
  return glm::length(most - least);
}

std::string unit_of(std::string_view key) {
  return key == "youngs_modulus"     ? "Pa"
         : key == "density"          ? "kg/m^3"
         : key == "mass"             ? "kg"
         : key == "region_threshold" ? "m"
                                     : "";
}

Result<FreeParameter> read_parameter(const std::string& name, const SceneDescription& scene) {
  FreeParameter parameter;
  parameter.name = name;
  if (const std::optional<Offset> offset = offset_of(name, scene)) {
    parameter.unit = "m";
    parameter.least = -std::numeric_limits<double>::infinity();
    parameter.most = std::numeric_limits<double>::infinity();
    parameter.step = kOffsetStep * size_of(scene.tools[offset->tool]);
    return parameter;
  }
  if (name.rfind('.') == std::string::npos) {
    return Error{"--free " + name + ": expected NODE.KEY, as cube.youngs_modulus"};
  }
  const Result<SettableNumber> number = settable_number(name, scene);
  if (!number) {
    return Error{"--free " + name + ": " + number.error().text +
                 "; of a tool also offset_x, offset_y, offset_z"};
  }
  const std::string key = name.substr(name.rfind('.') + 1);
  parameter.unit = unit_of(key);
  parameter.start = number.value().value;
  parameter.least = number.value().least;
  parameter.most = number.value().most;
  parameter.logarithmic = number.value().above_zero;
  if (parameter.logarithmic) {
    parameter.least = std::numeric_limits<double>::min();
    parameter.step = kRelativeStep;
    for (const double factor : {0.01, 0.1, 10.0, 100.0}) {
      parameter.other_starts.push_back(parameter.start * factor);
    }
  } else if (key.ends_with("friction")) {
    parameter.step = kRelativeStep * std::max(parameter.start, 0.1);
    parameter.other_starts = {0.1, 0.2, 0.4, 0.8, 1.6};
  } else {
    parameter.step = kRatioStep;
    parameter.other_starts = {0.1, 0.3, 0.45};
  }
  std::erase_if(parameter.other_starts,
                [&](double value) { return value < parameter.least || value > parameter.most; });
  return parameter;
}

}  // namespace

Result<std::vector<FreeParameter>> read_parameters(std::span<const std::string> names,
                                                   const SceneDescription& scene) {
  std::vector<FreeParameter> parameters;
  for (const std::string& name : names) {
    Result<FreeParameter> parameter = read_parameter(name, scene);
    if (!parameter) {
      return Error{scene.path + ": " + parameter.error().text};
    }
    if (std::ranges::find(parameters, name, &FreeParameter::name) != parameters.end()) {
      return Error{"--free " + name + ": named twice"};
    }
    parameters.push_back(std::move(parameter).value());
  }
  return parameters;
}

double to_search(const FreeParameter& parameter, double value) {
  return parameter.logarithmic ? std::log(value) : value;
}

double from_search(const FreeParameter& parameter, double at) {
  return parameter.logarithmic ? std::exp(at) : at;
}

ParameterValues parameter_values(std::span<const FreeParameter> parameters,
                                 std::span<const double> values, const SceneDescription& scene) {
  ParameterValues result;
  result.offsets.assign(scene.tools.size(), glm::dvec3(0.0));
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (const std::optional<Offset> offset = offset_of(parameters[k].name, scene)) {
      result.offsets[offset->tool][offset->axis] = values[k];
    } else {
      result.settings.push_back(fmt::format("{}={}", parameters[k].name, values[k]));
    }
  }
  return result;
}

}  // namespace torsion::engine
