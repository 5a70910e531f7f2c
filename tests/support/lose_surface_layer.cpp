// A Vulkan layer that loses surfaces, for tests. TORSION_LOSE_SURFACE says
// when, as words CALL:NUMBER: the NUMBER-th such call loses the surface, and
// from then on every call on it fails until the program destroys it; then the
// next word is waited for. CALL is acquire, present, capabilities or swapchain.
// Each loss and each cure is a line on stderr.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

// One instance and one device, as the program has.
struct Layer {
  PFN_vkGetInstanceProcAddr next_of_instance = nullptr;
  PFN_vkGetDeviceProcAddr next_of_device = nullptr;
  // The next layer's, asked for while instance and device are made: later the loader would answer
  // with this layer's own.
  PFN_vkCreateDevice create_device = nullptr;
  PFN_vkDestroySurfaceKHR destroy_surface = nullptr;
  PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR get_capabilities = nullptr;
  PFN_vkCreateSwapchainKHR create_swapchain = nullptr;
  PFN_vkAcquireNextImageKHR acquire = nullptr;
  PFN_vkQueuePresentKHR present = nullptr;

  std::istringstream plan;
  std::string call;  // the next to lose the surface
  int left = 0;      // such calls until then
  bool lost = false;

  Layer() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing sets it while the program runs
    if (const char* const words = std::getenv("TORSION_LOSE_SURFACE")) {
      plan.str(words);
    }
    next_word();
  }

  void next_word() {
    lost = false;
    call.clear();
    std::string word;
    if (plan >> word) {
      const std::size_t colon = word.find(':');
      call = word.substr(0, colon);
      left = std::atoi(word.c_str() + colon + 1);
    }
  }

  /// Whether this call finds the surface lost.
  bool loses(const char* name) {
    if (!lost && call == name && --left == 0) {
      lost = true;
      std::fprintf(stderr, "surface lost in %s\n", name);
    }
    return lost;
  }
};

Layer& layer() {
  static Layer only;
  return only;
}

template <class Function>
void ask_instance(VkInstance instance, const char* name, Function& function) {
  function = reinterpret_cast<Function>(layer().next_of_instance(instance, name));
}

template <class Function>
void ask_device(VkDevice device, const char* name, Function& function) {
  function = reinterpret_cast<Function>(layer().next_of_device(device, name));
}

