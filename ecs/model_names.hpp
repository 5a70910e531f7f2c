#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "ecs/components.hpp"

namespace torsion::engine {

// The models' names, as scenes, the command line and reports write them; in the order of the enums.

#define TORSION_NAME(name, text) text,
inline constexpr std::array kContactModelNames =
    std::to_array<std::string_view>({"auto", TORSION_CONTACT_MODELS(TORSION_NAME)});
#undef TORSION_NAME
inline constexpr std::array<std::string_view, 4> kBodyModelNames = {"auto", "none", "skeleton",
                                                                    "compliance"};

constexpr std::string_view name_of(ContactModel model) {
  return kContactModelNames[static_cast<std::size_t>(model)];
}
constexpr std::string_view name_of(BodyModel model) {
  return kBodyModelNames[static_cast<std::size_t>(model)];
}

/// The model of that name; nullopt where there is none.
constexpr std::optional<ContactModel> contact_model_named(std::string_view name) {
  const auto* const at = std::ranges::find(kContactModelNames, name);
  return at == kContactModelNames.end()
             ? std::nullopt
             : std::optional(static_cast<ContactModel>(at - kContactModelNames.begin()));
}
constexpr std::optional<BodyModel> body_model_named(std::string_view name) {
  const auto* const at = std::ranges::find(kBodyModelNames, name);
  return at == kBodyModelNames.end()
             ? std::nullopt
             : std::optional(static_cast<BodyModel>(at - kBodyModelNames.begin()));
}

}  // namespace torsion::engine
