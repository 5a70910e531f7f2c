#include "ecs/hash.hpp"

// Inlined, the state can live on the stack; xxhash.h forbids that with the shared library.
#define XXH_INLINE_ALL
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>

#include <xxhash.h>

namespace torsion::engine {
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

template <class Tables>
void add_tables(XXH3_state_t& state, const Tables& tables) {
  std::apply([&state](const auto&... table) { (add_table(state, table), ...); }, tables);
}

template <class T>
void add_struct(XXH3_state_t& state, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  XXH3_64bits_update(&state, &value, sizeof(value));
}

template <class T>
void add_rows(XXH3_state_t& state, const std::vector<T>& rows) {
  static_assert(std::is_trivially_copyable_v<T>);
  add_number(state, static_cast<std::uint32_t>(rows.size()));
  XXH3_64bits_update(&state, rows.data(), rows.size() * sizeof(T));
}

void add_script(XXH3_state_t& state, const MotionScript& script) {
  for (const MotionLink& link : script.links) {
    add_struct(state, link.translation);
    add_struct(state, link.rotation);
    add_struct(state, link.scale);
    for (const KeyedChannel* channel : {&link.animated_translation, &link.animated_rotation}) {
      add_struct(state, channel->interpolation);
      add_rows(state, channel->times);
      add_rows(state, channel->values);
    }
  }
}

}  // namespace

std::uint64_t hash(const Model& model) {
  XXH3_state_t state;
  XXH3_INITSTATE(&state);
  XXH3_64bits_reset(&state);
  add_struct(state, model.settings);
  add_struct(state, model.dt);
  add_tables(state, model.tables());
  for (std::uint32_t body = 0; body < model.body_scripts.size(); ++body) {
    if (model.moves(body)) {
      add_number(state, body);
      add_script(state, model.body_scripts[body]);
    }
  }
  return XXH3_64bits_digest(&state);
}

std::uint64_t hash(const State& state) {
  XXH3_state_t sum;
  XXH3_INITSTATE(&sum);
  XXH3_64bits_reset(&sum);
  add_struct(sum, state.clock);
  add_tables(sum, state.tables());
  return XXH3_64bits_digest(&sum);
}

std::uint64_t hash(const World& world) {
  const std::uint64_t both[] = {hash(world.model), hash(world.state)};
  return XXH3_64bits(both, sizeof(both));
}

ColumnHashes hash_columns(const State& state) {
  ColumnHashes hashes{};
  std::size_t column = 0;
  const auto add = [&](std::span<const std::byte> bytes, std::size_t /*row_size*/) {
    hashes[column++] = XXH3_64bits(bytes.data(), bytes.size());
  };
  std::apply([&add](const auto&... table) { (table.each_column(add), ...); }, state.tables());
  return hashes;
}

ColumnSet differing(const ColumnHashes& a, const ColumnHashes& b) {
  ColumnSet set;
  for (std::size_t column = 0; column < kStateColumns; ++column) {
    set.bits |= std::uint64_t{a[column] != b[column]} << column;
  }
  return set;
}

}  // namespace torsion::engine
