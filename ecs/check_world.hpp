#pragma once

#include <string>

#include "ecs/result.hpp"
#include "ecs/world.hpp"

namespace torsion {

/// Whether everything in a world that names rows names rows that exist: ranges, neighbours, tree
/// links, handles. For worlds that come from outside the program; a step trusts its tables. Values
/// (lengths, forces) are not judged. The error says table, row, and what it points at.
Result<Done> check_world(const World& world);

}  // namespace torsion
