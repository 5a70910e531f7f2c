#include "tests/device/emulated_devices.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/device/space_mouse_descriptor.hpp"

namespace torsion::engine::test {
namespace {

constexpr std::uint32_t kFalconBaud = 0x2;       // 1.5 Mbaud, as firmware speaks
constexpr std::uint32_t kGreetingBaud = 0x4138;  // 9600
constexpr std::uint32_t kLoadingBaud = 0x15;     // 140000

void put_nibbles(Buffer& packet, std::int16_t value) {
  const auto bits = static_cast<std::uint16_t>(value);
  for (int i = 0; i < 4; ++i) {
    packet.push_back(static_cast<std::uint8_t>('A' + (bits >> (4 * i) & 0xF)));
  }
}

std::int16_t nibbles_at(Bytes packet, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    bits |= static_cast<std::uint32_t>(packet[at + i] - 'A') << (4 * i);
  }
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
}

void append(Buffer& buffer, Bytes bytes) {
  for (const std::uint8_t byte : bytes) {
    buffer.push_back(byte);
  }
}

/// With the two bytes of the FTDI chip's status in front.
Buffer ftdi(const Buffer& bytes) {
  Buffer packet = {0x01, 0x60};
  append(packet, bytes);
  return packet;
}

Buffer told(EmulatedSpaceMouse& /*device*/, Bytes /*packet*/) {
  return {};
}

/// Counts of an encoder for a joint angle [rad]: 0.03643 degrees each from 35 degrees.
std::int16_t counts_of(double angle) {
  const double degree = std::numbers::pi / 180.0;
  const double per_count =
      (std::numbers::pi * 0.01425 / (4.0 * 320.0)) / (std::numbers::pi * 0.110 / 360.0);
  return static_cast<std::int16_t>(std::lround((angle / degree - 35.0) / per_count));
}

Buffer load(EmulatedFalcon& device, Bytes packet) {
  if (device.baud == kGreetingBaud && packet.size() == 3 && packet[1] == 0x43) {
    device.is_ready = false;
    device.firmware.clear();
    return ftdi({0x00, 0x0A, 0x44, 0x2C, 0x0D});
  }
  if (device.baud != kLoadingBaud) {
    return {};
  }
  if (!device.is_ready && packet.size() == 1 && packet[0] == 0x41) {
    device.is_ready = true;
    if (device.loses_ready > 0) {
      device.loses_ready -= 1;
      return {};
    }
    return ftdi({0x41});
  }
  append(device.firmware, packet);
  device.has_firmware = device.firmware.size() >= device.firmware_size;
  Buffer echo(packet.begin(), packet.end());
  if (device.echoes_wrongly) {
    echo.back() ^= 1U;
  }
  return ftdi(echo);
}

Buffer told(EmulatedFalcon& device, Bytes packet) {
  if (!device.has_firmware || device.baud == kLoadingBaud) {
    return load(device, packet);
  }
  if (device.baud != kFalconBaud || packet.size() != kFalconPacket) {
    return {};
  }
  device.packets += 1;
  // "must be set in each input packet … to stay homed" (libnifalcon, FalconFirmware.h)
  constexpr std::uint8_t kHomingBit = 1;
  device.homed = device.homed && (static_cast<std::uint32_t>(packet[13] - 'A') & kHomingBit) != 0;
  for (std::size_t motor = 0; motor < 3; ++motor) {
    device.motors[motor] = nibbles_at(packet, 1 + 4 * motor);
  }
  if (device.keeps_what_it_heard) {
    device.heard.push_back(device.motors);
  }
  const auto angles = falcon_inverse(device.place).value_or(glm::dvec3(0.6));
  Buffer answer = {'<'};
  for (glm::length_t leg = 0; leg < 3; ++leg) {
    put_nibbles(answer, counts_of(angles[leg]));
  }
  answer.push_back(static_cast<std::uint8_t>('A' + (device.homed ? 0x70 : 0) + device.buttons));
  answer.push_back('A');
  answer.push_back('>');
  return ftdi(answer);
}

Buffer told(EmulatedWooden& device, Bytes packet) {
  if (packet.size() < kWoodenPacket) {
    return {};
  }
  device.says_pressed = device.says_pressed || device.button;
  if (int16_at(packet, 6) == 1 && device.loses > 0) {
    device.loses -= 1;
  } else if (int16_at(packet, 6) == 1) {
    device.calibrations += 1;
    device.says_pressed = false;
    for (std::size_t i = 0; i < 3; ++i) {
      device.encoders[i] = int16_at(packet, 8 + 2 * i);
      device.encoders[3 + i] = int16_at(packet, 2 * i);
    }
  } else {
    for (std::size_t i = 0; i < 3; ++i) {
      device.currents[i] = int16_at(packet, 2 * i);
    }
  }
  Buffer answer(64);
  for (std::size_t i = 0; i < 6; ++i) {
    put_int16(answer, 2 * i, device.encoders[i]);
  }
  put_int16(answer, 12, device.says_pressed ? std::int16_t{1} : std::int16_t{0});
  return answer;
}

/// As ODrive's firmware 0.5.6 and 0.6 have it: the watchdog's error comes one control cycle after
/// it was enabled unfed, here with the next line; clearing errors does not feed it; an axis with an
/// error does not arm; what was asked for as torque survives all of it.
void obey(EmulatedOdrive& device, const std::string& line, std::string& answer) {
  const bool newer = device.version[1] == std::string("6");
  const std::uint32_t kWatchdogError = newer ? 0x1000000 : 0x800;
  if (device.watched && !device.fed) {
    device.errors |= kWatchdogError;
    device.closed_loop = false;
  }
  if (line.rfind("c 0 ", 0) == 0) {
    device.torque = std::stod(line.substr(4));
    device.found_torque = 0.0;
    device.fed = true;
  } else if (line == "u 0") {
    device.fed = true;
  } else if (line == "w axis0.config.enable_watchdog 1") {
    device.watched = true;
  } else if (line.rfind("r fw_version_", 0) == 0) {
    const char part = line[13];
    answer += device.version[part == 'r' ? 2 : line[14] == 'a' ? 0 : 1] + std::string("\r\n");
  } else if (line == "f 0") {
    answer += std::to_string(device.turns) + " 0.0\r\n";
  } else if (line == (newer ? "r axis0.disarm_reason" : "r axis0.error")) {
    answer += std::to_string(device.errors) + "\r\n";
  } else if (line == "r axis0.current_state") {
    answer += device.closed_loop ? "8\r\n" : "1\r\n";
  } else if (line == "sc") {
    device.errors = 0;
  } else if (line.rfind("r ", 0) == 0) {
    answer += "invalid property\r\n";
  } else if (line.rfind("w axis0.requested_state ", 0) == 0) {
    device.closed_loop = line.back() == '8' && device.calibrated && device.errors == 0;
    device.armed_with_torque =
        device.armed_with_torque || (device.closed_loop && device.found_torque != 0.0);
    device.errors |= line.back() == '8' && !device.calibrated ? 1U : 0U;
  }
}

Buffer told(EmulatedOdrive& device, Bytes packet) {
  std::string answer;
  for (const std::uint8_t byte : packet) {
    if (byte == '\n') {
      std::string said;
      obey(device, {device.line.begin(), device.line.end()}, said);
      // 0.6 leaves out a reply while the one before is not sent.
      answer += device.version[1] == std::string("6") && !answer.empty() ? "" : said;
      device.line.clear();
    } else {
      device.line.push_back(byte);
    }
  }
  return {answer.begin(), answer.end()};
}

std::optional<Buffer> controlled(EmulatedSpaceMouse& device, const UsbSetup& setup, Bytes data) {
  if (setup.request == 6) {
    if (!device.has_descriptor) {
      return std::nullopt;
    }
    return Buffer(kSpaceMouseDescriptor.begin(), kSpaceMouseDescriptor.end());
  }
  if (setup.request == 9 && data.size() == 2) {
    device.light = data[1] == 1;
  }
  return Buffer{};
}

std::optional<Buffer> controlled(EmulatedFalcon& device, const UsbSetup& setup, Bytes /*data*/) {
  if (setup.request == 3) {
    device.baud = setup.value;
  }
  return Buffer{};
}

std::optional<Buffer> controlled(EmulatedWooden&, const UsbSetup&, Bytes) {
  return Buffer{};
}

std::optional<Buffer> controlled(EmulatedOdrive&, const UsbSetup&, Bytes) {
  return Buffer{};
}

std::optional<Buffer> controlled(EmulatedMoteus&, const UsbSetup&, Bytes) {
  return Buffer{};
}

bool without_force(const EmulatedSpaceMouse&) {
  return true;
}
bool without_force(const EmulatedFalcon& device) {
  return device.motors == std::array<std::int16_t, 3>{};
}
bool without_force(const EmulatedWooden& device) {
  return device.currents == std::array<std::int16_t, 3>{};
}
bool without_force(const EmulatedOdrive& device) {
  return device.torque == 0.0;
}
bool without_force(const EmulatedMoteus& device) {
  return device.torque == 0.0;
}
bool without_force(const EmulatedWheel& device) {
  return torque_of(device) == 0.0;
}

UsbInterface interface(std::uint8_t number, std::uint8_t device_class,
                       std::vector<UsbEndpoint> endpoints) {
  return {number, device_class, 0, 0, std::move(endpoints)};
}

}  // namespace

