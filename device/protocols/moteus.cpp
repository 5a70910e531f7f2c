#include "device/protocols/moteus.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

namespace torsion::engine {
namespace {

// Pieces of a frame: what is done with how many registers of which kind; three at most in the low
// bits, more in a byte of its own.
constexpr std::uint8_t kWriteInt8 = 0x00;
constexpr std::uint8_t kWriteFloat = 0x0C;
constexpr std::uint8_t kReadInt8 = 0x10;
constexpr std::uint8_t kReadFloat = 0x1C;
constexpr std::uint8_t kReplyInt8 = 0x20;
constexpr std::uint8_t kReplyInt32 = 0x28;
constexpr std::uint8_t kReplyFloat = 0x2C;
constexpr std::uint8_t kNothing = 0x50;  // fills a frame up
constexpr std::uint32_t kRegisterMap = 0x102;

/// A frame that grows, in hexadecimal, behind the adapter's word.
struct FrameWriter {
  MoteusLine line;

  static constexpr std::string_view kSend = "can send 8001 ";  // from 0 to 1, to be answered

  FrameWriter() {
    std::ranges::copy(kSend, line.text.begin());
    line.size = kSend.size();
  }
  void byte(std::uint8_t value) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    line.text[line.size++] = kDigits[value >> 4U];
    line.text[line.size++] = kDigits[value & 0xFU];
  }
  void number(double value) {
    auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    for (int i = 0; i < 4; ++i, bits >>= 8U) {
      byte(static_cast<std::uint8_t>(bits & 0xFFU));
    }
  }
  void numbers(std::uint8_t first_register, std::span<const double> values) {
    const auto count = static_cast<std::uint8_t>(values.size());
    if (count <= 3) {
      byte(kWriteFloat | count);
    } else {
      byte(kWriteFloat);
      byte(count);
    }
    byte(first_register);
    std::ranges::for_each(values, [this](double value) { number(value); });
  }
  void mode(MoteusMode mode) {
    byte(kWriteInt8 | 1U);
    byte(0x00);
    byte(static_cast<std::uint8_t>(mode));
  }
  /// Mode, position and velocity, fault.
  void ask() {
    for (const int value : {kReadInt8 | 1, 0x00, kReadFloat | 2, 0x01, kReadInt8 | 1, 0x0F}) {
      byte(static_cast<std::uint8_t>(value));
    }
  }
  /// Filled up to a length that CAN FD has.
  MoteusLine finish() {
    constexpr std::array<std::size_t, 7> kLengths = {8, 12, 16, 20, 24, 32, 48};
    const std::size_t length = (line.size - kSend.size()) / 2;
    for (std::size_t i = length; i < *std::ranges::lower_bound(kLengths, length); ++i) {
      byte(kNothing);
    }
    line.text[line.size++] = '\n';
    return line;
  }
};

/// The bytes of a received frame's line, "rcv 100 20...", read one after the other.
struct FrameReader {
  std::string_view digits;
  bool good = true;

  static int digit(char character) {
    if (character >= '0' && character <= '9') {
      return character - '0';
    }
    const char lower = static_cast<char>(character | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
  }
  std::uint8_t byte() {
    const int high = digits.size() >= 2 ? digit(digits[0]) : -1;
    const int low = digits.size() >= 2 ? digit(digits[1]) : -1;
    good = good && high >= 0 && low >= 0;
    digits.remove_prefix(std::min<std::size_t>(digits.size(), 2));
    return good ? static_cast<std::uint8_t>(16 * high + low) : std::uint8_t{0};
  }
  /// Seven bits a byte, the lowest first.
  std::uint32_t variable() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 28; shift += 7) {
      const std::uint8_t part = byte();
      value |= static_cast<std::uint32_t>(part & 0x7FU) << shift;
      if ((part & 0x80U) == 0) {
        return value;
      }
    }
    good = false;
    return 0;
  }
  std::uint32_t word() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 32; shift += 8) {
      value |= static_cast<std::uint32_t>(byte()) << shift;
    }
    return value;
  }
};

