#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "ecs/column.hpp"

namespace torsion::engine {

/// The newest value from one writer thread to one reader thread. Neither ever waits, retries or
/// sees a half-written value; what the reader did not fetch in time is overwritten. For what must
/// not be lost: ecs/ring.hpp.
///
/// Three slots: the writer owns `back`, the reader owns `front`, the third lies in the middle. One
/// atomic word holds the middle's index and whether it is fresh; publishing and refreshing each
/// swap their own slot with it. The swap's release hands the slot's contents over, its acquire
/// takes those of the slot received: both sides do both.
template <class T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;
  TripleBuffer(TripleBuffer&&) = delete;
  TripleBuffer& operator=(TripleBuffer&&) = delete;
  ~TripleBuffer() = default;

  /// Calls f on each of the three values, to size them. Before the threads start.
  template <class F>
  void prepare(F&& f) {
    for (Slot& slot : slots_) {
      f(slot.value);
    }
  }

  /// Writer: the value to fill. Holds what was published some time ago, not the newest.
  [[nodiscard]] T& back() { return slots_[back_].value; }

  /// Writer: makes what `back()` holds the newest value; `back()` is another slot afterwards.
  void publish() { back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex; }

  /// Writer: whether the reader has fetched what was last published. A hint: may be out of date at
  /// once.
  [[nodiscard]] bool taken() const {
    return (middle_.load(std::memory_order_relaxed) & kFresh) == 0;
  }

  /// Reader: makes `front()` the newest value. False, and no change, when nothing was published
  /// since.
  bool refresh() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) {
      return false;
    }
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  /// Reader: the value of the last `refresh`, stable until the next. Default-made before the first.
  [[nodiscard]] const T& front() const { return slots_[front_].value; }

 private:
  static constexpr std::uint32_t kIndex = 3;
  static constexpr std::uint32_t kFresh = 4;

  struct alignas(kColumnAlignment) Slot {
    T value{};
  };

  // On cache lines of their own: the two threads touch different ones.
  std::array<Slot, 3> slots_;
  alignas(kColumnAlignment) std::uint32_t back_ = 0;
  alignas(kColumnAlignment) std::atomic<std::uint32_t> middle_ = 1;
  alignas(kColumnAlignment) std::uint32_t front_ = 2;
};

}  // namespace torsion::engine
