#pragma once

#include <memory>
#include <vector>

#include "app/live/device_choice.hpp"
#include "app/run_statistics.hpp"
#include "device/gateway/gateway.hpp"
#include "device/handle_slot.hpp"
#include "device/joined_knob.hpp"
#include "device/usb/usb_bus.hpp"
#include "ecs/result.hpp"
#include "ecs/triple_buffer.hpp"
#include "systems/hold/handle_side.hpp"

namespace torsion::engine {

/// A mouse that carries the tool of a device that only turns it.
struct MouseCarry {
  glm::dvec3 moved{0.0};       // m, world: so far
  double stiffness = 0.0;      // N/m, of the coupling in translation; 0: nobody carries
  double largest_force = 0.0;  // N, likewise
};

/// What the device's thread shows of itself.
struct DeviceView {
  DeviceSample sample;
  HandleOutcome outcome;
  VirtualCoupling coupling;
  ToolHold hold = ToolHold::kMassless;
  GuardState guard = GuardState::kWaiting;
  GuardReason reason = GuardReason::kFar;       // why there is no force, where there is none
  GuardReason stopped_by = GuardReason::kNone;  // what ended the last one
  SignVerdict signs = SignVerdict::kRunning;
  std::uint8_t reversed_axes = 0;      // bits
  bool is_warm = false;                // its motors: it gets less than its largest
  Histogram answer_us{kShortestTime};  // from a sample's arrival to its wrench's going out
  Histogram result_us{kShortestTime};  // how old the physics' result in that wrench was
  std::uint64_t losses = 0;            // times that the device was live and then not
};

/// The devices of one tool: the USB threads or the gateway's, and what they say to the physics
/// thread.
class DeviceLink {
 public:
  /// @param tool  the tool's frame at the start, world: the centre of the device's workspace
  static Result<std::unique_ptr<DeviceLink>> open(const DeviceChoice& choice, const Pose& tool);
  ~DeviceLink();
  DeviceLink(const DeviceLink&) = delete;
  DeviceLink& operator=(const DeviceLink&) = delete;
  DeviceLink(DeviceLink&&) = delete;
  DeviceLink& operator=(DeviceLink&&) = delete;

  /// For the physics thread.
  [[nodiscard]] HandleSlot& slot() { return slot_; }
  /// For one thread that shows it: the newest.
  [[nodiscard]] const DeviceView& view();

  /// For that thread: how far a mouse has carried the tool, of a device that measures no
  /// translation.
  void carry(const MouseCarry& carry);

  /// One sample, in the device's thread: tells the physics, and answers with the wrench to display.
  static Wrench on_sample(void* link, const DeviceSample& sample);

  /// What a client of the gateway is told after on_sample(), besides its wrench.
  static void describe(void* link, GatewayAnswer& answer);

  /// Without USB: a test feeds on_sample itself.
  explicit DeviceLink(const Pose& tool);

 private:
  static std::unique_ptr<DeviceLink> held_as(const DeviceChoice& choice, const Pose& tool);
  static Result<std::unique_ptr<DeviceLink>> open_gateway(const DeviceChoice& choice,
                                                          const Pose& tool);
  static Wrench on_client(void* context, const DeviceSample& said);
  Result<Done> start_usb(const DeviceChoice& choice, std::uint32_t kinds, SampleSink sink);
  [[nodiscard]] glm::dvec3 turn_axis() const;
  Wrench take(const DeviceSample& said);
  void add_carried(DeviceSample& sample);
  void show_guard();

  HandleSlot slot_;
  HandleSide side_;
  TripleBuffer<MouseCarry> carries_;
  glm::dvec3 carried_{0.0};  // m: as far as the tool has come after the mouse
  double carried_at_ = 0.0;  // s
  DeviceView now_;           // the device thread's
  TripleBuffer<DeviceView> views_;
  std::uint64_t number_ = 0;
  TurnButtons turn_buttons_;  // of a gateway's client
  ButtonTurn button_turn_;
  std::vector<std::uint8_t> firmware_;
  std::unique_ptr<JoinedKnob> knob_;
  std::unique_ptr<UsbBus> bus_;  // last: they end before what their threads use
  std::unique_ptr<Gateway> gateway_;
};

}  // namespace torsion::engine
