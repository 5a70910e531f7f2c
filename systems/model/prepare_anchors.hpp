#pragma once

#include <cstdint>
#include <vector>

#include "ecs/model.hpp"
#include "ecs/scene_description.hpp"

namespace torsion {

/// Anchors of one body and the sections of their beams, kBeamStations rows an anchor, root first.
struct PreparedAnchors {
  std::vector<AnchorRest> anchors;
  std::vector<BeamSection> sections;
};

/// Spreads anchors over a body's rest surface, away from what is fixed, and cuts the straight beam
/// from the fixed point to each of them. Load time only; the same input gives the same bits.
/// Returns nothing (empty vectors) only for a body whose whole surface is fixed.
/// @param description  surfaces (m, body frame) and the fixed region
/// @param model  read: parts, fields, field_nodes, field_bricks, fixed_volumes
/// @param parts  the body's rows in world.parts
/// @param volumes  the body's rows in world.fixed_volumes
/// @param count  how many anchors, 8 to 60
PreparedAnchors prepare_anchors(const BodyDescription& description, const Model& model, Range parts,
                                Range volumes, std::uint32_t count = kAnchorsPerBody);

}  // namespace torsion
