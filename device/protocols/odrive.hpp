#pragma once

// ODrive v3 as a knob: torque in N m out, turns in, by its lines of text.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace torsion::engine {

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

/// What an axis says of itself.
struct OdriveStatus {
  std::uint32_t errors = 0;  // bits of axis.error
  std::uint32_t state = 0;   // axis.current_state
};
inline constexpr std::uint32_t kOdriveClosedLoop = 8;    // of those states: the motor obeys
inline constexpr std::uint32_t kOdriveWatchdog = 0x800;  // of those errors: it was not fed in time

/// Torque [N m] to one axis, then a question for where it is: one transfer there and back. What is
/// not finite is sent as no torque, the rest within +-1000 N m. Feeds the axis's watchdog.
/// @param asks_status  asks for errors and state, too
OdriveLine encode_odrive_step(int axis, double torque, bool asks_status = false);

/// An answer to that question, with or without its line end.
/// @return nothing for anything but two finite numbers
std::optional<OdriveFeedback> decode_odrive_feedback(std::string_view line);

struct OdriveVersion {
  std::uint32_t major = 0;
  std::uint32_t minor = 0;
  std::uint32_t revision = 0;
};

/// Asks for it, a line each.
inline constexpr std::string_view kOdriveVersionQuestion =
    "r fw_version_major\nr fw_version_minor\nr fw_version_revision\n";

/// Whether these lines mean there what they mean here: 0.5 from its revision 4 on. Older ones do
/// not read all properties, 0.6 has other names for some.
bool is_understood(const OdriveVersion& version);

/// Puts lines together from what the transfers bring. A status is two lines with a number each,
/// errors and state, after a feedback.
struct OdriveStream {
  OdriveLine line;
  bool too_long = false;      // skip to the next line end
  std::uint32_t numbers = 0;  // lines with one number since the last feedback
  OdriveStatus coming;
  std::optional<OdriveStatus> status;  // the last whole one; whoever reads it takes it away
  std::array<std::uint32_t, 3> version{};
  std::size_t version_lines = 0;
};

/// The answers to kOdriveVersionQuestion.
/// @return nothing before the last of them has come; zeros where one is no number
std::optional<OdriveVersion> take_odrive_version(OdriveStream& stream, std::string_view bytes);

/// @return the last feedback whose line ends in `bytes`, if any
std::optional<OdriveFeedback> take_odrive_bytes(OdriveStream& stream, std::string_view bytes);

/// The names of an axis's errors, as its maker's tools write them, and what to do about the first.
std::string odrive_error_text(std::uint32_t errors);

}  // namespace torsion::engine
