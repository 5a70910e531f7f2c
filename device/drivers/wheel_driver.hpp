#pragma once

// A force-feedback wheel as a knob: its turn is the tool's turn, its torque the contact's about the
// turn axis. All of it is in USB's class for physical interface devices (PID): a wheel plays
// effects that it was given, here one of constant torque, which ends by itself unless it is begun
// again.

#include <cstdint>
#include <limits>

#include "device/drivers/motor_driver.hpp"
#include "device/protocols/wheel.hpp"

namespace torsion::engine {

enum class WheelPhase : std::uint8_t {
  kClaiming,
  kAsking,     // for its report descriptor
  kResetting,  // which ends what other programs have left
  kSettling,   // after that
  kEnabling,
  kGain,
  kCreating,
  kLoading,
  kConfirming,  // whether it says that again
  kDescribing,  // the effect
  kZeroing,
  kPlacing,  // it says where it is when it turns: that has to be known first
  kLive,
  kNone
};

struct WheelDriver {
  WheelPhase phase = WheelPhase::kClaiming;
  std::size_t candidate = 0;  // interface that is looked at, row of the identity
  WriteGate writes;
  ReadQueue reads;
  WheelLayout layout;
  WheelState state;
  std::int32_t block = 0;        // of the effect; 0: there is none
  bool repeated = false;         // the packet of the set-up that is on its way
  bool has_place = false;        // it has said where it is
  bool refused = false;          // it did not take the last packet
  bool knows_block = false;      // it says of its last effect that it has it, whenever it is asked
  bool pinging = false;          // it was asked whether it is there
  bool was_enabled = false;      // since it is live, as far as it says so
  bool was_powered = false;      // likewise
  std::uint32_t last_words = 0;  // packets that let go, still to be sent
  double heard_at = 0.0;         // s: of anything that it said
  double taken_at = 0.0;         // s: when it took a packet
  double reported_at = 0.0;      // s: where it is
  double published_at = 0.0;     // s
  double started_at = 0.0;       // s: its effect
  double interval = 1e-3;        // s: between its reports while it turns
  std::int32_t smallest_step = std::numeric_limits<std::int32_t>::max();  // counts, between two
};

void begin(WheelDriver& driver, DriverCall& call);
void take(WheelDriver& driver, DriverCall& call, const UsbEvent& event);
void wake(WheelDriver& driver, DriverCall& call);
void rest(WheelDriver& driver, DriverCall& call);
void let_go(WheelDriver& driver, DriverCall& call);
void again_later(WheelDriver& driver, DriverCall& call, DeviceTrouble trouble);

}  // namespace torsion::engine
