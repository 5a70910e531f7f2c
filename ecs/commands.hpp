#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ecs/entity.hpp"
#include "ecs/table.hpp"
#include "ecs/world.hpp"

namespace torsion {

/// The handle that a row of an entity table carries.
template <class AnyTable>
[[nodiscard]] Entity& handle_of(AnyTable& table, std::uint32_t row) {
  return table.template at<Entity>(row);
}

[[nodiscard]] inline Entity& handle_of(RegionTable& table, std::uint32_t row) {
  return table.at<RegionIdentity>(row).self;
}

/// Rows to add to and take from one entity table, recorded while systems read it and applied
/// between them, in the order recorded. Row order is kept: what is left moves up, new rows come
/// last. Memory is taken once, by `reserve`.
template <class AnyTable>
class Commands;

template <Component... Ts>
class Commands<Table<Ts...>> {
 public:
  /// What `apply` did. `refused` counts rows that did not fit into the table or its pool: set a
  /// fault that says so.
  struct Applied {
    std::uint32_t created = 0;
    std::uint32_t destroyed = 0;
    std::uint32_t stale = 0;  // destroy of what was gone already
    std::uint32_t refused = 0;
  };

  /// Takes memory for `capacity` commands between two calls of `apply`. Load time only.
  void reserve(std::uint32_t capacity) {
    staged_.reserve(capacity);
    records_.clear();
    records_.reserve(capacity);
  }

  /// Records a new row. Fill its columns in `staged()` at the row returned, but for the handle,
  /// which `apply` sets. nullopt when no more commands fit.
  std::optional<std::uint32_t> create() {
    if (records_.size() == records_.capacity()) {
      return std::nullopt;
    }
    const std::optional<Range> row = staged_.append();
    if (!row) {
      return std::nullopt;
    }
    records_.push_back({Entity{}, row->first});
    return row->first;
  }

  /// Records the end of `entity`. False when no more commands fit.
  bool destroy(Entity entity) {
    if (records_.size() == records_.capacity()) {
      return false;
    }
    records_.push_back({entity, kNothingStaged});
    return true;
  }

  /// The rows to be, in the order of `create`.
  [[nodiscard]] Table<Ts...>& staged() { return staged_; }

  [[nodiscard]] bool empty() const { return records_.empty(); }

  /// Carries all commands out on `table` and on the `pool` of its handles, and forgets them.
  /// Allocates nothing.
  Applied apply(Table<Ts...>& table, EntityPool& pool) {
    Applied applied;
    for (const Record& record : records_) {
      if (record.staged_row != kNothingStaged) {
        const bool fits = add(table, pool, record.staged_row);
        (fits ? applied.created : applied.refused) += 1;
      } else {
        const bool there = remove(table, pool, record.entity);
        (there ? applied.destroyed : applied.stale) += 1;
      }
    }
    records_.clear();
    staged_.clear();
    return applied;
  }

 private:
  static constexpr std::uint32_t kNothingStaged = UINT32_MAX;

  struct Record {
    Entity entity;
    std::uint32_t staged_row = kNothingStaged;
  };

  bool add(Table<Ts...>& table, EntityPool& pool, std::uint32_t staged_row) {
    const std::optional<Entity> entity = pool.create(table.size());
    if (!entity) {
      return false;
    }
    const std::optional<Range> row = table.append();
    if (!row) {
      pool.destroy(*entity);
      return false;
    }
    ((table.template at<Ts>(row->first) = staged_.template at<Ts>(staged_row)), ...);
    handle_of(table, row->first) = *entity;
    return true;
  }

  static bool remove(Table<Ts...>& table, EntityPool& pool, Entity entity) {
    const std::optional<std::uint32_t> row = pool.row(entity);
    if (!row) {
      return false;
    }
    pool.destroy(entity);
    table.erase(*row);
    for (std::uint32_t behind = *row; behind < table.size(); ++behind) {
      pool.move(handle_of(table, behind), behind);
    }
    return true;
  }

  Table<Ts...> staged_;
  std::vector<Record> records_;
};

}  // namespace torsion
