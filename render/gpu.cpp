#include "render/gpu.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "render/device_choice.hpp"

namespace torsion::engine {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

std::vector<const char*> device_extensions(const GpuOptions& options) {
  std::vector<const char*> extensions = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
  if (!options.surface_extensions.empty()) {
    extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  }
  return extensions;
}

vk::DebugUtilsMessengerCreateInfoEXT messenger_info(ValidationLog* log) {
  // Vulkan-Hpp 1.4 has the callback with types of its own, older ones with those of C.
  using Callback = decltype(vk::DebugUtilsMessengerCreateInfoEXT::pfnUserCallback);
  const Callback keep_message = [](auto /*severity*/, auto types, const auto* data, void* kept) {
    // Mesa sends warnings of its own about SPIR-V through the same messenger, without this bit.
    if ((static_cast<std::uint32_t>(types) & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) != 0) {
      static_cast<ValidationLog*>(kept)->messages.emplace_back(data->pMessage);
    }
    return VkBool32{VK_FALSE};
  };
  return {
      .messageSeverity = vk::DebugUtilsMessageSeverityFlagBitsEXT::eWarning |
                         vk::DebugUtilsMessageSeverityFlagBitsEXT::eError,
      .messageType = vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation,
      .pfnUserCallback = keep_message,
      .pUserData = log,
  };
}

bool has_validation_layer(const vk::raii::Context& context) {
  return std::ranges::any_of(context.enumerateInstanceLayerProperties(),
                             [](const vk::LayerProperties& layer) {
                               return std::strcmp(layer.layerName, kValidationLayer) == 0;
                             });
}

vk::raii::Instance make_instance(const vk::raii::Context& context, const GpuOptions& options) {
  const vk::ApplicationInfo application{.pApplicationName = "torsion",
                                        .apiVersion = VK_API_VERSION_1_3};
  std::vector<const char*> extensions;
  for (const std::string& extension : options.surface_extensions) {
    extensions.push_back(extension.c_str());
  }
  vk::InstanceCreateInfo info{.pApplicationInfo = &application};
  const std::array enabled = {vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
  const vk::ValidationFeaturesEXT features{.enabledValidationFeatureCount = enabled.size(),
                                           .pEnabledValidationFeatures = enabled.data()};
  vk::DebugUtilsMessengerCreateInfoEXT messenger = messenger_info(options.validation);
  messenger.pNext = &features;
  if (options.validation != nullptr) {
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    info.pNext = &messenger;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
  }
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  return {context, info};
}

GpuKind kind_of(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return GpuKind::kDiscrete;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return GpuKind::kIntegrated;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return GpuKind::kVirtual;
    case vk::PhysicalDeviceType::eCpu:
      return GpuKind::kProcessor;
    case vk::PhysicalDeviceType::eOther:
      break;
  }
  return GpuKind::kOther;
}

/// The first family that draws and computes (Vulkan has one wherever anything can draw).
std::optional<std::uint32_t> find_queue_family(const vk::raii::PhysicalDevice& device) {
  const auto wanted = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
  const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
  for (std::uint32_t family = 0; family < families.size(); ++family) {
    if ((families[family].queueFlags & wanted) == wanted) {
      return family;
    }
  }
  return std::nullopt;
}

DeviceFacts facts_of(const vk::raii::PhysicalDevice& device, const GpuOptions& options) {
  const vk::PhysicalDeviceProperties properties = device.getProperties();
  DeviceFacts facts{properties.deviceName, kind_of(properties.deviceType), {}};
  if (properties.apiVersion < VK_API_VERSION_1_3) {
    facts.missing.emplace_back("Vulkan 1.3");
    return facts;
  }
  const auto features =
      device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan13Features>();
  const auto& features_13 = features.get<vk::PhysicalDeviceVulkan13Features>();
  if (features_13.dynamicRendering == VK_FALSE) {
    facts.missing.emplace_back("dynamicRendering");
  }
  if (features_13.synchronization2 == VK_FALSE) {
    facts.missing.emplace_back("synchronization2");
  }
  if (!find_queue_family(device)) {
    facts.missing.emplace_back("a queue that draws and computes");
  }
  const std::vector<vk::ExtensionProperties> extensions =
      device.enumerateDeviceExtensionProperties();
  for (const char* wanted : device_extensions(options)) {
    const bool there =
        std::ranges::any_of(extensions, [&](const vk::ExtensionProperties& extension) {
          return std::strcmp(extension.extensionName, wanted) == 0;
        });
    if (!there) {
      facts.missing.emplace_back(wanted);
    }
  }
  return facts;
}

vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical, std::uint32_t queue_family,
                             const GpuOptions& options) {
  const std::vector<const char*> extensions = device_extensions(options);
  const float priority = 1.0F;
  const vk::DeviceQueueCreateInfo queue{
      .queueFamilyIndex = queue_family, .queueCount = 1, .pQueuePriorities = &priority};
  const vk::PhysicalDeviceVulkan13Features features{.synchronization2 = VK_TRUE,
                                                    .dynamicRendering = VK_TRUE};
  return {physical, vk::DeviceCreateInfo{
                        .pNext = &features,
                        .queueCreateInfoCount = 1,
                        .pQueueCreateInfos = &queue,
                        .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                        .ppEnabledExtensionNames = extensions.data(),
                    }};
}

