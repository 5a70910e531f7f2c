#pragma once

#include "app/live/device_choice.hpp"

namespace torsion::engine {

/// Measures what the device of a choice is by itself, with its owner's consent, and keeps it for
/// the sessions that follow.
/// @param choice  of one kind of device
/// @param agreed  nobody is asked: the device may move at once
/// @return the program's exit code
int measure_device(const DeviceChoice& choice, bool agreed);

}  // namespace torsion::engine
