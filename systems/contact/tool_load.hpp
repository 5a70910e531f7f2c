#pragma once

#include <cstdint>

#include "ecs/model.hpp"
#include "ecs/state.hpp"

namespace torsion::engine {

/// What the bodies exert on a tool, in parts, as the contact models compute it: without the fades
/// of events and faults that ToolWrench has. World frame.
struct ToolLoad {
  double normal_sum = 0.0;        // N: the normal forces' sizes, summed over the regions
  Wrench normal;                  // N and N m: the normal forces, and r x F of them
  Wrench friction;                // N and N m: the friction forces, and r x F of them
  glm::dvec3 couple{0.0};         // N m: the sum of the contact couples, which no r x F contains
  std::uint32_t main_region = 0;  // row of the region with the largest normal force
  std::uint32_t regions = 0;      // of the tool; 0: there is no main region
};

/// @param about  m, world: what the torques are about
/// Allocates nothing.
ToolLoad tool_load(const State& state, std::uint32_t tool, const glm::dvec3& about);

}  // namespace torsion::engine