/// True where the CPU can write nearly all device-local memory: always on a processor, on a card
/// with a resized BAR. A small window into it (256 MiB is common) would run out.
bool can_write_device_memory(const vk::PhysicalDeviceMemoryProperties& memory) {
  const auto wanted = vk::MemoryPropertyFlagBits::eDeviceLocal |
                      vk::MemoryPropertyFlagBits::eHostVisible |
                      vk::MemoryPropertyFlagBits::eHostCoherent;
  vk::DeviceSize largest = 0;
  vk::DeviceSize writable = 0;
  for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
    const vk::MemoryType& row = memory.memoryTypes[type];
    const vk::DeviceSize size = memory.memoryHeaps[row.heapIndex].size;
    if (row.propertyFlags & vk::MemoryPropertyFlagBits::eDeviceLocal) {
      largest = std::max(largest, size);
    }
    if ((row.propertyFlags & wanted) == wanted) {
      writable = std::max(writable, size);
    }
  }
  return writable >= largest / 2 && writable > 0;
}

std::string wanted_name(const GpuOptions& options) {
  if (!options.device_name.empty()) {
    return options.device_name;
  }
  const char* const named =
      std::getenv("TORSION_GPU");  // NOLINT(concurrency-mt-unsafe): nothing here sets it
  return named == nullptr ? "" : named;
}

std::string full_name(const vk::raii::PhysicalDevice& physical) {
  const auto chain =
      physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
  const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
  return std::string(chain.get<vk::PhysicalDeviceProperties2>().properties.deviceName.data()) +
         ", " + driver.driverName.data() + " " + driver.driverInfo.data();
}

/// A Gpu with nothing but the loader; none where there is no loader to be found.
std::optional<Gpu> find_loader() {
  try {
    return Gpu{};
  } catch (const std::runtime_error&) {  // what vulkan.hpp's dynamic loader says
    return std::nullopt;
  }
}

}  // namespace

Result<Gpu> open_gpu(const GpuOptions& options) {
  std::optional<Gpu> found = find_loader();
  if (!found) {
    return Error{
        "Drawing needs Vulkan, and its loader is not installed (package libvulkan1; with a driver, "
        "such as those of mesa-vulkan-drivers)."};
  }
  Gpu gpu = *std::move(found);
  if (options.validation != nullptr && !has_validation_layer(gpu.context)) {
    return Error{"The Vulkan validation layer is not installed (package vulkan-validationlayers)."};
  }
  try {
    gpu.instance = make_instance(gpu.context, options);
  } catch (const vk::IncompatibleDriverError&) {  // what the loader says when it finds none
    return choose_device({}, {}).error();
  }
  if (options.validation != nullptr) {
    gpu.messenger = {gpu.instance, messenger_info(options.validation)};
  }

  std::vector<vk::raii::PhysicalDevice> devices;
  std::vector<DeviceFacts> facts;
  for (vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(gpu.instance)) {
    facts.push_back(facts_of(device, options));
    devices.push_back(std::move(device));
  }
  const Result<std::size_t> chosen = choose_device(facts, wanted_name(options));
  if (!chosen) {
    return chosen.error();
  }

  gpu.physical = std::move(devices[chosen.value()]);
  gpu.queue_family = *find_queue_family(gpu.physical);
  gpu.device = make_device(gpu.physical, gpu.queue_family, options);
  gpu.queue = {gpu.device, gpu.queue_family, 0};
  gpu.name = full_name(gpu.physical);
  gpu.limits = gpu.physical.getProperties().limits;
  gpu.limits.maxTexelBufferElements =
      std::min(gpu.limits.maxTexelBufferElements, options.most_texels);
  gpu.memory = gpu.physical.getMemoryProperties();
  gpu.writes_device_memory = !options.force_staging && can_write_device_memory(gpu.memory);
  if (gpu.physical.getQueueFamilyProperties()[gpu.queue_family].timestampValidBits > 0) {
    gpu.milliseconds_per_tick = static_cast<double>(gpu.limits.timestampPeriod) * 1e-6;
  }
  return gpu;
}

}  // namespace torsion::engine
