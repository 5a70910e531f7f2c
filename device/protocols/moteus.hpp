#pragma once

// A moteus controller behind an fdcanusb adapter as a knob: torque in N m out, turns in. The
// adapter speaks lines of text, "can send 8001 ..." and "rcv 100 ...", with a CAN FD frame in
// hexadecimal: its registers, written and asked for in pieces of one kind of number each. Sources:
// mjbots' documents of moteus (protocol/can.md, protocol/registers.md) and of the fdcanusb.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace torsion::engine {

/// A line of text in place, without allocation.
struct MoteusLine {
  std::array<char, 128> text{};
  std::size_t size = 0;

  [[nodiscard]] std::string_view view() const { return {text.data(), size}; }
};

/// Of register 0x000.
enum class MoteusMode : std::uint8_t {
  kStopped = 0,
  kFault = 1,
  kPosition = 10,
  kTimeout = 11,  // it was not spoken to in time; until it is stopped
};

/// What it says of itself after each frame.
struct MoteusReply {
  std::uint8_t mode = 0;
  std::uint8_t fault = 0;  // why it is in kFault
  double position = 0.0;   // turns
  double velocity = 0.0;   // turns/s
};

/// The map of registers that this file is written by: register 0x102.
inline constexpr std::uint32_t kMoteusRegisterMap = 5;

/// Turns the adapter's bus on, and asks which map of registers the controller has.
inline constexpr std::string_view kMoteusOpening = "can on\ncan send 8001 198202\n";

/// Torque [N m] and nothing else: position control without stiffness and damping. What is not
/// finite is sent as no torque.
/// @param largest   N m: that the controller allows itself
/// @param watchdog  s: it stops when nothing comes for as long
MoteusLine encode_moteus_step(double torque, double largest, double watchdog);

/// Stops the motor, which ends a fault and a time-out, too.
MoteusLine encode_moteus_stop();

/// What a frame that came back says. @return nothing for one that is cut off or has no mode
std::optional<MoteusReply> decode_moteus_reply(std::string_view line);

/// The answer to kMoteusOpening. @return nothing for any other line
std::optional<std::uint32_t> decode_moteus_register_map(std::string_view line);

/// Puts lines together from what the transfers bring.
struct MoteusStream {
  std::array<char, 192> text{};
  std::size_t size = 0;
  bool too_long = false;  // skip to the next line end
};

/// @param take_line  called with each whole line, without its end
template <class F>
void take_moteus_bytes(MoteusStream& stream, std::string_view bytes, F&& take_line) {
  for (const char byte : bytes) {
    if (byte == '\n' || byte == '\r') {
      if (stream.size > 0 && !stream.too_long) {
        take_line(std::string_view(stream.text.data(), stream.size));
      }
      stream.size = 0;
      stream.too_long = false;
    } else if (stream.size < stream.text.size()) {
      stream.text[stream.size++] = byte;
    } else {
      stream.too_long = true;
    }
  }
}

/// In place of a fault: nothing came for too long.
inline constexpr std::uint32_t kMoteusUnfed = 0x100;

/// The name of a fault and what to do about it.
std::string moteus_fault_text(std::uint32_t fault);

}  // namespace torsion::engine
