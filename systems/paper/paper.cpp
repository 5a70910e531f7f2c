#include "systems/paper/paper.hpp"

#include <limits>

#include "systems/contact/region_grid.hpp"
#include "systems/paper/carry_tractions.hpp"

namespace torsion {
namespace {

bool any_paper_friction(const StepContext& context) {
  return any_friction(context) && any_contact_model(context, ContactModel::kPaper);
}

constexpr System<StepContext> kPlace[] = {
    {"carry_tractions", "keeps tractions at their place on the body",
     "a body with contact model paper and friction", any_paper_friction, carry_tractions,
     columns<TractionFrame>(), columns<CellTraction>()},
    {"paper_normal_forces", "normal force f = k1 x + k3 x^3", "a body with contact model paper",
     any_with<ContactModel::kPaper>, paper_normal_forces, columns<RegionNormal, Contact>()},
};
constexpr System<StepContext> kSolve[] = {
    {"paper_friction_forces", "friction and contact torque, equations (2)-(9), (14)",
     "a body with contact model paper and friction", any_paper_friction, paper_friction_forces,
     columns<RegionFriction, CellTraction>()},
};

}  // namespace

// The force is a formula of the depth, which stiffens without bound, and knows of no other region.
const ContactLaw kPaperLaw{
    .model = ContactModel::kPaper,
    .answers_from = std::numeric_limits<double>::infinity(),
    .is_bounded = false,
    .needs_motion = false,
    .place = kPlace,
    .solve = kSolve,
    .follow = follow_overlap,
    .find_cells = find_overlap,
    .follows_material = true,
};

}  // namespace torsion
