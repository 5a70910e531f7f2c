#pragma once

// A SpaceMouse as a device that steers: its deflection is a speed, the pose is where it has been
// steered to. It reports every 8 ms while deflected; the pose goes on in between.

#include <optional>

#include "device/drivers/driver.hpp"
#include "device/protocols/space_mouse.hpp"

namespace torsion::engine {

enum class SpaceMousePhase : std::uint8_t { kClaiming, kAsking, kReading, kNone };

struct SpaceMouseDriver {
  SpaceMousePhase phase = SpaceMousePhase::kClaiming;
  std::size_t candidate = 0;  // interface that is looked at, row of the identity
  std::optional<std::size_t> without_descriptor;  // one that did not say what it is
  bool last_resort = false;                       // it is claimed for its ids alone
  SpaceMouseLayout layout;
  SpaceMouseState state;
  ReadQueue reads;
  double reported_at = 0.0;  // s
  double steered_at = 0.0;   // s
};

void begin(SpaceMouseDriver& driver, DriverCall& call);
void take(SpaceMouseDriver& driver, DriverCall& call, const UsbEvent& event);
void wake(SpaceMouseDriver& driver, DriverCall& call);
void rest(SpaceMouseDriver& driver, DriverCall& call);

/// Speed at a deflection, -1 to 1 of the largest: nothing in the dead band, fine near it, odd.
double steering_response(double deflection);

}  // namespace torsion::engine
