// Every contact model and every body model: a new one is a room of its own and one line here.

#include <array>

#include "systems/body/compliance/compliance.hpp"
#include "systems/body/skeleton/skeleton.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/mdr/mdr.hpp"
#include "systems/paper/paper.hpp"
#include "systems/patch/patch.hpp"

namespace torsion {
namespace {

constexpr std::array<const ContactLaw*, 3> kContactLaws{&kPaperLaw, &kMdrLaw, &kPatchLaw};

const BodyLaw kNoBodyLaw{.model = BodyModel::kNone};
constexpr std::array<const BodyLaw*, 3> kBodyLaws{&kNoBodyLaw, &kSkeletonLaw, &kComplianceLaw};

}  // namespace

const ContactLaw& contact_law(ContactModel model) {
  for (const ContactLaw* const law : kContactLaws) {
    if (law->model == model) {
      return *law;
    }
  }
  TORSION_ASSERT(false);
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

}  // namespace torsion
