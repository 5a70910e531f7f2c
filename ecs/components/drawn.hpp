#pragma once

// What is found of a step for those who draw it, and only then. No step reads it.
// Units, frames and "written by": ecs/components.hpp.

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ecs/components/anchors.hpp"

namespace torsion::engine {

inline constexpr std::uint32_t kFieldDiscs = 20;
inline constexpr std::uint32_t kFieldBlocks = 5;

/// Normal force that a part of a region presses into the body.
struct PressedBlock {
  glm::dvec2 place{0.0};  // m, grid: its pressure centre
  double force = 0.0;     // N
};

/// What a region of an elastic half-space does to the body around it, small enough for a snapshot:
/// bonded discs turned by small angles, and forces. Their exact fields add up to that of the
/// region; all zero for contact model `paper`. Written by: region_fields.
struct RegionField {
  glm::dvec2 center{0.0};         // m, grid: of the discs
  double radius = 0.0;            // m: of the largest disc; 0: there is no such field
  double spread = 0.0;            // m: width over which the force of a block is spread
  double turn[kFieldDiscs] = {};  // rad: of the disc of radius (j + 1) / kFieldDiscs * radius
  PressedBlock blocks[kFieldBlocks * kFieldBlocks];
};

/// Angle about the region's normal by which each anchor of its body turns because of the region,
/// beyond what the half-space under the region does there; small angles. With it a picture can turn
/// the body as far as it turns, where AnchorMotion alone would move it along tangents. Written by:
/// anchor_motions; all zero with other body models than compliance.
struct AnchorTurns {
  double turn[kAnchorsPerBody] = {};  // rad
  // How far the material under the contact has gone round at distance r from rest_point, rad,
  // as RegionSupport and SupportField have it, from which the contact sees the tool:
  double support = 0.0;         // rad: at r = 0
  double support_growth = 0.0;  // rad/m^2: times r^2, what it is more
};

/// How far the material at an anchor has gone, by all of the body's regions. Written by:
/// skeleton_motions, anchor_motions.
struct AnchorMotion {
  glm::dvec3 displacement{0.0};  // m, body
};

}  // namespace torsion::engine
