#pragma once

#include <functional>
#include <vector>

#include "ecs/model.hpp"
#include "ecs/result.hpp"
#include "ecs/scene_description.hpp"
#include "systems/model/expected_place.hpp"

namespace torsion {

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
/// @param progress  called with 0 to 1 while there is something to solve, if set
Result<PreparedCompliance> prepare_compliance(const BodyDescription& description,
                                              const Model& model, std::uint32_t row,
                                              const ExpectedPlace& place, bool use_cache,
                                              const std::function<void(double)>& progress);

}  // namespace torsion
