#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "ecs/world.hpp"
#include "systems/body/skeleton/main_beam.hpp"
#include "systems/contact/step_context.hpp"
#include "systems/contact/support/body_law.hpp"

namespace torsion {

extern const BodyLaw kSkeletonLaw;

/// The beams that the systems of one step share.
struct SkeletonScratch {
  std::vector<MainBeam> beams;  // (regions) by block of cells

  /// Takes all memory that a step of `world` can need.
  void reserve(const World& world);
};

/// Elastic sums along the straight main beam from a body's fixed point q_f (root) to a point of its
/// surface.
struct BeamSummary {
  double length = 0.0;              // L, m: at least a thousandth of the body's size
  double axial_stiffness = 0.0;     // 1 / integral of ds / (E A), N/m; E A / L for a prism
  double area = 0.0;                // m^2: harmonic mean of the section area along the beam
  double polar = 0.0;               // m^4: harmonic mean of the polar second moment along the beam
  double torsion_compliance = 0.0;  // integral of ds / (G J), J Saint-Venant's constant, rad/(N m)
};

/// Of a beam of main_beam. A body without anchors gives its length and zeros.
BeamSummary beam_summary(const MainBeam& beam, const Elasticity& elasticity);

/// The beam to every region of a body whose body model is kSkeleton, to where p_eq was at rest.
/// Writes SkeletonScratch::beams and ContactScratch::beams.
void main_beams(StepContext& context);

/// Displacements of the anchors of each body whose body model is kSkeleton, summed over its regions
/// in their order of formation: bending, shear, stretch and sideways contraction of a Timoshenko
/// beam from q_f to where p_eq was at rest. Torsion about the beam is left out: the twist angles of
/// the drawn vertices carry it (systems/surface/surface_field.hpp). Writes AnchorMotion; zero for
/// bodies with another model. Takes the beams that main_beams found. Source: docs/models.md, "Body
/// model skeleton".
void skeleton(StepContext& context);

}  // namespace torsion
