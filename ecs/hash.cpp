#include "ecs/hash.hpp"

// Inlined, the state can live on the stack; xxhash.h forbids that with the shared library.
#define XXH_INLINE_ALL
#include <cstddef>
#include <span>

#include <xxhash.h>

namespace torsion {
namespace {

void add_number(XXH3_state_t& state, std::uint32_t number) {
  XXH3_64bits_update(&state, &number, sizeof(number));
}

template <class AnyTable>
void add_table(XXH3_state_t& state, const AnyTable& table) {
  // The row count keeps rows that move from one table to the next from going unseen.
  add_number(state, table.size());
  table.each_column([&state](std::span<const std::byte> bytes, std::size_t /*row_size*/) {
    XXH3_64bits_update(&state, bytes.data(), bytes.size());
  });
}

}  // namespace

std::uint64_t hash(const World& world) {
  XXH3_state_t state;
  XXH3_INITSTATE(&state);
  XXH3_64bits_reset(&state);
  std::apply([&state](const auto&... tables) { (add_table(state, tables), ...); }, world.tables());
  return XXH3_64bits_digest(&state);
}

}  // namespace torsion
