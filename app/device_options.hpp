#pragma once

#include <CLI/CLI.hpp>

#include "app/live/device_link.hpp"

namespace torsion::engine {

/// --falcon-firmware, --knob-torque and the buttons that turn.
void add_device_options(CLI::App& subcommand, DeviceChoice& choice);

}  // namespace torsion::engine
