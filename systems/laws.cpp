// Every contact model (ecs/contact_models.hpp has the list) and every body model: a new one is a
// room of its own and one line in its list.

#include <algorithm>
#include <array>

#include "systems/body/compliance/compliance.hpp"
#include "systems/body/skeleton/skeleton.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/support/body_law.hpp"

namespace torsion::engine {
namespace {

#define TORSION_LAW(name, text) &k##name##Law,
constexpr auto kContactLaws =
    std::to_array<const ContactLaw*>({TORSION_CONTACT_MODELS(TORSION_LAW)});
#undef TORSION_LAW

const BodyLaw kNoBodyLaw{.model = BodyModel::kNone};
constexpr std::array<const BodyLaw*, 3> kBodyLaws{&kNoBodyLaw, &kSkeletonLaw, &kComplianceLaw};

}  // namespace

const ContactLaw& contact_law(ContactModel model) {
  TORSION_ASSERT(model != ContactModel::kAuto);
  return *kContactLaws[static_cast<std::size_t>(model) - 1];  // the list makes the enum, too
}

std::span<const ContactLaw* const> contact_laws() {
  return kContactLaws;
}

const BodyLaw& body_law(BodyModel model) {
  for (const BodyLaw* const law : kBodyLaws) {
    if (law->model == model) {
      return *law;
    }
  }
  TORSION_ASSERT(false);
}

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

}  // namespace torsion::engine
