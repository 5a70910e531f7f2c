#pragma once

// Novint Falcon: three motors and three encoders behind an FTDI chip, one packet out for each
// packet in, about 1 kHz.

#include <array>
#include <cstdint>
#include <optional>

#include "device/protocols/bytes.hpp"

namespace torsion::engine {

inline constexpr std::size_t kFalconPacket = 16;
inline constexpr std::size_t kFtdiStatus = 2;  // bytes at the head of each packet of its USB bridge
inline constexpr std::int16_t kFalconLargestMotor = 4095;

struct FalconOutput {
  std::array<std::int16_t, 3> motors{};  // within +-kFalconLargestMotor; encode clamps
  bool homing = false;                   // asks for the encoders' zero
  bool red = false;
  bool green = false;
  bool blue = false;
};

struct FalconInput {
  std::array<std::int16_t, 3> encoders{};  // counts
  std::uint8_t buttons = 0;                // 1 plus, 2 forward, 4 centre, 8 minus
  std::uint8_t homed = 0;                  // one bit for each leg
};

std::array<std::uint8_t, kFalconPacket> encode_falcon(const FalconOutput& output);

/// @return nothing for anything but one whole packet
std::optional<FalconInput> decode_falcon(Bytes packet);

/// Finds packets in a stream of bytes, whatever is lost or put in between.
struct FalconStream {
  std::array<std::uint8_t, kFalconPacket> packet{};
  std::size_t count = 0;
};

/// Takes one USB packet of the FTDI chip (its two bytes of modem status first, at most 64 in all).
/// @return the last whole packet that it ended, if any
std::optional<FalconInput> take_ftdi_packet(FalconStream& stream, Bytes usb_packet);

}  // namespace torsion::engine
