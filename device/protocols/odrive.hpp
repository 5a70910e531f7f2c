#pragma once

// ODrive as a knob: torque in N m out, turns in, by its lines of text. Two languages: that of
// firmware 0.5 (v3) and that of 0.6 (Pro, S1, Micro), which has other names for errors and answers
// only one question at a time.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ecs/device_sample.hpp"

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
inline constexpr std::uint32_t kOdriveClosedLoop = 8;  // of those states: the motor obeys
// Of those errors: it was not fed in time.
inline constexpr std::uint32_t kOdriveWatchdog = 0x800;
inline constexpr std::uint32_t kOdrive6Watchdog = 0x1000000;

/// What a step asks for besides the place, or in its stead.
enum class OdriveQuestion : std::uint8_t {
  kPlace,
  kPlaceAndStatus,  // of 0.5
  kState,           // of 0.6, in place of the place
  kReason,          // of 0.6, likewise: the errors for which it disarmed
};

/// Torque [N m] to one axis, then a question for where it is: one transfer there and back. What is
/// not finite is sent as no torque, the rest within +-1000 N m. Feeds the axis's watchdog.
OdriveLine encode_odrive_step(int axis, double torque,
                              OdriveQuestion question = OdriveQuestion::kPlace);

/// An answer to that question, with or without its line end.
/// @return nothing for anything but two finite numbers
std::optional<OdriveFeedback> decode_odrive_feedback(std::string_view line);

struct OdriveVersion {
  std::uint32_t major = 0;
  std::uint32_t minor = 0;
  std::uint32_t revision = 0;
};

/// Ask for it, one after the other's answer: 0.6 leaves out what is asked before that is on its
/// way.
inline constexpr std::array<std::string_view, 3> kOdriveVersionQuestions = {
    "r fw_version_major\n", "r fw_version_minor\n", "r fw_version_revision\n"};

/// The language that a firmware speaks: 0.5 from its revision 4 on, as older ones do not read all
/// properties, and 0.6.
std::optional<MotorKind> language_of(const OdriveVersion& version);

/// Puts lines together from what the transfers bring. A status is two lines with a number each,
/// errors and state, after a feedback.
struct OdriveStream {
  OdriveLine line;
  bool too_long = false;      // skip to the next line end
  std::uint32_t numbers = 0;  // lines with one number since the last feedback
  OdriveStatus coming;
  std::optional<OdriveStatus> status;   // the last whole one; whoever reads it takes it away
  std::optional<std::uint32_t> number;  // the last line with one number, likewise
  std::array<std::uint32_t, 3> version{};
  std::size_t version_lines = 0;
};

/// The answers to kOdriveVersionQuestions, of which stream.version_lines have come.
/// @return nothing before the last of them has come; zeros where one is no number
std::optional<OdriveVersion> take_odrive_version(OdriveStream& stream, std::string_view bytes);

/// @return the last feedback whose line ends in `bytes`, if any
std::optional<OdriveFeedback> take_odrive_bytes(OdriveStream& stream, std::string_view bytes);

/// Whether all that happened is that it was not fed in time.
inline bool only_unfed(MotorKind language, std::uint32_t errors) {
  return errors == (language == MotorKind::kOdrive5 ? kOdriveWatchdog : kOdrive6Watchdog);
}

/// The names of an axis's errors, as its maker's tools write them, and what to do about the first.
std::string odrive_error_text(MotorKind language, std::uint32_t errors);

}  // namespace torsion::engine
