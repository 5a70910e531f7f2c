#include "app/live/scene_device.hpp"

#include <algorithm>

#include "device/scripted_motion.hpp"

namespace torsion::engine {

Result<SceneDevice> open_device(const DeviceChoice& choice, const SceneDescription& scene) {
  SceneDevice device;
  const auto& tools = scene.tools;
  const auto held = std::ranges::find(tools, "usb", &ToolDescription::device);
  device.tool = held != tools.end() ? static_cast<std::uint32_t>(held - tools.begin()) : 0U;
  DeviceChoice chosen = choice;
  if (chosen.what.empty() && held != tools.end()) {
    chosen.what = "usb";
  }
  if (chosen.what.empty()) {
    return device;
  }
  auto opened = DeviceLink::open(chosen, scripted_pose(tools[device.tool].script, 0.0));
  if (!opened) {
    return opened.error();
  }
  device.link = std::move(opened).value();
  return device;
}

}  // namespace torsion::engine
