#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "ecs/model.hpp"
#include "systems/body/skeleton/main_beam.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"
#include "systems/contact/support/body_law.hpp"

namespace torsion {

extern const BodyLaw kSkeletonLaw;

/// Of a beam of main_beam: 1 / integral of ds / (E A) along it, E A / L for a prism. A body without
/// anchors gives its length and no stiffness.
BeamSpring beam_spring(const MainBeam& beam, const Elasticity& elasticity);

/// The beam to every region whose force it is in series with, one of contact model paper on a body
/// whose body model is kSkeleton, to where p_eq was at rest. Writes ContactScratch::beams.
void main_beams(StepContext& context);

}  // namespace torsion
