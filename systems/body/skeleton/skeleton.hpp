#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ecs/model.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"
#include "systems/contact/support/body_law.hpp"

namespace torsion::engine {

/// The straight beam from a body's fixed point q_f (its root) to a point of the surface, cut into
/// kBeamStations pieces of equal length and constant section.
struct MainBeam {
  double length = 0.0;        // m
  glm::dvec3 direction{0.0};  // body, unit, from the root to the tip
  glm::dvec3 first{0.0};      // body, unit: first transverse axis
  glm::dvec3 second{0.0};     // body, unit: second transverse axis
  bool has_sections = false;  // false: the body has no anchors
  std::array<BeamSection, kBeamStations> sections;
};

/// The beam to `tip`; its sections are means of those of the anchors' beams around, weighted so
/// that they are the anchor's own at an anchor and change continuously in between.
/// @param tip  m, body frame
MainBeam main_beam(const Model& model, std::uint32_t body, const glm::dvec3& tip);

/// One piece of a deflected beam, t [m] from its start, in the beam's frame (first, second,
/// direction): turn = turn0 + turn1 t + turn2 t^2, rad about first and second; shift = shift0 +
/// shift1 t + shift2 t^2 + shift3 t^3, m, the last two across the beam only.
struct BeamPiece {
  glm::dvec2 turn0{0.0}, turn1{0.0}, turn2{0.0};
  glm::dvec3 shift0{0.0}, shift1{0.0};
  glm::dvec2 shift2{0.0}, shift3{0.0};
};

/// Elastic state of a main beam under a force and a moment at its tip: Timoshenko's beam theory,
/// exact for each piece. Torsion is not in it.
struct BeamDeflection {
  std::array<BeamPiece, kBeamStations> pieces;
  std::array<double, kBeamStations> strain{};  // axial, of each piece
  double piece_length = 0.0;                   // m
};

/// @param force   N, at the tip, beam frame
/// @param moment  N m, at the tip, about first and second
BeamDeflection deflect(const MainBeam& beam, const Elasticity& elasticity, const glm::dvec3& force,
                       const glm::dvec2& moment);

/// Where the beam's section at `along` from the root went.
struct SectionMotion {
  glm::dvec3 shift{0.0};  // m, beam frame
  glm::dvec2 turn{0.0};   // rad about first and second
};

/// @param along  m from the root, 0 to length
SectionMotion section_motion(const BeamDeflection& deflection, double along);

/// Axial strain at `along`, linear between the pieces' middles.
double axial_strain(const BeamDeflection& deflection, double along);

extern const BodyLaw kSkeletonLaw;

/// Of a beam of main_beam: 1 / integral of ds / (E A) along it, E A / L for a prism. A body without
/// anchors gives its length and no stiffness.
BeamSpring beam_spring(const MainBeam& beam, const Elasticity& elasticity);

/// The beam to every region whose force it is in series with, one of contact model paper on a body
/// whose body model is kSkeleton, to where p_eq was at rest. Writes ContactScratch::beams.
void main_beams(StepContext& context);

}  // namespace torsion::engine
