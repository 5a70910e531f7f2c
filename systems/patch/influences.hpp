#pragma once

#include "ecs/state.hpp"
#include "systems/half_space/influence.hpp"

namespace torsion {

/// The tables that a region with contact model patch works with.
struct RegionInfluences {
  InfluenceTables tables;
  bool coupled = false;  // pressure moves the surface sideways
  bool changed = false;  // they are not those of the last step
};

/// The half-space's, from its body; on a layer with body model compliance its own, which are filled
/// when its grid or the thickness has changed. Writes LayerGrid.
RegionInfluences region_influences(const Model& model, State& state, std::uint32_t region);

}  // namespace torsion