void switch_on(EmulatedDevice& device) {
  if (auto* const wooden = std::get_if<EmulatedWooden>(&device)) {
    wooden->says_pressed = EmulatedWooden{}.says_pressed;
  } else if (auto* const wheel = std::get_if<EmulatedWheel>(&device)) {
    forget_effects(*wheel);
    wheel->said_at = EmulatedWheel{}.said_at;  // it says where it is before anything else
  }
}

void set_time(EmulatedDevice& device, double now) {
  if (auto* const wheel = std::get_if<EmulatedWheel>(&device)) {
    wheel->now = now;
  }
}

Buffer told(EmulatedDevice& device, Bytes packet) {
  return std::visit([&](auto& one) { return told(one, packet); }, device);
}

std::optional<Buffer> controlled(EmulatedDevice& device, const UsbSetup& setup, Bytes data) {
  return std::visit([&](auto& one) { return controlled(one, setup, data); }, device);
}

double share_pushed(const EmulatedDevice& device) {
  constexpr double kMostOfAMotor = 4095.0;  // of a Falcon's
  constexpr double kMostCurrent = 2000.0;   // mA, of a WoodenHaptics' (haptikfabrikenapi)
  constexpr double kMostTorque = 0.2;       // N m, of a knob unless said otherwise
  double most = 0.0;
  if (const auto* const falcon = std::get_if<EmulatedFalcon>(&device)) {
    for (const std::int16_t motor : falcon->motors) {
      most = std::max(most, std::abs(motor) / kMostOfAMotor);
    }
  } else if (const auto* const wooden = std::get_if<EmulatedWooden>(&device)) {
    for (const std::int16_t current : wooden->currents) {
      most = std::max(most, std::abs(current) / kMostCurrent);
    }
  } else if (const auto* const odrive = std::get_if<EmulatedOdrive>(&device)) {
    most = std::abs(odrive->torque) / kMostTorque;
  } else if (const auto* const moteus = std::get_if<EmulatedMoteus>(&device)) {
    most = std::abs(moteus->torque) / kMostTorque;
  } else if (const auto* const wheel = std::get_if<EmulatedWheel>(&device)) {
    most = std::abs(torque_of(*wheel)) / kMostTorque;
  }
  return most;
}

