#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ecs/model.hpp"
#include "ecs/result.hpp"
#include "ecs/scene_description.hpp"
#include "ecs/world.hpp"
#include "systems/model/expected_rolling.hpp"
#include "systems/model/options.hpp"

namespace torsion::engine {

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

/// Anchors of a body with body model compliance, and the matrix between them.
struct PreparedCompliance {
  std::vector<AnchorRest> anchors;  // where the first of the ports are
  std::vector<CompliancePort> ports;
  std::vector<ComplianceValue> values;  // as OwnedRows::compliance
};

/// Where the body is clamped: its fixed face or volumes; at a fixed point a ball of a quarter of
/// the body's shortest side, because a point cannot hold an elastic body. Load time only; the first
/// time for a shape and clamp it takes seconds, then it comes from the cache. The same input gives
/// the same bits.
/// Fails where elements or ports are too coarse for the body's walls.
/// @param model     shapes and the body `row` are there
/// @param place     where contacts are expected
/// @param threads   at least 1
/// @param progress  called with 0 to 1 while there is something to solve, if set
Result<PreparedCompliance> prepare_compliance(const BodyDescription& description,
                                              const Model& model, std::uint32_t row,
                                              const ExpectedPlace& place, std::uint32_t threads,
                                              bool use_cache,
                                              const std::function<void(double)>& progress);

/// A scene's tables, filled.
struct PreparedWorld {
  World world;
  std::vector<ModelChoice> choices;       // (bodies)
  std::vector<std::string> united_nodes;  // whose meshes overlap and count as one solid
};

/// Load-time work: distance fields, surface samples, anchors, beam sections; then all tables,
/// filled. Bodies and tools get the rows that they have in `scene`. Fails with a message that names
/// the node.
Result<PreparedWorld> prepare_world(const SceneDescription& scene, const PrepareOptions& options);

/// The same for bodies of 1 Pa, whatever the scene says: what world_of_materials starts from.
Result<PreparedWorld> prepare_unit_world(const SceneDescription& scene,
                                         const PrepareOptions& options);

/// A world that prepare_world would make, without preparing anything again: the same bits.
/// @param unit   by prepare_unit_world, never stepped
/// @param scene  the one that `unit` was made of but for the bodies' Young's modulus, density and
///               friction and the tools' masses and inertias
World world_of_materials(const World& unit, const SceneDescription& scene);

}  // namespace torsion::engine
