#pragma once

#include "ecs/schedule.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion::engine {

/// One step of a debug build: as Schedule::run, and of one system, another in each step, what it
/// says is checked. Stops the program with that system's and the column's name.
void run_with_checks(Schedule<StepContext>& schedule, StepContext& context);

}  // namespace torsion::engine
