#include "device/protocols/falcon.hpp"

#include <algorithm>

namespace torsion::engine {
namespace {

constexpr std::uint8_t kFirst = '<';
constexpr std::uint8_t kLast = '>';
constexpr std::uint8_t kZero = 'A';  // numbers are sent as 'A' + 4 bits, the lowest first
constexpr std::size_t kFlags = 13;

void put_nibbles(std::span<std::uint8_t> bytes, std::size_t at, std::int16_t value) {
  const auto bits = static_cast<std::uint16_t>(value);
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[at + i] = static_cast<std::uint8_t>(kZero + ((bits >> (4 * i)) & 0xFU));
  }
}

std::int16_t nibbles_at(Bytes bytes, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    bits |= std::uint32_t{static_cast<std::uint8_t>(bytes[at + i] - kZero)} << (4 * i);
  }
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
}

bool are_nibbles(Bytes bytes) {
  return std::ranges::all_of(bytes,
                             [](std::uint8_t byte) { return byte >= kZero && byte < kZero + 16; });
}

}  // namespace

std::array<std::uint8_t, kFalconPacket> encode_falcon(const FalconOutput& output) {
  std::array<std::uint8_t, kFalconPacket> packet{};
  packet.front() = kFirst;
  for (std::size_t motor = 0; motor < output.motors.size(); ++motor) {
    put_nibbles(
        packet, 1 + 4 * motor,
        std::clamp<std::int16_t>(output.motors[motor], -kFalconLargestMotor, kFalconLargestMotor));
  }
  packet[kFlags] =
      static_cast<std::uint8_t>(kZero + (output.homing ? 1 : 0) + (output.green ? 2 : 0) +
                                (output.blue ? 4 : 0) + (output.red ? 8 : 0));
  packet[14] = kZero;
  packet.back() = kLast;
  return packet;
}

std::optional<FalconInput> decode_falcon(Bytes packet) {
  if (packet.size() != kFalconPacket || packet.front() != kFirst || packet.back() != kLast ||
      !are_nibbles(packet.subspan(1, 12)) || packet[kFlags] < kZero) {
    return std::nullopt;
  }
  FalconInput input;
  for (std::size_t leg = 0; leg < input.encoders.size(); ++leg) {
    input.encoders[leg] = nibbles_at(packet, 1 + 4 * leg);
  }
  const auto flags = static_cast<std::uint8_t>(packet[kFlags] - kZero);
  input.buttons = flags & 0xFU;
  input.homed = flags >> 4 & 7U;
  return input;
}

std::optional<FalconInput> take_ftdi_packet(FalconStream& stream, Bytes usb_packet) {
  std::optional<FalconInput> last;
  for (const std::uint8_t byte : usb_packet.subspan(std::min(kFtdiStatus, usb_packet.size()))) {
    if (byte == kFirst) {
      stream.count = 0;
    } else if (stream.count == 0) {
      continue;  // between packets
    }
    stream.packet[stream.count++] = byte;
    if (stream.count == kFalconPacket) {
      const auto input = decode_falcon(stream.packet);
      last = input ? input : last;
      stream.count = 0;
    }
  }
  return last;
}

}  // namespace torsion::engine
