#include "device/protocols/odrive.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include <fmt/format.h>

namespace torsion::engine {
namespace {

std::optional<double> take_number(std::string_view& text) {
  const std::size_t start = text.find_first_not_of(' ');
  if (start == std::string_view::npos) {
    return std::nullopt;
  }
  text.remove_prefix(start);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) {
    return std::nullopt;
  }
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::optional<std::uint32_t> decode_number(std::string_view line) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  const bool whole = line.find_first_not_of(" \r\n") == std::string_view::npos;
  return error == std::errc() && whole ? std::optional(value) : std::nullopt;
}

struct AxisError {
  std::uint32_t bit;
  const char* name;
  const char* cure;
};

constexpr const char* kItsTool = "odrivetool says more: dump_errors(odrv0)";
constexpr const char* kCalibrate = "calibrate motor and encoder with odrivetool";
constexpr const char* kSupply = "check its power supply";
constexpr const char* kEnds = "turn it away from its end stop";
// Of firmware 0.5: its API reference, ODrive.Axis.Error, and what came before 0.5.2.
constexpr std::array kAxisErrors = {
    AxisError{0x1, "INVALID_STATE", kCalibrate},
    AxisError{0x2, "DC_BUS_UNDER_VOLTAGE", kSupply},
    AxisError{0x4, "DC_BUS_OVER_VOLTAGE", kSupply},
    AxisError{0x8, "CURRENT_MEASUREMENT_TIMEOUT", kItsTool},
    AxisError{0x10, "BRAKE_RESISTOR_DISARMED", "check its brake resistor"},
    AxisError{0x20, "MOTOR_DISARMED", kItsTool},
    AxisError{0x40, "MOTOR_FAILED", kItsTool},
    AxisError{0x80, "SENSORLESS_ESTIMATOR_FAILED", kItsTool},
    AxisError{0x100, "ENCODER_FAILED", "check its encoder's cable"},
    AxisError{0x200, "CONTROLLER_FAILED", kItsTool},
    AxisError{kOdriveWatchdog, "WATCHDOG_TIMER_EXPIRED", "it heard nothing for 50 ms"},
    AxisError{0x1000, "MIN_ENDSTOP_PRESSED", kEnds},
    AxisError{0x2000, "MAX_ENDSTOP_PRESSED", kEnds},
    AxisError{0x4000, "ESTOP_REQUESTED", "release its emergency stop"},
    AxisError{0x20000, "HOMING_WITHOUT_ENDSTOP", kItsTool},
    AxisError{0x40000, "OVER_TEMP", "let it cool down"},
    AxisError{0x80000, "UNKNOWN_POSITION", kCalibrate}};
// Of firmware 0.6: its API reference, ODrive.Error.
constexpr std::array kErrors6 = {
    AxisError{0x1, "INITIALIZING", kItsTool},
    AxisError{0x2, "SYSTEM_LEVEL", kItsTool},
    AxisError{0x4, "TIMING_ERROR", kItsTool},
    AxisError{0x8, "MISSING_ESTIMATE", kCalibrate},
    AxisError{0x10, "BAD_CONFIG", kCalibrate},
    AxisError{0x20, "DRV_FAULT", kItsTool},
    AxisError{0x40, "MISSING_INPUT", kItsTool},
    AxisError{0x100, "DC_BUS_OVER_VOLTAGE", kSupply},
    AxisError{0x200, "DC_BUS_UNDER_VOLTAGE", kSupply},
    AxisError{0x400, "DC_BUS_OVER_CURRENT", kSupply},
    AxisError{0x800, "DC_BUS_OVER_REGEN_CURRENT", "check its brake resistor"},
    AxisError{0x1000, "CURRENT_LIMIT_VIOLATION", kItsTool},
    AxisError{0x2000, "MOTOR_OVER_TEMP", "let it cool down"},
    AxisError{0x4000, "INVERTER_OVER_TEMP", "let it cool down"},
    AxisError{0x8000, "VELOCITY_LIMIT_VIOLATION", "turn it more slowly"},
    AxisError{0x10000, "POSITION_LIMIT_VIOLATION", kEnds},
    AxisError{kOdrive6Watchdog, "WATCHDOG_TIMER_EXPIRED", "it heard nothing for 50 ms"},
    AxisError{0x2000000, "ESTOP_REQUESTED", "release its emergency stop"},
    AxisError{0x4000000, "SPINOUT_DETECTED", "check its encoder"},
    AxisError{0x8000000, "BRAKE_RESISTOR_DISARMED", "check its brake resistor"},
    AxisError{0x10000000, "THERMISTOR_DISCONNECTED", "check its thermistor's cable"},
    AxisError{0x40000000, "CALIBRATION_ERROR", kCalibrate}};

}  // namespace

