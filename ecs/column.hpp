#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include "ecs/assert.hpp"

namespace torsion::engine {

/// Plain data: copied by memcpy, saved and hashed byte by byte, uploaded to a GPU as it is.
template <class T>
concept Component = std::is_trivially_copyable_v<T> && std::is_standard_layout_v<T> && sizeof(T) %
                        4 ==
                    0;

inline constexpr std::size_t kColumnAlignment = 64;  // bytes: a cache line, and an AVX-512 register

/// One contiguous, 64-byte-aligned array of components that never moves once reserved.
template <Component T>
class Column {
 public:
  /// Takes memory for `capacity` rows, zero-filled; what was there is gone. Load time only.
  void reserve(std::uint32_t capacity) {
    const std::size_t bytes = rounded_bytes(capacity);
    storage_.reset(bytes == 0 ? nullptr
                              : ::operator new (bytes, std::align_val_t{kColumnAlignment}));
    if (bytes != 0) {
      std::memset(storage_.get(), 0, bytes);
    }
  }

  [[nodiscard]] T* data() { return static_cast<T*>(storage_.get()); }
  [[nodiscard]] const T* data() const { return static_cast<const T*>(storage_.get()); }

 private:
  struct Release {
    void operator()(void* memory) const {
      ::operator delete (memory, std::align_val_t{kColumnAlignment});
    }
  };

  static std::size_t rounded_bytes(std::uint32_t rows) {
    return (rows * sizeof(T) + kColumnAlignment - 1) / kColumnAlignment * kColumnAlignment;
  }

  std::unique_ptr<void, Release> storage_;
};

}  // namespace torsion::engine
