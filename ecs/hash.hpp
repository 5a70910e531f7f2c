#pragma once

#include <array>
#include <cstdint>

#include "ecs/column_set.hpp"
#include "ecs/world.hpp"

namespace torsion::engine {

/// XXH3 (64 bits) over every row of every column of every table: two with the same hash hold the
/// same bits. Capacities do not count. Allocates nothing; reads all of it (about 10 GB/s).
[[nodiscard]] std::uint64_t hash(const Model& model);
[[nodiscard]] std::uint64_t hash(const State& state);
/// Of both.
[[nodiscard]] std::uint64_t hash(const World& world);

/// One for each column of the state's tables. Allocates nothing.
using ColumnHashes = std::array<std::uint64_t, kStateColumns>;
[[nodiscard]] ColumnHashes hash_columns(const State& state);
[[nodiscard]] ColumnSet differing(const ColumnHashes& a, const ColumnHashes& b);

}  // namespace torsion::engine
