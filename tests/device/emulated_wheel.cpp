// The firmware's side of a force-feedback wheel, byte by byte: nothing here reads a descriptor.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/device/emulated_devices.hpp"
#include "tests/device/wheel_descriptors.hpp"

namespace torsion::engine::test {
namespace {

constexpr double kHeartbeat = 0.1;  // s: an OpenFFBoard reports as often though nothing changes
constexpr std::uint8_t kBlock = 3;  // of the effect that it makes

/// What is in the packets of either kind, once it is read.
struct Said {
  enum class What : std::uint8_t {
    kNothing,
    kEffect,
    kTorque,
    kStart,
    kStop,
    kEnable,
    kDisable,
    kReset,
    kGain
  };
  What what = What::kNothing;
  std::uint8_t block = kBlock;
  bool is_constant = true;
  double number = 0.0;     // duration, s; torque or gain, share
  double direction = 0.0;  // share of the torque that acts on X
};

std::uint32_t word(Bytes bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8U;
}

Said control_of(std::uint32_t bits) {
  // A bit each, as the firmware looks at them.
  return {(bits & 8U) != 0   ? Said::What::kReset
          : (bits & 2U) != 0 ? Said::What::kDisable
          : (bits & 1U) != 0 ? Said::What::kEnable
                             : Said::What::kNothing};
}

Said read_open_ffb(Bytes packet) {
  switch (packet[0]) {
    case 0x01: {  // block, type, duration, repeat, period, delay, gain, button, axes, direction
      if (packet.size() != 16) {
        return {};
      }
      constexpr std::uint8_t kDirectionEnable = 2;
      const double angle = 0.01 * std::numbers::pi / 180.0 * word(packet, 14);
      Said said{Said::What::kEffect, packet[1], packet[2] == 1, 1e-3 * word(packet, 3)};
      said.direction = packet[13] == kDirectionEnable && packet[11] == 255 ? std::sin(angle) : 0.0;
      return said;
    }
    case 0x05:
      return packet.size() != 4
                 ? Said{}
                 : Said{Said::What::kTorque, packet[1], true, int16_at(packet, 2) / 32767.0};
    case 0x0A:
      return packet.size() != 4 || (packet[2] == 1 && packet[3] == 0)
                 ? Said{}
                 : Said{packet[2] == 1   ? Said::What::kStart
                        : packet[2] == 3 ? Said::What::kStop
                                         : Said::What::kNothing,
                        packet[1]};
    case 0x0C:
      return packet.size() != 2 ? Said{} : control_of(packet[1]);
    case 0x0D:
      return packet.size() != 2 ? Said{} : Said{Said::What::kGain, kBlock, true, packet[1] / 255.0};
    default:
      return {};
  }
}

Said read_other(Bytes packet) {
  switch (packet[0]) {
    case 0x32:  // type, block, axes, duration
      return packet.size() != 6 ? Said{}
                                : Said{Said::What::kEffect, packet[2], packet[1] == 3,
                                       1e-2 * word(packet, 4), packet[3] == 1 ? 1.0 : 0.0};
    case 0x33:
      return packet.size() != 3 ? Said{}
                                : Said{Said::What::kTorque, packet[2], true,
                                       static_cast<std::int8_t>(packet[1]) / 127.0};
    case 0x34:
      return packet.size() != 3
                 ? Said{}
                 : Said{packet[1] == 1 ? Said::What::kStart : Said::What::kStop, packet[2]};
    case 0x35:
      return packet.size() != 2 ? Said{}
                                : Said{packet[1] == 1   ? Said::What::kDisable
                                       : packet[1] == 2 ? Said::What::kEnable
                                       : packet[1] == 3 ? Said::What::kReset
                                                        : Said::What::kNothing};
    default:
      return {};
  }
}

void obey(EmulatedWheel& device, const Said& said) {
  const bool known = device.created && said.block == kBlock;
  switch (said.what) {
    case Said::What::kEffect:
      device.errors += known && said.is_constant && said.number > 0.0 ? 0U : 1U;
      device.duration = said.number;
      device.direction = said.direction;
      break;
    case Said::What::kTorque:
      device.errors += known ? 0U : 1U;
      device.share = known ? said.number : device.share;
      break;
    case Said::What::kStart:
      device.errors += known && device.duration > 0.0 ? 0U : 1U;
      device.plays = known;
      device.started_at = device.now;
      break;
    case Said::What::kStop:
      device.plays = false;
      break;
    case Said::What::kEnable:
      device.enabled = true;
      break;
    case Said::What::kDisable:
      device.enabled = false;
      break;
    case Said::What::kReset:
      forget_effects(device);
      break;
    case Said::What::kGain:
      device.gain = said.number;
      break;
    case Said::What::kNothing:
      device.errors += 1;
      break;
  }
}

std::int32_t count_of(const EmulatedWheel& device) {
  const double share = std::clamp(device.turn / (0.5 * device.range), -1.0, 1.0);
  return static_cast<std::int32_t>(
      std::lround(device.is_other ? 32767.5 * (share + 1.0) : 32767.0 * share));
}

Buffer place_report(const EmulatedWheel& device, std::int32_t count) {
  Buffer report(device.is_other ? 6 : 25);
  report[0] = device.is_other ? 0x31 : 0x01;
  report[1] = device.buttons;
  put_int16(report, device.is_other ? 4 : 9,
            static_cast<std::int16_t>(static_cast<std::uint16_t>(count)));
  return report;
}

/// What it has to say now: of its place when it turned, of its state when that changed.
Buffer report_of(EmulatedWheel& device) {
  const bool changed =
      device.enabled != device.said_enabled || device.powered != device.said_powered;
  if (changed && !device.is_other) {
    device.said_enabled = device.enabled;
    device.said_powered = device.powered;
    const auto bits = (device.enabled ? 2U : 0U) | (device.powered ? 16U : 0U);
    return {0x02, static_cast<std::uint8_t>(bits), 0};
  }
  const std::int32_t count = count_of(device);
  if (count == device.said_count && device.now - device.said_at < kHeartbeat) {
    return {};
  }
  return place_of(device);
}

}  // namespace

void forget_effects(EmulatedWheel& device) {
  device.enabled = false;
  device.created = false;
  device.plays = false;
  device.duration = 0.0;
  device.share = 0.0;
}

Buffer place_of(EmulatedWheel& device) {
  device.said_count = count_of(device);
  device.said_at = device.now;
  return place_report(device, device.said_count);
}

double torque_of(const EmulatedWheel& device) {
  const bool in_time = device.plays_for_ever || device.now - device.started_at < device.duration;
  const bool plays = device.plays && in_time;
  const bool obeys = device.enabled && device.powered;
  const double gain = device.is_other ? 1.0 : device.gain;
  return plays && obeys ? device.full_scale * gain * device.share * device.direction : 0.0;
}

Buffer told(EmulatedWheel& device, Bytes packet) {
  if (packet.empty()) {
    return {};
  }
  obey(device, device.is_other ? read_other(packet) : read_open_ffb(packet));
  return report_of(device);
}

std::optional<Buffer> controlled(EmulatedWheel& device, const UsbSetup& setup, Bytes data) {
  constexpr std::uint16_t kFeature = 0x0300;
  const std::uint8_t create = device.is_other ? 0x36 : 0x11;
  const std::uint8_t load = device.is_other ? 0x37 : 0x12;
  const std::uint8_t constant = device.is_other ? 3 : 1;
  if (setup.request == 6 && setup.type == 0x81 && setup.value == 0x2200) {
    Buffer all = device.is_other
                     ? Buffer(kOtherWheelDescriptor.begin(), kOtherWheelDescriptor.end())
                     : Buffer(kOpenFfbDescriptor.begin(), kOpenFfbDescriptor.end());
    all.resize(std::min<std::size_t>(all.size(), setup.length));
    return all;
  }
  if (setup.request == 9 && setup.type == 0x21 && setup.value == (kFeature | create)) {
    const std::size_t size = device.is_other ? 2 : 4;
    const bool good = data.size() == size && data[0] == create && data[1] == constant;
    device.created = device.created || good;
    return good ? std::optional(Buffer{}) : std::nullopt;
  }
  if (setup.request == 1 && setup.type == 0xA1 && setup.value == (kFeature | load)) {
    const std::uint8_t status = device.created ? constant : 2;  // success, or full
    device.pings += 1;
    return device.is_other ? Buffer{load, status, kBlock}
                           : Buffer{load, kBlock, status, 0xFF, 0xFF};
  }
  constexpr std::uint16_t kInput = 0x0100;
  if (device.is_other && setup.request == 1 && setup.value == (kInput | 0x31)) {
    return place_of(device);
  }
  return std::nullopt;  // a report of its place: an OpenFFBoard stalls
}

}  // namespace torsion::engine::test
