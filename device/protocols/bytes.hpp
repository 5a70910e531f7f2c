#pragma once

// Numbers in packets, least significant byte first.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace torsion::engine {

using Bytes = std::span<const std::uint8_t>;

/// @pre at + 2 <= bytes.size()
inline std::int16_t int16_at(Bytes bytes, std::size_t at) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8)));
}

/// @pre at + 2 <= bytes.size()
inline void put_int16(std::span<std::uint8_t> bytes, std::size_t at, std::int16_t value) {
  const auto bits = static_cast<std::uint16_t>(value);
  bytes[at] = static_cast<std::uint8_t>(bits & 0xFFU);
  bytes[at + 1] = static_cast<std::uint8_t>(bits >> 8);
}

}  // namespace torsion::engine
