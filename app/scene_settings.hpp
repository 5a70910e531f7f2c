#pragma once

#include <optional>
#include <span>
#include <string>

#include "ecs/result.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// The finite number that all of a text is.
std::optional<double> read_number(const std::string& text);

/// Empty for a text of the form NODE.KEY=VALUE, else what is wrong with it. A node's name may have
/// dots, a key has none.
std::string setting_form_problem(const std::string& setting);

/// Puts values over what a scene file says, in their order: of an elastic node youngs_modulus,
/// poisson_ratio, density, static_friction, dynamic_friction, friction (both of them), tolerance,
/// region_threshold, contact_model and body_model, of a tool mass; each with the bounds that the
/// file's key has (docs/scenes.md). Fails on the first that cannot be. @pre they have that form
Result<Done> apply_settings(std::span<const std::string> settings, SceneDescription& scene);

/// A number that can be set.
struct SettableNumber {
  double value = 0.0;  // what the scene has
  double least = 0.0;
  double most = 0.0;
  bool above_zero = false;  // never 0, and as well measured in ratios
};

/// @param name  NODE.KEY. Fails, with the words of apply_settings, where no number has that name
Result<SettableNumber> settable_number(const std::string& name, const SceneDescription& scene);

}  // namespace torsion::engine
