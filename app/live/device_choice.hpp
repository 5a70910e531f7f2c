#pragma once

// What the command line says of the devices that are to hold a tool, and what it comes to.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "device/device_loop.hpp"
#include "device/gateway/gateway.hpp"
#include "ecs/result.hpp"
#include "systems/hold/handle_side.hpp"

namespace torsion::engine {

/// Which devices are to hold a tool, as the command line says it.
struct DeviceChoice {
  std::string what;  // "usb", "usb:falcon+odrive", "gateway+wheel"; empty: none
  std::filesystem::path falcon_firmware;  // empty: in the user's data folder, if there
  double largest_knob_torque = 0.2;       // N m
  double wheel_torque = 0.0;              // N m, of a wheel's full scale; 0: not known
  double wheel_range = 900.0;             // degrees, of a wheel from lock to lock
  bool wheel_reversed = false;
  std::string gateway_address;           // where other machines reach it; empty: they do not
  std::filesystem::path gateway_secret;  // the file; empty: none
  TurnButtons turn_buttons;              // of a device that senses no turn
  ToolHold hold = ToolHold::kMassless;   // a mouse's too
  HandleSafety safety;
  // s: without a result of the physics, then the force falls
  double longest_silence = GuardLimits{}.longest_silence;
};

/// Bits of DeviceKind that a choice allows, or what is wrong with it.
Result<std::uint32_t> kinds_of(const std::string& what);

/// A gateway, and what on the USB turns the tool that its client moves.
struct GatewayChoice {
  std::string gateway;      // as gateway_of() reads it
  std::uint32_t knobs = 0;  // bits of DeviceKind; 0: none
};
Result<GatewayChoice> gateway_choice(const std::string& what);

/// The gateway of a choice, with its address and its secret. Error: what is wrong with any of them.
Result<GatewayOptions> gateway_options(const DeviceChoice& choice, const std::string& gateway);

/// What a file that only its owner can read has, without the white space around it.
/// Error: it cannot be read, others can read it, or it is too short or too long for a secret.
Result<std::vector<std::uint8_t>> load_secret(const std::filesystem::path& path);

/// How the devices of a choice are driven. @param firmware  of a Falcon, has to outlive them
LoopOptions loop_of(const DeviceChoice& choice, std::uint32_t kinds,
                    std::span<const std::uint8_t> firmware);

/// Empty where no option names one and none is at the usual place: it may be loaded already.
Result<std::vector<std::uint8_t>> load_firmware(const std::filesystem::path& chosen);

/// What the user keeps for Torsion: $XDG_DATA_HOME/torsion, ~/.local/share/torsion.
std::filesystem::path user_data_folder();

/// Where firmware is looked for that no option names.
std::filesystem::path usual_falcon_firmware();

}  // namespace torsion::engine
