#pragma once

#include <filesystem>

#include "device/device_loop.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// Where `torsion devices --measure` keeps what it has found of a kind of device.
std::filesystem::path measured_traits_file(DeviceKind kind);

/// Of all kinds; zero where nothing was measured. An error names a file that cannot be understood.
Result<std::array<MeasuredTraits, kDeviceKinds>> load_measured_traits();

/// Writes the file. Makes its folder.
Result<Done> save_measured_traits(DeviceKind kind, const MeasuredTraits& traits);

}  // namespace torsion::engine
