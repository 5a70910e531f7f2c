#pragma once

#include "ecs/world.hpp"

namespace torsion::engine::test {

/// A world with a row or more in every table, each byte set and none like its neighbour: what a
/// test of the store needs, no physics. `seed` chooses the bytes.
World small_world(unsigned seed);

}  // namespace torsion::engine::test
