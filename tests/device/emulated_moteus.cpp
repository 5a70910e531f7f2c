// The firmware's and the adapter's side of a moteus.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tests/device/emulated_devices.hpp"

namespace torsion::engine::test {
namespace {

/// The other side of moteus' multiplex protocol, as can.md has it: registers in int8, int16, int32
/// or float, written (0x00 to 0x0C) and read (0x10 to 0x1C), answered with 0x20 to 0x2C.
struct MoteusFrame {
  Bytes bytes;
  bool good = true;
  std::map<std::uint32_t, double> written;
  Buffer reply;

  std::uint8_t byte() {
    good = good && !bytes.empty();
    const std::uint8_t value = good ? bytes.front() : std::uint8_t{0};
    bytes = bytes.subspan(good ? 1 : 0);
    return value;
  }
  std::uint32_t variable() {
    std::uint32_t value = 0;
    for (std::uint32_t shift = 0; shift < 28; shift += 7) {
      const std::uint8_t part = byte();
      value |= (part & 0x7FU) << shift;
      if ((part & 0x80U) == 0) {
        break;
      }
    }
    return value;
  }
  /// Of kind 0 to 3: int8, int16, int32, float.
  double number(std::uint32_t kind) {
    const std::array<std::size_t, 4> sizes = {1, 2, 4, 4};
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < sizes[kind]; ++i) {
      bits |= static_cast<std::uint32_t>(byte()) << (8 * i);
    }
    return kind == 3   ? static_cast<double>(std::bit_cast<float>(bits))
           : kind == 2 ? static_cast<std::int32_t>(bits)
           : kind == 1 ? static_cast<std::int16_t>(static_cast<std::uint16_t>(bits))
                       : static_cast<std::int8_t>(static_cast<std::uint8_t>(bits));
  }
  void put(std::uint32_t kind, double value) {
    auto bits = kind == 3 ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                          : static_cast<std::uint32_t>(static_cast<std::int32_t>(value));
    for (std::uint32_t i = 0; i < (kind >= 2 ? 4U : kind + 1U); ++i, bits >>= 8U) {
      reply.push_back(static_cast<std::uint8_t>(bits & 0xFFU));
    }
  }
};

double register_of(const EmulatedMoteus& device, std::uint32_t at) {
  switch (at) {
    case 0x000:
      return device.mode;
    case 0x001:
      return device.turns;
    case 0x003:
      return device.torque;
    case 0x00F:
      return device.fault;
    case 0x102:
      return device.register_map;
    default:
      return 0.0;
  }
}

void put_variable(Buffer& buffer, std::uint32_t value) {
  for (; value >= 0x80; value >>= 7U) {
    buffer.push_back(static_cast<std::uint8_t>(0x80U | (value & 0x7FU)));
  }
  buffer.push_back(static_cast<std::uint8_t>(value));
}

/// Registers that were written take effect together; in a fault or after its time was out it only
/// stops.
void command(EmulatedMoteus& device, const std::map<std::uint32_t, double>& written) {
  const auto said = [&](std::uint32_t at, double otherwise) {
    const auto found = written.find(at);
    return found != written.end() ? found->second : otherwise;
  };
  if (!written.contains(0x000)) {
    return;
  }
  const auto mode = static_cast<std::uint8_t>(said(0x000, 0.0));
  if (mode == 0) {
    device.mode = 0;
    device.fault = 0;
    device.torque = 0.0;
  } else if (mode == 10 && (device.mode == 0 || device.mode == 10)) {
    device.mode = 10;
    device.watchdog = said(0x027, 0.1);
    device.is_stiff = device.is_stiff || said(0x023, 1.0) != 0.0 || said(0x024, 1.0) != 0.0 ||
                      said(0x02B, 1.0) != 0.0 || !std::isnan(said(0x020, 0.0));
    const double most = said(0x025, 100.0);
    device.torque = std::clamp(said(0x022, 0.0), -most, most);
  }
}

/// @return what the controller answers; empty: it could not read that
Buffer frame_came(EmulatedMoteus& device, Bytes bytes) {
  MoteusFrame frame{bytes, true, {}, {}};
  std::vector<std::array<std::uint32_t, 3>> asked;  // kind, register, count
  while (frame.good && !frame.bytes.empty()) {
    const std::uint8_t what = frame.byte();
    if (what == 0x50) {
      continue;  // it fills a frame up
    }
    const std::uint32_t kind = what >> 2U & 3U;
    const std::uint32_t count = (what & 3U) != 0 ? what & 3U : frame.variable();
    const std::uint32_t first = frame.variable();
    if ((what & 0xF0U) == 0x10U) {
      asked.push_back({kind, first, count});
    } else if ((what & 0xF0U) == 0x00U) {
      for (std::uint32_t i = 0; i < count; ++i) {
        frame.written[first + i] = frame.number(kind);
      }
    } else {
      frame.good = false;
    }
  }
  if (!frame.good) {
    return {};
  }
  command(device, frame.written);
  for (const auto& [kind, first, count] : asked) {
    frame.reply.push_back(static_cast<std::uint8_t>(0x20U | kind << 2U | count));
    put_variable(frame.reply, first);
    for (std::uint32_t i = 0; i < count; ++i) {
      frame.put(kind, register_of(device, first + i));
    }
  }
  // A CAN FD frame has one of these lengths.
  for (const std::size_t length : {8U, 12U, 16U, 20U, 24U, 32U, 48U, 64U}) {
    if (frame.reply.size() <= length) {
      frame.reply.resize(length, 0x50);
      break;
    }
  }
  return frame.reply;
}

void obey(EmulatedMoteus& device, const std::string& line, std::string& answer) {
  const std::string send = "can send 8001 ";
  if (line == "can on") {
    answer += device.bus_is_on ? "ERR unexpected state\r\n" : "OK\r\n";
    device.bus_is_on = true;
    return;
  }
  Buffer bytes;
  bool good = device.bus_is_on && line.rfind(send, 0) == 0 && line.size() % 2 == 0;
  for (std::size_t at = send.size(); good && at < line.size(); at += 2) {
    std::size_t used = 0;
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(line.substr(at, 2), &used, 16)));
    good = used == 2;
  }
  const bool is_can_fd = bytes.size() <= 8 || bytes.size() == 12 || bytes.size() == 16 ||
                         bytes.size() == 20 || bytes.size() == 24 || bytes.size() == 32 ||
                         bytes.size() == 48 || bytes.size() == 64;
  const Buffer reply = good && is_can_fd ? frame_came(device, bytes) : Buffer{};
  if (reply.empty()) {
    device.errors += 1;
    answer += "ERR\r\n";
    return;
  }
  answer += "OK\r\nrcv 100 ";
  for (const std::uint8_t byte : reply) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    answer += kDigits[byte >> 4U];
    answer += kDigits[byte & 0xFU];
  }
  answer += " E B F\r\n";
}

}  // namespace

Buffer told(EmulatedMoteus& device, Bytes packet) {
  std::string answer;
  for (const std::uint8_t byte : packet) {
    if (byte == '\n') {
      obey(device, {device.line.begin(), device.line.end()}, answer);
      device.line.clear();
    } else {
      device.line.push_back(byte);
    }
  }
  return {answer.begin(), answer.end()};
}

}  // namespace torsion::engine::test
