#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ecs/world.hpp"

namespace torsion {

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
MainBeam main_beam(const World& world, std::uint32_t body, const glm::dvec3& tip);

/// Elastic state of a main beam under a force and a moment at its tip, in the beam's frame (first,
/// second, direction): Timoshenko's beam theory, exact for each piece. Torsion is not in it.
struct BeamDeflection {
  std::array<glm::dvec2, kBeamStations + 1>
      turn;  // rad about first and second, at the ends of the pieces
  std::array<glm::dvec3, kBeamStations + 1> shift;  // m, at the ends of the pieces
  std::array<glm::dvec3, kBeamStations> bending;  // 1/(N m^2): 11, 22 and 12 of the inverse of E I
  std::array<glm::dvec3, kBeamStations> straining;  // 1/N: 1/(kappa G A), the same, 1/(E A)
  glm::dvec3 force{0.0};                            // N, at the tip
  glm::dvec2 moment{0.0};                           // N m, at the tip
  double length = 0.0;                              // m
};

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

}  // namespace torsion