void brown_out(EmulatedDevice& device) {
  if (auto* const falcon = std::get_if<EmulatedFalcon>(&device)) {
    falcon->motors = {};
    falcon->homed = false;
  } else if (auto* const wooden = std::get_if<EmulatedWooden>(&device)) {
    wooden->currents = {};
    wooden->encoders = {};
  } else if (auto* const odrive = std::get_if<EmulatedOdrive>(&device)) {
    const auto version = odrive->version;
    *odrive = EmulatedOdrive{};
    odrive->version = version;
  } else if (std::holds_alternative<EmulatedMoteus>(device)) {
    device = EmulatedMoteus{};
  }
  switch_on(device);
}

bool without_force(const EmulatedDevice& device) {
  return std::visit([](const auto& one) { return without_force(one); }, device);
}

UsbIdentity identity_of(const EmulatedDevice& device) {
  constexpr auto kBulk = UsbEndpointKind::kBulk;
  constexpr auto kInterrupt = UsbEndpointKind::kInterrupt;
  switch (device.index()) {
    case 0:
      return {0x256F, 0xC635, 1, 2, {interface(0, 3, {{0x81, kInterrupt, 16}})}};
    case 1:
      return {0x0403, 0xCB48, 1, 2, {interface(0, 0xFF, {{0x81, kBulk, 64}, {0x02, kBulk, 64}})}};
    case 2:
      return {0x1234,
              0x0006,
              1,
              2,
              {interface(0, 3, {{0x81, kInterrupt, 64}, {0x01, kInterrupt, 64}})}};
    case 4:
      return {0x0483,
              0x5740,
              1,
              2,
              {interface(0, 2, {{0x82, kInterrupt, 8}}),
               interface(1, 10, {{0x01, kBulk, 64}, {0x81, kBulk, 64}})}};
    case 5: {
      const bool other = std::get<EmulatedWheel>(device).is_other;
      UsbIdentity wheel{other ? std::uint16_t{0x346E} : std::uint16_t{0x1209},
                        other ? std::uint16_t{0x0004} : std::uint16_t{0xFFB0},
                        1,
                        2,
                        {interface(0, 2, {{0x82, kInterrupt, 8}}),
                         interface(1, 10, {{0x01, kBulk, 64}, {0x81, kBulk, 64}}),
                         interface(2, 3, {{0x83, kInterrupt, 64}, {0x02, kInterrupt, 64}})}};
      wheel.interfaces[2].plays_effects = true;  // as the system reads it from its descriptor
      return wheel;
    }
    default:
      return {0x1209,
              0x0D32,
              1,
              2,
              {interface(0, 2, {{0x82, kInterrupt, 8}}),
               interface(1, 10, {{0x01, kBulk, 64}, {0x81, kBulk, 64}})}};
  }
}

