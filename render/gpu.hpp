#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ecs/result.hpp"
#include "render/validation_log.hpp"
#include "render/vk.hpp"

namespace torsion::engine {

struct GpuOptions {
  ValidationLog* validation = nullptr;  // switches the validation layers on; must outlive the Gpu
  bool force_staging = false;
  std::string device_name;  // part of the name; empty: TORSION_GPU, else the best
  // What a window's surface needs of an instance; empty: no window, and no swapchain either.
  std::vector<std::string> surface_extensions;
  std::uint32_t most_texels = UINT32_MAX;  // of a texel buffer, where the device has more
};

/// A device with one queue that does everything. Members are in the order of creation.
struct Gpu {
  vk::raii::Context context;
  vk::raii::Instance instance = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger = nullptr;
  vk::raii::PhysicalDevice physical = nullptr;
  vk::raii::Device device = nullptr;
  vk::raii::Queue queue = nullptr;

  std::uint32_t queue_family = 0;
  std::string name;  // of the device and its driver, with versions
  vk::PhysicalDeviceLimits limits;
  vk::PhysicalDeviceMemoryProperties memory;
  double milliseconds_per_tick = 0.0;  // of a timestamp; 0: the queue has no timestamps
  bool writes_device_memory = false;   // the CPU may write device-local memory: no staging
};

/// Opens a device. Errors: no Vulkan loader, no able device, validation wanted and its layer
/// missing. Throws vk::SystemError where a call fails that should not.
Result<Gpu> open_gpu(const GpuOptions& options);

}  // namespace torsion::engine
