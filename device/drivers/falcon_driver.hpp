#pragma once

// Novint Falcon: one packet out with the motors' values, one packet back with the encoders', about
// a thousand times a second.

#include "device/drivers/falcon_firmware.hpp"
#include "device/drivers/motor_driver.hpp"
#include "device/protocols/falcon_kinematics.hpp"

namespace torsion::engine {

enum class FalconPhase : std::uint8_t {
  kClaiming,
  kNormalSetUp,  // of the FTDI chip
  kAsking,       // is there firmware in it?
  kLoadingSetUp,
  kGreeting,
  kWritingSetUp,
  kReady,
  kWriting,  // the firmware
  kHoming,   // until the user has moved it through its zeros
  kLive,
  kNone,  // until it is plugged in again
};

struct FalconDriver {
  FalconPhase phase = FalconPhase::kClaiming;
  std::size_t at = 0;  // in a list of controls, or bytes of firmware written
  std::uint32_t tries = 0;
  std::uint32_t loads = 0;  // times that firmware was written since it was plugged in
  WriteGate writes;
  ReadQueue reads;
  FalconStream stream;
  FalconEcho echo;
  double heard_at = 0.0;  // s: of the last good packet
  glm::dvec3 place{0.0};  // m, device axes
};

void begin(FalconDriver& driver, DriverCall& call);
void take(FalconDriver& driver, DriverCall& call, const UsbEvent& event);
void wake(FalconDriver& driver, DriverCall& call);
void rest(FalconDriver& driver, DriverCall& call);
void let_go(FalconDriver& driver, DriverCall& call);
void again_later(FalconDriver& driver, DriverCall& call, DeviceTrouble trouble);

}  // namespace torsion::engine
