#pragma once

#include <string>
#include <vector>

#include "app/fit/fit_scene.hpp"

namespace torsion::engine {

/// The command that was given, for what is written.
struct FitFacts {
  std::string measured;  // path
  double seconds = 0.0;  // that the fit took
};

/// What a fit has found, for a person.
std::string fit_text(const FitProblem& problem, const FitResult& result, const FitFacts& facts);

/// The same as one JSON object.
std::string fit_json(const FitProblem& problem, const FitResult& result, const FitFacts& facts);

/// What was measured and what the model says with the values found, as CSV: time_s, then two
/// columns a quantity, NAME and NAME_model.
std::string fit_table(const FitProblem& problem, const FitResult& result);

/// The same on one page that needs nothing else, with curves and differences over time. Fails where
/// the plots cannot be drawn.
Result<std::string> fit_page(const FitProblem& problem, const FitResult& result,
                             const FitFacts& facts);

}  // namespace torsion::engine
