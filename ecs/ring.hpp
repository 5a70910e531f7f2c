#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>

#include "ecs/column.hpp"

namespace torsion::engine {

/// A fixed queue from one writer thread to one reader thread: every value arrives, in order, or
/// `push` says that it did not fit. Neither side ever waits.
///
/// `written_` and `read_` only grow (64 bits: they do not wrap in practice); each is stored by one
/// side. A store with release after the value is copied, and a load with acquire before it is,
/// order the copies between the threads.
template <class T>
class Ring {
  static_assert(std::is_trivially_copyable_v<T>, "a value is copied while the other thread runs");

 public:
  Ring() = default;
  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;
  Ring(Ring&&) = delete;
  Ring& operator=(Ring&&) = delete;
  ~Ring() = default;

  /// Takes memory for at least `capacity` values and empties the ring. Before the threads start.
  void reserve(std::size_t capacity) {
    const std::size_t size = std::bit_ceil(capacity);
    values_ = std::make_unique<T[]>(size);
    mask_ = size - 1;
    written_.store(0, std::memory_order_relaxed);
    read_.store(0, std::memory_order_relaxed);
  }

  [[nodiscard]] std::size_t capacity() const { return values_ ? mask_ + 1 : 0; }

  /// Writer: false, and nothing changed, when the ring is full.
  bool push(const T& value) {
    const std::uint64_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) >= capacity()) {
      return false;
    }
    values_[written & mask_] = value;
    written_.store(written + 1, std::memory_order_release);
    return true;
  }

  /// Reader: the oldest value, or nullopt when the ring is empty.
  std::optional<T> pop() {
    const std::uint64_t read = read_.load(std::memory_order_relaxed);
    if (read == written_.load(std::memory_order_acquire)) {
      return std::nullopt;
    }
    const T value = values_[read & mask_];
    read_.store(read + 1, std::memory_order_release);
    return value;
  }

 private:
  std::unique_ptr<T[]> values_;
  std::size_t mask_ = 0;
  alignas(kColumnAlignment) std::atomic<std::uint64_t> written_ = 0;
  alignas(kColumnAlignment) std::atomic<std::uint64_t> read_ = 0;
};

}  // namespace torsion::engine
