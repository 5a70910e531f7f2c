#include "ecs/entity.hpp"

namespace torsion {

void EntityPool::reserve(std::uint32_t capacity) {
  slots_.assign(capacity, Slot{});
  for (std::uint32_t slot = 0; slot < capacity; ++slot) {
    slots_[slot].row = slot + 1 < capacity ? slot + 1 : UINT32_MAX;
  }
  first_free_ = capacity > 0 ? 0 : UINT32_MAX;
}

std::optional<Entity> EntityPool::create(std::uint32_t row) {
  if (first_free_ == UINT32_MAX) {
    return std::nullopt;
  }
  const std::uint32_t slot = first_free_;
  first_free_ = slots_[slot].row;
  slots_[slot].generation += 1;
  slots_[slot].row = row;
  return Entity{slot, slots_[slot].generation};
}

std::optional<std::uint32_t> EntityPool::row(Entity entity) const {
  const bool alive = entity.slot < slots_.size() && entity.generation % 2 == 1 &&
                     slots_[entity.slot].generation == entity.generation;
  return alive ? std::optional{slots_[entity.slot].row} : std::nullopt;
}

bool EntityPool::move(Entity entity, std::uint32_t row) {
  if (!this->row(entity)) {
    return false;
  }
  slots_[entity.slot].row = row;
  return true;
}

bool EntityPool::destroy(Entity entity) {
  if (!row(entity)) {
    return false;
  }
  slots_[entity.slot].generation += 1;
  slots_[entity.slot].row = first_free_;
  first_free_ = entity.slot;
  return true;
}

}  // namespace torsion
