#include "ecs/memory.hpp"

#include <tuple>

namespace torsion::engine {

std::size_t memory_of(const World& world) {
  std::size_t bytes = 0;
  const auto add = [&bytes](const auto&... tables) {
    (tables.each_column(
         [&](auto /*rows*/, std::size_t row_size) { bytes += row_size * tables.capacity(); }),
     ...);
  };
  std::apply(add, world.model.tables());
  std::apply(add, world.state.tables());
  return bytes;
}

}  // namespace torsion::engine
