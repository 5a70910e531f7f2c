#pragma once

#include <vector>

#include "systems/contact/step_context.hpp"
#include "systems/contact/support/body_law.hpp"

namespace torsion::engine {

extern const BodyLaw kComplianceLaw;

/// What compliance needs while it works on one body.
struct ComplianceScratch {
  std::vector<double> matrix;   // (6 kMaxRegionsPerBody)^2, row-major
  std::vector<double> copy;     // likewise
  std::vector<double> inverse;  // likewise
  std::vector<double> full;     // likewise

  /// Takes all memory that a step can need; none where no body has this model.
  void reserve(const State& state);
};

/// The body's own compliance in series with its contacts: how far the material under each region
/// has gone under the tractions of all regions of the body, as a rigid body and beyond. Reads what
/// the contact models write; writes RegionSupport, SupportField, SupportFit and RegionCoupling.
///
/// The rigid part is one step of Newton's method for u = C f(u), all regions at once, so their
/// order does not matter: du = (I + C K)^-1 (C f - u), with K the contacts' stiffness without slip.
/// On a body that is soft beside its contacts it goes on from there where they slip (slip.hpp);
/// on others K is too large then and du too small, so it converges all the same. What
/// is left, how the material bends and stretches under the contact, is small against the contact's
/// own compliance and follows by plain iteration.
void compliance(StepContext& context);

}  // namespace torsion::engine