/// The link to the next layer in a chain of structures, which the loader put
/// there.
template <class Link>
Link* link_of(const void* chain, VkStructureType type) {
  for (const auto* at = static_cast<const VkBaseInStructure*>(chain); at != nullptr;
       at = at->pNext) {
    auto* link = reinterpret_cast<const Link*>(at);
    if (at->sType == type && link->function == VK_LAYER_LINK_INFO) {
      return const_cast<Link*>(link);
    }
  }
  return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info,
                                               const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
  auto* link = link_of<VkLayerInstanceCreateInfo>(info->pNext,
                                                  VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  if (link == nullptr) {
    return VK_ERROR_INITIALIZATION_FAILED;
  }
  layer().next_of_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  PFN_vkCreateInstance create = nullptr;
  ask_instance(VK_NULL_HANDLE, "vkCreateInstance", create);
  const VkResult result = create(info, allocator, instance);
  if (result == VK_SUCCESS) {
    ask_instance(*instance, "vkCreateDevice", layer().create_device);
    ask_instance(*instance, "vkDestroySurfaceKHR", layer().destroy_surface);
    ask_instance(*instance, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR", layer().get_capabilities);
  }
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical,
                                             const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator,
                                             VkDevice* device) {
  auto* link =
      link_of<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  if (link == nullptr) {
    return VK_ERROR_INITIALIZATION_FAILED;
  }
  layer().next_of_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const VkResult result = layer().create_device(physical, info, allocator, device);
  if (result == VK_SUCCESS) {
    ask_device(*device, "vkCreateSwapchainKHR", layer().create_swapchain);
    ask_device(*device, "vkAcquireNextImageKHR", layer().acquire);
    ask_device(*device, "vkQueuePresentKHR", layer().present);
  }
  return result;
}

VKAPI_ATTR void VKAPI_CALL destroy_surface(VkInstance instance, VkSurfaceKHR surface,
                                           const VkAllocationCallbacks* allocator) {
  if (layer().lost) {
    std::fprintf(stderr, "surface given up\n");
    layer().next_word();
  }
  layer().destroy_surface(instance, surface, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL get_capabilities(VkPhysicalDevice physical, VkSurfaceKHR surface,
                                                VkSurfaceCapabilitiesKHR* capabilities) {
  if (layer().loses("capabilities")) {
    return VK_ERROR_SURFACE_LOST_KHR;
  }
  return layer().get_capabilities(physical, surface, capabilities);
}

VKAPI_ATTR VkResult VKAPI_CALL create_swapchain(VkDevice device,
                                                const VkSwapchainCreateInfoKHR* info,
                                                const VkAllocationCallbacks* allocator,
                                                VkSwapchainKHR* swapchain) {
  if (layer().loses("swapchain")) {
    return VK_ERROR_SURFACE_LOST_KHR;
  }
  return layer().create_swapchain(device, info, allocator, swapchain);
}

VKAPI_ATTR VkResult VKAPI_CALL acquire(VkDevice device, VkSwapchainKHR swapchain,
                                       std::uint64_t timeout, VkSemaphore semaphore, VkFence fence,
                                       std::uint32_t* image) {
  if (layer().loses("acquire")) {
    return VK_ERROR_SURFACE_LOST_KHR;
  }
  return layer().acquire(device, swapchain, timeout, semaphore, fence, image);
}

/// What is waited for is waited for also where the surface is lost.
VKAPI_ATTR VkResult VKAPI_CALL present(VkQueue queue, const VkPresentInfoKHR* info) {
  const bool lost = layer().loses("present");
  const VkResult result = layer().present(queue, info);
  return lost ? VK_ERROR_SURFACE_LOST_KHR : result;
}

struct Taken {
  const char* name;
  PFN_vkVoidFunction function;
};

template <class Function>
Taken taken(const char* name, Function* function) {
  return {name, reinterpret_cast<PFN_vkVoidFunction>(function)};
}

PFN_vkVoidFunction find(std::initializer_list<Taken> all, const char* name) {
  for (const Taken& one : all) {
    if (std::strcmp(one.name, name) == 0) {
      return one.function;
    }
  }
  return nullptr;
}

PFN_vkVoidFunction of_device(const char* name) {
  return find({taken("vkCreateSwapchainKHR", create_swapchain),
               taken("vkAcquireNextImageKHR", acquire), taken("vkQueuePresentKHR", present)},
              name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device, const char* name) {
  if (const PFN_vkVoidFunction mine = of_device(name)) {
    return mine;
  }
  return layer().next_of_device(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance instance,
                                                               const char* name) {
  const PFN_vkVoidFunction mine =
      find({taken("vkCreateInstance", create_instance), taken("vkCreateDevice", create_device),
            taken("vkDestroySurfaceKHR", destroy_surface),
            taken("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", get_capabilities),
            taken("vkGetInstanceProcAddr", get_instance_function),
            taken("vkGetDeviceProcAddr", get_device_function)},
           name);
  if (mine != nullptr) {
    return mine;
  }
  if (const PFN_vkVoidFunction device_function = of_device(name)) {
    return device_function;
  }
  return instance == VK_NULL_HANDLE ? nullptr : layer().next_of_instance(instance, name);
}

}  // namespace

/// What the loader asks a layer for at first (version 2 of its interface to
/// layers).
extern "C" VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* pVersionStruct) {
  pVersionStruct->loaderLayerInterfaceVersion = 2;
  pVersionStruct->pfnGetInstanceProcAddr = get_instance_function;
  pVersionStruct->pfnGetDeviceProcAddr = get_device_function;
  pVersionStruct->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
