#pragma once

#include <cstdint>
#include <optional>

#include "ecs/components.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion::engine {

/// How a tool lies to a body's rest shape as the material next to it sees it where all other tools
/// have moved it. A body that gives way as a whole may be pushed against a tool by others, or away
/// from it: contact begins where the material is, not where it was at rest.
/// @param tool_in_body  where the tool is
/// @return nothing where they have not moved it, or not as far as to the tool
std::optional<Pose> seen_from_moved_surface(const StepContext& context, std::uint32_t tool,
                                            std::uint32_t body, const Pose& tool_in_body);

}  // namespace torsion::engine