/// Calls take(kind, register, bits) for each register of a received frame.
/// @return false for what is no whole frame
template <class F>
bool read_frame(std::string_view line, F&& take) {
  constexpr std::string_view kReceived = "rcv ";
  if (!line.starts_with(kReceived)) {
    return false;
  }
  line.remove_prefix(kReceived.size());
  const std::size_t id_end = line.find(' ');
  if (id_end == std::string_view::npos) {
    return false;
  }
  line.remove_prefix(id_end + 1);
  FrameReader reader{line.substr(0, line.find(' '))};
  while (reader.good && !reader.digits.empty()) {
    const std::uint8_t what = reader.byte();
    const auto kind = static_cast<std::uint8_t>(what & 0xFCU);
    if (what == kNothing) {
      continue;
    }
    if (kind != kReplyInt8 && kind != kReplyInt32 && kind != kReplyFloat) {
      return false;  // an error that the controller answers, or a kind that was not asked for
    }
    const std::uint32_t count = (what & 3U) != 0 ? what & 3U : reader.variable();
    const std::uint32_t first = reader.variable();
    for (std::uint32_t i = 0; i < count && reader.good; ++i) {
      const std::uint32_t bits = kind == kReplyInt8 ? reader.byte() : reader.word();
      if (reader.good) {
        take(kind, first + i, bits);
      }
    }
  }
  return reader.good;
}

struct MoteusFault {
  std::uint32_t number;
  const char* name;
  const char* cure;
};

constexpr const char* kCalibrateMoteus = "calibrate it: python3 -m moteus.moteus_tool --calibrate";
constexpr const char* kSupplyOfMoteus = "check its power supply";
constexpr std::array kMoteusFaults = {
    MoteusFault{32, "calibration fault", kCalibrateMoteus},
    MoteusFault{33, "motor driver fault", "check its motor's cables"},
    MoteusFault{34, "over voltage", kSupplyOfMoteus},
    MoteusFault{35, "encoder fault", "check its encoder"},
    MoteusFault{36, "motor not configured", kCalibrateMoteus},
    MoteusFault{37, "PWM cycle overrun", "tview says more"},
    MoteusFault{38, "over temperature", "let it cool down"},
    MoteusFault{39, "outside limit", "turn it back within its limits"},
    MoteusFault{40, "under voltage", kSupplyOfMoteus},
    MoteusFault{41, "configuration changed", "begin again"},
    MoteusFault{42, "no valid theta", kCalibrateMoteus},
    MoteusFault{43, "no valid position", kCalibrateMoteus},
    MoteusFault{44, "driver enable fault", "tview says more"},
    MoteusFault{46, "timing violation", "tview says more"}};

}  // namespace

MoteusLine encode_moteus_step(double torque, double largest, double watchdog) {
  const double wanted = std::isfinite(torque) ? std::clamp(torque, -largest, largest) : 0.0;
  FrameWriter frame;
  frame.mode(MoteusMode::kPosition);
  // No position to go to, no velocity, the torque; stiffness and damping scaled to nothing.
  const double none = std::numeric_limits<double>::quiet_NaN();
  frame.numbers(0x20, std::array{none, 0.0, wanted, 0.0, 0.0, largest});
  frame.numbers(0x27, std::array{watchdog});
  frame.numbers(0x2B, std::array{0.0});
  frame.ask();
  return frame.finish();
}

MoteusLine encode_moteus_stop() {
  FrameWriter frame;
  frame.mode(MoteusMode::kStopped);
  frame.ask();
  return frame.finish();
}

std::optional<MoteusReply> decode_moteus_reply(std::string_view line) {
  MoteusReply reply;
  bool has_mode = false;
  bool has_place = false;
  const bool whole = read_frame(line, [&](std::uint8_t kind, std::uint32_t at, std::uint32_t bits) {
    const auto value = static_cast<double>(std::bit_cast<float>(bits));
    if (kind == kReplyInt8 && at == 0x00) {
      reply.mode = static_cast<std::uint8_t>(bits);
      has_mode = true;
    } else if (kind == kReplyInt8 && at == 0x0F) {
      reply.fault = static_cast<std::uint8_t>(bits);
    } else if (kind == kReplyFloat && at == 0x01) {
      reply.position = value;
      has_place = std::isfinite(value);
    } else if (kind == kReplyFloat && at == 0x02) {
      reply.velocity = value;
    }
  });
  return whole && has_mode && has_place ? std::optional(reply) : std::nullopt;
}

std::optional<std::uint32_t> decode_moteus_register_map(std::string_view line) {
  std::optional<std::uint32_t> map;
  const bool whole = read_frame(line, [&](std::uint8_t kind, std::uint32_t at, std::uint32_t bits) {
    if (kind == kReplyInt32 && at == kRegisterMap) {
      map = bits;
    }
  });
  return whole ? map : std::nullopt;
}

std::string moteus_fault_text(std::uint32_t fault) {
  const auto* const found = std::ranges::find(kMoteusFaults, fault, &MoteusFault::number);
  return found != kMoteusFaults.end() ? fmt::format("{}; {}", found->name, found->cure)
         : fault == kMoteusUnfed      ? std::string("it heard nothing for 50 ms")
         : fault != 0                 ? fmt::format("fault {}; tview says more", fault)
                                      : "it left its control; tview says more";
}

}  // namespace torsion::engine
