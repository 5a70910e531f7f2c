#include "device/drivers/falcon_firmware.hpp"

#include <algorithm>

#include "device/protocols/falcon.hpp"

namespace torsion::engine {
namespace {

// Requests of the FTDI chip, and its divisors for the rates that a Falcon speaks at.
enum Ftdi : std::uint8_t { kReset = 0, kModem = 1, kFlow = 2, kBaud = 3, kData = 4, kLatency = 9 };
constexpr std::uint16_t kPurgeReceived = 1;
constexpr std::uint16_t kPurgeToSend = 2;
constexpr std::uint16_t k9600 = 0x4138;
constexpr std::uint16_t k140000 = 0x0015;
constexpr std::uint16_t k1500000 = 0x0002;
constexpr std::uint16_t kRtsLow = 0x0200;
constexpr std::uint16_t kDtrLow = 0x0100;
constexpr std::uint16_t kDtrHigh = 0x0101;

constexpr UsbSetup ftdi(Ftdi request, std::uint16_t value) {
  return {0x40, request, value, 0, 0};
}

// The chip hands on what it has after this many milliseconds: its usual 16 would make 62 Hz.
constexpr std::array kNormal = {
    ftdi(kReset, kPurgeReceived), ftdi(kReset, kPurgeToSend),   ftdi(kLatency, 1),
    ftdi(kBaud, k1500000),        ftdi(kReset, kPurgeReceived), ftdi(kReset, kPurgeToSend)};
constexpr std::array kLoading = {ftdi(kReset, kPurgeReceived),
                                 ftdi(kReset, kPurgeToSend),
                                 ftdi(kLatency, 16),
                                 ftdi(kBaud, k9600),
                                 ftdi(kData, 8),
                                 ftdi(kFlow, 0),
                                 ftdi(kModem, kRtsLow),
                                 ftdi(kModem, kDtrLow),
                                 ftdi(kModem, kDtrHigh)};
constexpr std::array kWriting = {ftdi(kModem, kDtrLow), ftdi(kBaud, k140000)};

}  // namespace

std::span<const UsbSetup> falcon_normal_set_up() {
  return kNormal;
}

std::span<const UsbSetup> falcon_loading_set_up() {
  return kLoading;
}

std::span<const UsbSetup> falcon_writing_set_up() {
  return kWriting;
}

void take_echo(FalconEcho& echo, Bytes usb_packet) {
  for (const std::uint8_t byte : usb_packet.subspan(std::min(kFtdiStatus, usb_packet.size()))) {
    if (echo.count == echo.bytes.size()) {
      std::ranges::copy(Bytes(echo.bytes).subspan(1), echo.bytes.begin());
      echo.count -= 1;
    }
    echo.bytes[echo.count++] = byte;
  }
}

bool ends_with(const FalconEcho& echo, Bytes expected) {
  return echo.count >= expected.size() &&
         std::ranges::equal(
             Bytes(echo.bytes).subspan(echo.count - expected.size(), expected.size()), expected);
}

}  // namespace torsion::engine
