#pragma once

// A moteus controller as a knob: its motor's shaft is the tool's turn axis. Torque in N m goes out,
// turns come back.

#include "device/drivers/motor_driver.hpp"
#include "device/protocols/moteus.hpp"

namespace torsion::engine {

enum class MoteusPhase : std::uint8_t {
  kClaiming,
  kClaimingData,
  kAskingVersion,
  kStopping,  // which ends what is left of faults and of another program's commands
  kLive,
  kNone
};

struct MoteusDriver {
  MoteusPhase phase = MoteusPhase::kClaiming;
  WriteGate writes;
  std::uint8_t data = 0;  // number of the interface that has it
  ReadQueue reads;
  MoteusStream stream;
  std::uint32_t last_words = 0;  // packets that let go, still to be sent
  double heard_at = 0.0;         // s
  double set_up_at = 0.0;        // s: when it was told to obey
};

void begin(MoteusDriver& driver, DriverCall& call);
void take(MoteusDriver& driver, DriverCall& call, const UsbEvent& event);
void wake(MoteusDriver& driver, DriverCall& call);
void rest(MoteusDriver& driver, DriverCall& call);
void let_go(MoteusDriver& driver, DriverCall& call);
void again_later(MoteusDriver& driver, DriverCall& call, DeviceTrouble trouble);

}  // namespace torsion::engine
