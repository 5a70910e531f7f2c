#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ecs/result.hpp"

namespace torsion::engine {

/// In order of preference.
enum class GpuKind { kDiscrete, kIntegrated, kVirtual, kOther, kProcessor };

/// What the choice needs to know of a Vulkan device.
struct DeviceFacts {
  std::string name;
  GpuKind kind = GpuKind::kOther;
  std::vector<std::string> missing;  // what it lacks of what the renderer needs, in Vulkan's words
};

/// The row of the best device that lacks nothing: of those whose name contains `wanted` (any, if
/// empty; upper and lower case are the same) the most preferred kind, of these the first. The error
/// lists every device and what it lacks.
Result<std::size_t> choose_device(std::span<const DeviceFacts> devices, std::string_view wanted);

}  // namespace torsion::engine
