#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace torsion {

/// A handle that survives row moves and knows when what it named is gone.
struct Entity {
  std::uint32_t slot = UINT32_MAX;
  std::uint32_t generation = 0;
  bool operator==(const Entity&) const = default;
};

/// Rows [first, first + count) of one table.
struct Range {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  [[nodiscard]] std::uint32_t end() const { return first + count; }
  bool operator==(const Range&) const = default;
};

/// Maps handles of one table to its rows. A slot's generation is odd while it is alive.
class EntityPool {
 public:
  /// Takes memory for `capacity` handles. Load time only.
  void reserve(std::uint32_t capacity);

  /// A new handle for `row`, or nullopt when every slot is taken.
  std::optional<Entity> create(std::uint32_t row);

  /// The row of `entity`, or nullopt for a stale or never valid handle.
  [[nodiscard]] std::optional<std::uint32_t> row(Entity entity) const;

  /// Notes that the entity's row moved. False for a stale handle.
  bool move(Entity entity, std::uint32_t row);

  /// Ends the handle. False for a stale handle.
  bool destroy(Entity entity);

  [[nodiscard]] std::uint32_t capacity() const { return static_cast<std::uint32_t>(slots_.size()); }

  struct Slot {
    std::uint32_t generation = 0;
    std::uint32_t row = 0;  // while free: the next free slot
  };
  // The whole state, for saving, loading and hashing.
  [[nodiscard]] const std::vector<Slot>& slots() const { return slots_; }
  [[nodiscard]] std::vector<Slot>& slots() { return slots_; }
  [[nodiscard]] std::uint32_t first_free() const { return first_free_; }
  void set_first_free(std::uint32_t slot) { first_free_ = slot; }

 private:
  std::vector<Slot> slots_;
  std::uint32_t first_free_ = UINT32_MAX;
};

}  // namespace torsion
