#pragma once

#include <cstdint>

namespace torsion::engine {

/// Rows [first, first + count) of one table.
struct Range {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  [[nodiscard]] std::uint32_t end() const { return first + count; }
  bool operator==(const Range&) const = default;
};

}  // namespace torsion::engine
