#pragma once

#include <string>

#include "ecs/result.hpp"
#include "ecs/state.hpp"

namespace torsion::engine {

/// Whether a state has the tables that a model needs, and everything in it that names rows names
/// rows that exist. For states that come from outside the program; a step trusts its tables. Values
/// (lengths, forces) are not judged. The error says table, row, and what it points at.
Result<Done> check_state(const Model& model, const State& state);

}  // namespace torsion::engine
