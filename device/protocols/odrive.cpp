#include "device/protocols/odrive.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace torsion {
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

}  // namespace

OdriveLine encode_odrive_step(int axis, double torque) {
  constexpr double kMost = 1000.0;  // N m: beyond any motor, and its digits fit in
  OdriveLine line;
  const auto written =
      fmt::format_to_n(line.text.data(), line.text.size(), "c {} {:.6f}\nf {}\n", axis,
                       std::isfinite(torque) ? std::clamp(torque, -kMost, kMost) : 0.0, axis);
  line.size = std::min(written.size, line.text.size());
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

std::optional<OdriveFeedback> take_odrive_bytes(OdriveStream& stream, std::string_view bytes) {
  std::optional<OdriveFeedback> last;
  for (const char byte : bytes) {
    if (byte == '\n') {
      const auto feedback =
          stream.too_long ? std::nullopt : decode_odrive_feedback(stream.line.view());
      last = feedback ? feedback : last;
      stream = OdriveStream{};
    } else if (stream.line.size < stream.line.text.size()) {
      stream.line.text[stream.line.size++] = byte;
    } else {
      stream.too_long = true;
    }
  }
  return last;
}

}  // namespace torsion
