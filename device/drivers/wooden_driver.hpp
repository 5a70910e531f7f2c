#pragma once

// WoodenHaptics: one report out with the motors' currents, one report back, once a millisecond. It
// speaks when spoken to and lets go by itself after half a second of silence.

#include "device/drivers/motor_driver.hpp"
#include "device/protocols/wooden_haptics.hpp"

namespace torsion::engine {

enum class WoodenPhase : std::uint8_t { kClaiming, kAsking, kLive, kNone };

struct WoodenDriver {
  WoodenPhase phase = WoodenPhase::kClaiming;
  WoodenGeometry geometry = wooden_haptics_2015();
  WriteGate writes;
  bool calibrated = false;  // since it was plugged in; without force before
  double pressed_at = 0.0;  // s: when it last said that its button was pressed
  ReadQueue reads;
  double heard_at = 0.0;  // s
};

void begin(WoodenDriver& driver, DriverCall& call);
void take(WoodenDriver& driver, DriverCall& call, const UsbEvent& event);
void wake(WoodenDriver& driver, DriverCall& call);
void rest(WoodenDriver& driver, DriverCall& call);
void let_go(WoodenDriver& driver, DriverCall& call);
void again_later(WoodenDriver& driver, DriverCall& call, DeviceTrouble trouble);

/// The base's axes (x to the user, y to the right, z up) to the world's.
glm::dvec3 wooden_to_world(const glm::dvec3& base);
glm::dvec3 world_to_wooden(const glm::dvec3& world);

}  // namespace torsion::engine
