#pragma once

#include <memory>

#include "app/live/device_link.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// A device and the tool that it holds; no link where nothing asks for one.
struct SceneDevice {
  std::unique_ptr<DeviceLink> link;
  std::uint32_t tool = 0;
};

/// Opens what the options ask for, or else a tool of the scene ("torsion_device": "usb"). It holds
/// that tool, else the first, and its workspace is centred where the tool is at first.
Result<SceneDevice> open_device(const DeviceChoice& choice, const SceneDescription& scene);

}  // namespace torsion::engine
