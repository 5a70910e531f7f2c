#pragma once

// How a Falcon takes its firmware, which it forgets when it is switched off: as a talk of a few
// lines, then pieces of the file that it sends back as they are.

#include <array>
#include <cstdint>
#include <span>

#include "device/protocols/bytes.hpp"
#include "device/usb/usb_io.hpp"

namespace torsion::engine {

inline constexpr std::size_t kFirmwarePiece = 62;  // bytes that go out together
inline constexpr std::size_t kSmallestFirmware = 1024;
inline constexpr std::size_t kLargestFirmware = 65536;

/// Set-up of the FTDI chip for a list of phases, control transfers in their order.
std::span<const UsbSetup> falcon_normal_set_up();
std::span<const UsbSetup> falcon_loading_set_up();  // then kFalconGreeting
std::span<const UsbSetup> falcon_writing_set_up();  // then kFalconReady, then the pieces

/// Something to say and what is to come back.
struct FalconPhrase {
  std::array<std::uint8_t, 4> said{};
  std::size_t said_size = 0;
  std::array<std::uint8_t, 4> answer{};
  std::size_t answer_size = 0;
};
inline constexpr FalconPhrase kFalconGreeting{{0x0A, 0x43, 0x0D}, 3, {0x0A, 0x44, 0x2C, 0x0D}, 4};
inline constexpr FalconPhrase kFalconReady{{0x41}, 1, {0x41}, 1};

/// What came back, without the chip's status bytes.
struct FalconEcho {
  std::array<std::uint8_t, 2 * kFirmwarePiece> bytes{};
  std::size_t count = 0;
};

/// Adds one USB packet. What does not fit in pushes out what came first.
void take_echo(FalconEcho& echo, Bytes usb_packet);

/// True when what came ends with `expected`; there may be noise before it.
bool ends_with(const FalconEcho& echo, Bytes expected);

}  // namespace torsion::engine
