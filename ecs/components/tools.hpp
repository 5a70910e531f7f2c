#pragma once

// Where the tools are and what they feel.
// Units, frames and "written by": ecs/components.hpp.

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "ecs/components/basics.hpp"

namespace torsion::engine {

/// The tool node's frame in the world, now and one step ago. Written by: couple_tools.
struct ToolPose {
  Pose now;
  Pose before;
};

/// Motion over the step, of the mass centre. Written by: couple_tools.
struct ToolMotion {
  glm::dvec3 velocity{0.0};          // m/s, world
  glm::dvec3 angular_velocity{0.0};  // rad/s, world
  glm::dvec3 mass_center{0.0};       // m, world
  glm::dvec3 axis{
      0.0};  // world, unit once the tool has turned: the rotation axis with a short memory
  double axis_turn = 0.0;  // rad, how much turning that memory holds
};

/// Written by: load.
struct MassProperties {
  double mass = 1.0;        // kg
  glm::dvec3 center{0.0};   // m, tool: mass centre
  glm::dmat3 inertia{0.0};  // kg m^2 about the mass centre, tool axes
};

enum class WrenchState : std::uint32_t { kLive, kFalling, kRising };

/// The product: what the bodies exert on the tool, about its mass centre, world frame. Written by:
/// sum_wrenches.
struct ToolWrench {
  Wrench total;        // as output
  Wrench held;         // what was output when a fault began; fades from there
  double work = 0.0;   // J, done by the tool's holder so far
  double share = 1.0;  // of `held` (falling) or of the computed wrench (rising) that is output
  WrenchState state = WrenchState::kLive;
  std::uint32_t padding = 0;
};

}  // namespace torsion::engine
