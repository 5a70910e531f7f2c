#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/fit/measurement.hpp"
#include "app/fit/parameters.hpp"
#include "app/scene_variants.hpp"
#include "systems/model/options.hpp"

namespace torsion::engine {

/// What a fit compares: a scene, unknowns of it, and what was measured.
struct FitProblem {
  std::shared_ptr<const SceneVariants> variants;  // of the scene, with models for the motions
  Measurement measurement;
  std::vector<FreeParameter> parameters;
  std::vector<std::string> models;  // in words, one a body
  std::uint32_t jobs = 1;           // runs at the same time

  [[nodiscard]] const SceneDescription& scene() const { return variants->scene(); }
};

/// What the model says for the measured motions.
struct Prediction {
  std::vector<double> values;  // (quantities) of (times), one behind the other
  std::uint32_t faults = 0;    // of all steps
  std::uint64_t contact_steps = 0;
};

/// Chooses the models that "auto" means for the measured motions, from the scene as it is; the runs
/// have them whatever the unknowns become.
/// @param parameters  of `scene`
Result<FitProblem> make_fit_problem(SceneDescription scene, PrepareOptions options,
                                    Measurement measurement, std::vector<FreeParameter> parameters);

/// Runs the measured motions once. Fails where the values cannot be together.
/// @param values  (parameters)
Result<Prediction> predict(const FitProblem& problem, std::span<const double> values);

/// The same for several sets of values, up to FitProblem::jobs at the same time; nullopt where one
/// fails.
std::vector<std::optional<Prediction>> predict_all(const FitProblem& problem,
                                                   std::span<const std::vector<double>> points);

}  // namespace torsion::engine
