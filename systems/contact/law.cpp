#include "systems/contact/law.hpp"

#include <algorithm>

namespace torsion {

bool any_tool_and_body(const StepContext& context) {
  return !context.model.tools.empty() && !context.model.bodies.empty();
}

bool any_contact_model(const StepContext& context, ContactModel model) {
  return any_tool_and_body(context) &&
         std::ranges::any_of(context.model.bodies.column<BodyModels>(),
                             [model](const BodyModels& models) { return models.contact == model; });
}

bool any_friction(const StepContext& context) {
  return any_tool_and_body(context) &&
         std::ranges::any_of(context.model.bodies.column<Friction>(), [](const Friction& friction) {
           return friction.static_friction > 0.0;
         });
}

}  // namespace torsion
