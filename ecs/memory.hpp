#pragma once

#include <cstddef>

#include "ecs/world.hpp"

namespace torsion::engine {

/// What the tables of a world take when they are full, bytes.
[[nodiscard]] std::size_t memory_of(const World& world);

}  // namespace torsion::engine