OdriveLine encode_odrive_step(int axis, double torque, OdriveQuestion question) {
  constexpr double kMost = 1000.0;  // N m: beyond any motor, and its digits fit in
  OdriveLine line;
  const auto add = [&line](auto... words) {
    const auto written =
        fmt::format_to_n(line.text.data() + line.size, line.text.size() - line.size, words...);
    line.size = std::min(line.size + written.size, line.text.size());
  };
  add(FMT_STRING("c {} {:.6f}\n"), axis,
      std::isfinite(torque) ? std::clamp(torque, -kMost, kMost) : 0.0);
  switch (question) {
    case OdriveQuestion::kPlace:
      add(FMT_STRING("f {}\n"), axis);
      break;
    case OdriveQuestion::kPlaceAndStatus:
      add(FMT_STRING("f {0}\nr axis{0}.error\nr axis{0}.current_state\n"), axis);
      break;
    case OdriveQuestion::kState:
      add(FMT_STRING("r axis{}.current_state\n"), axis);
      break;
    case OdriveQuestion::kReason:
      add(FMT_STRING("r axis{}.disarm_reason\n"), axis);
      break;
  }
  return line;
}

std::optional<OdriveFeedback> decode_odrive_feedback(std::string_view line) {
  const auto position = take_number(line);
  const auto velocity = position ? take_number(line) : std::nullopt;
  if (!velocity || line.find_first_not_of(" \r\n") != std::string_view::npos) {
    return std::nullopt;
  }
  return OdriveFeedback{*position, *velocity};
}

namespace {

/// A whole line: feedback, or a number of a status.
std::optional<OdriveFeedback> take_line(OdriveStream& stream) {
  const auto feedback = decode_odrive_feedback(stream.line.view());
  const auto number = feedback ? std::nullopt : decode_number(stream.line.view());
  if (feedback) {
    stream.numbers = 0;
  } else if (number) {
    stream.number = *number;
    stream.numbers += 1;
    if (stream.numbers == 1) {
      stream.coming.errors = *number;
    } else if (stream.numbers == 2) {
      stream.coming.state = *number;
      stream.status = stream.coming;
    }
  }
  return feedback;
}

}  // namespace

std::optional<OdriveFeedback> take_odrive_bytes(OdriveStream& stream, std::string_view bytes) {
  std::optional<OdriveFeedback> last;
  for (const char byte : bytes) {
    if (byte == '\n') {
      const auto feedback = stream.too_long ? std::nullopt : take_line(stream);
      last = feedback ? feedback : last;
      stream.line.size = 0;
      stream.too_long = false;
    } else if (stream.line.size < stream.line.text.size()) {
      stream.line.text[stream.line.size++] = byte;
    } else {
      stream.too_long = true;
    }
  }
  return last;
}

std::optional<MotorKind> language_of(const OdriveVersion& version) {
  if (version.major == 0 && version.minor == 5 && version.revision >= 4) {
    return MotorKind::kOdrive5;
  }
  return version.major == 0 && version.minor == 6 ? std::optional(MotorKind::kOdrive6)
                                                  : std::nullopt;
}

std::optional<OdriveVersion> take_odrive_version(OdriveStream& stream, std::string_view bytes) {
  for (const char byte : bytes) {
    if (byte != '\n') {
      if (stream.line.size < stream.line.text.size()) {
        stream.line.text[stream.line.size++] = byte;
      }
      continue;
    }
    const auto number = decode_number(stream.line.view());
    stream.line.size = 0;
    if (!number) {
      return OdriveVersion{};
    }
    stream.version[stream.version_lines++] = *number;
    if (stream.version_lines == stream.version.size()) {
      return OdriveVersion{stream.version[0], stream.version[1], stream.version[2]};
    }
  }
  return std::nullopt;
}

std::string odrive_error_text(MotorKind language, std::uint32_t errors) {
  std::string names;
  const char* cure = kItsTool;
  const bool older = language == MotorKind::kOdrive5;
  for (const AxisError& error :
       older ? std::span<const AxisError>(kAxisErrors) : std::span<const AxisError>(kErrors6)) {
    if ((errors & error.bit) != 0) {
      cure = names.empty() ? error.cure : cure;
      names += (names.empty() ? "" : ", ") + std::string(error.name);
      errors &= ~error.bit;
    }
  }
  if (errors != 0) {
    names += fmt::format("{}error {:#x}", names.empty() ? "" : ", ", errors);
  }
  return fmt::format("{}; {}", names.empty() ? "it left closed loop control" : names, cure);
}

}  // namespace torsion::engine
