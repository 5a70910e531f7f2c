#pragma once

// What is said of a device that holds a tool: in summaries, in the window, in programs' JSON.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/live/device_link.hpp"

namespace torsion::engine {

/// One line for a person on what the device is and does, and what it lacks.
std::string describe(const DeviceView& view);

/// Short lines for a panel: rate, what it measures and displays, the coupling's gains.
std::vector<std::string> device_lines(const DeviceView& view);

/// What of the contact is not felt, one sentence; empty where all of it is, or nothing is there.
std::string not_displayed(const DeviceView& view);

struct DeviceBanner {
  std::string text;     // empty: none
  bool failed = false;  // else there is only something to do
};

/// What a person has to know at once: it is gone, it does not work, it is not yet at the tool.
/// @param steps_go_on  false in a pause and in slow motion, when there is no force
DeviceBanner device_banner(const DeviceView& view, bool steps_go_on);

/// The lines of a summary, and the same for a program.
std::string device_summary(const DeviceView& view);
nlohmann::ordered_json device_json(const DeviceView& view);

}  // namespace torsion::engine
