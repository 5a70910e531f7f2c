#pragma once

// ODrive as a knob: its motor's shaft is the tool's turn axis. Torque in N m goes out, turns
// come back, as lines of text.

#include "device/drivers/motor_driver.hpp"
#include "device/protocols/odrive.hpp"

namespace torsion::engine {

enum class OdrivePhase : std::uint8_t {
  kClaiming,
  kClaimingData,
  kAskingVersion,
  kSettingUp,
  kLive,
  kNone
};

struct OdriveDriver {
  OdrivePhase phase = OdrivePhase::kClaiming;
  std::size_t at = 0;  // in the lines of the set-up
  WriteGate writes;
  std::uint8_t data = 0;  // number of the interface that has it
  ReadQueue reads;
  OdriveStream stream;
  std::uint32_t last_words = 0;  // packets that let go, still to be sent
  double heard_at = 0.0;         // s
  double set_up_at = 0.0;        // s: when it was told to obey
  std::uint32_t until_ask = 0;   // steps until it is asked how it is
  MotorKind language = MotorKind::kOdrive5;
  OdriveQuestion asked = OdriveQuestion::kPlace;
  double torque = 0.0;  // N m, that the last step had
};

void begin(OdriveDriver& driver, DriverCall& call);
void take(OdriveDriver& driver, DriverCall& call, const UsbEvent& event);
void wake(OdriveDriver& driver, DriverCall& call);
void rest(OdriveDriver& driver, DriverCall& call);
void let_go(OdriveDriver& driver, DriverCall& call);
void again_later(OdriveDriver& driver, DriverCall& call, DeviceTrouble trouble);

}  // namespace torsion::engine