Buffer descriptors_of(const EmulatedDevice& device) {
  const UsbIdentity identity = identity_of(device);
  const auto low = [](std::uint16_t value) {
    return static_cast<std::uint8_t>(value & 0xFFU);
  };
  const auto high = [](std::uint16_t value) {
    return static_cast<std::uint8_t>(value >> 8U);
  };
  Buffer parts;
  for (const UsbInterface& one : identity.interfaces) {
    const Buffer head = {9,
                         4,
                         one.number,
                         0,
                         static_cast<std::uint8_t>(one.endpoints.size()),
                         one.device_class,
                         one.subclass,
                         one.protocol,
                         0};
    append(parts, head);
    for (const UsbEndpoint& endpoint : one.endpoints) {
      const bool bulk = endpoint.kind == UsbEndpointKind::kBulk;
      const Buffer tail = {7,
                           5,
                           endpoint.address,
                           bulk ? std::uint8_t{2} : std::uint8_t{3},
                           low(endpoint.packet_size),
                           high(endpoint.packet_size),
                           bulk ? std::uint8_t{0} : std::uint8_t{1}};
      append(parts, tail);
    }
  }
  const auto total = static_cast<std::uint16_t>(9 + parts.size());
  Buffer all = {18,
                1,
                0x00,
                0x02,
                0,
                0,
                0,
                8,
                low(identity.vendor),
                high(identity.vendor),
                low(identity.product),
                high(identity.product),
                0,
                1,
                0,
                0,
                0,
                1,
                9,
                2,
                low(total),
                high(total),
                static_cast<std::uint8_t>(identity.interfaces.size()),
                1,
                0,
                0x80,
                50};
  append(all, parts);
  return all;
}

Buffer space_mouse_report(std::uint8_t id, std::array<std::int16_t, 3> axes) {
  Buffer report(7);
  report[0] = id;
  for (std::size_t i = 0; i < 3; ++i) {
    put_int16(report, 1 + 2 * i, axes[i]);
  }
  return report;
}

}  // namespace torsion::engine::test
