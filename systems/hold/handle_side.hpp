#pragma once

#include <cstdint>

#include "ecs/components.hpp"
#include "ecs/device_sample.hpp"
#include "systems/hold/hand_speed.hpp"
#include "systems/hold/output_guard.hpp"
#include "systems/hold/passivity.hpp"
#include "systems/hold/sign_check.hpp"
#include "systems/hold/tool_hold.hpp"
#include "systems/hold/virtual_coupling.hpp"

namespace torsion::engine {

/// Where a device's poses are in the world.
struct HandleMap {
  glm::dvec3 origin{0.0};                   // m: of the device's workspace
  glm::dquat turned{1.0, 0.0, 0.0, 0.0};    // the device's rotation when it took hold of the tool
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  // the tool's then
};

/// The pose that the handle asks of the tool's frame, world.
Pose handle_pose(const HandleMap& map, const Pose& device);

/// What a person asks of the guard, and what is known of the motors that the device does not say.
struct HandleSafety {
  bool checks_signs = true;        // before the first force that depends on where the handle is
  std::uint32_t held_buttons = 0;  // bits: one of them has to be held for a force; 0: none
  double continuous_force = 0.0;   // N: what the motors bear for ever; 0: what the device says
  double continuous_torque = 0.0;  // N m, likewise
};

/// What the device's thread keeps of a held tool: all that stands between the newest result of the
/// physics and the wrench that is sent.
struct HandleSide {
  Pose home;  // of the tool, world: where the centre of a device's workspace is
  ToolHold hold = ToolHold::kMassless;
  HandleSafety safety;
  HandleMap map;
  VirtualCoupling coupling;
  std::uint32_t couplings = 0;  // chosen so far: another one counts as another
  PassivityLimits passivity;
  PassivityState books;
  GuardLimits limits;
  OutputGuard guard;
  SignCheck signs;
  Pose device;                // of the device's handle, still while its counts toggle
  Pose last;                  // m, world: of the handle in the sample before
  double last_time = 0.0;     // s: of that sample
  std::uint32_t epoch = 0;    // of the device
  std::uint32_t plugged = 0;  // likewise: what is known of its signs is of that one
  HandSpeed speed;
};

/// The newest that the physics said.
struct PhysicsResult {
  Pose tool;          // world
  double time = 0.0;  // s, steady clock
  bool faulty = false;
  bool any = false;  // false: nothing was said yet
  Wrench contact{};  // of the bodies on the tool, about its frame's origin, world axes
};

struct HandleOutcome {
  Pose handle;            // world
  Wrench wrench;          // to display, about the handle, world axes
  Wrench sent;            // that and what carries the device itself: for its motors
  double distance = 0.0;  // m: from handle to tool
  bool holds = false;     // whether the handle moves the tool; else it is to be brought to it
};

/// One sample of the device. A new epoch of the device begins without force, with the coupling that
/// its traits allow, and takes hold of the tool where the handle is near it; its signs are checked,
/// and then the coupling is chosen anew, as its rate and delay are known by then. A device that
/// steers a rate, or measures no translation, is put where the tool is.
/// @param now  s, steady clock
HandleOutcome take_handle_sample(HandleSide& side, const DeviceSample& sample,
                                 const PhysicsResult& result, double now);

}  // namespace torsion::engine
