#pragma once

#include <CLI/CLI.hpp>

#include "app/live/device_choice.hpp"

namespace torsion::engine {

/// How a device is held and kept safe: its limits, its buttons, the maker's firmware.
void add_device_options(CLI::App& subcommand, DeviceChoice& choice);

}  // namespace torsion::engine
