#pragma once

// ODrive v3 as a knob: torque in N m out, turns in, by its lines of text.

#include <array>
#include <optional>
#include <string_view>

namespace torsion {

/// A line of text in place, without allocation.
struct OdriveLine {
  std::array<char, 64> text{};
  std::size_t size = 0;

  [[nodiscard]] std::string_view view() const { return {text.data(), size}; }
};

struct OdriveFeedback {
  double position = 0.0;  // turns
  double velocity = 0.0;  // turns/s
};

/// Torque [N m] to one axis, then a question for where it is: one transfer there and back. What is
/// not finite is sent as no torque, the rest within +-1000 N m. Feeds the axis's watchdog.
OdriveLine encode_odrive_step(int axis, double torque);

/// An answer to that question, with or without its line end.
/// @return nothing for anything but two finite numbers
std::optional<OdriveFeedback> decode_odrive_feedback(std::string_view line);

/// Puts lines together from what the transfers bring.
struct OdriveStream {
  OdriveLine line;
  bool too_long = false;  // skip to the next line end
};

/// @return the last feedback whose line ends in `bytes`, if any
std::optional<OdriveFeedback> take_odrive_bytes(OdriveStream& stream, std::string_view bytes);

}  // namespace torsion
