#pragma once

#include <span>
#include <string>
#include <vector>

#include "ecs/result.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// One unknown of a fit: a number of the scene (app/scene_settings.hpp), or how far the measured
/// positions of a tool are off along an axis of the world: TOOL.offset_x, TOOL.offset_y,
/// TOOL.offset_z, m.
struct FreeParameter {
  std::string name;  // NODE.KEY
  std::string unit;  // empty: a ratio
  double start = 0.0;
  double least = 0.0;
  double most = 0.0;
  bool logarithmic = false;  // above 0: the search is in the logarithm
  double step = 0.01;        // of numerical derivatives, in what the search is in
  // Other values that the search may start from.
  std::vector<double> other_starts;
};

/// @param names  NODE.KEY; the error says what is there instead
Result<std::vector<FreeParameter>> read_parameters(std::span<const std::string> names,
                                                   const SceneDescription& scene);

/// What the search is in for a value, and the other way round.
double to_search(const FreeParameter& parameter, double value);
double from_search(const FreeParameter& parameter, double at);

/// Values of the unknowns, as a run takes them.
struct ParameterValues {
  std::vector<std::string> settings;  // of the scene
  std::vector<glm::dvec3> offsets;    // (tools) m, to be added to the measured positions
};

/// @param values  (parameters)
ParameterValues parameter_values(std::span<const FreeParameter> parameters,
                                 std::span<const double> values, const SceneDescription& scene);

}  // namespace torsion::engine
