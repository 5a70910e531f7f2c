#pragma once

// The device loop on libusb: a thread that waits for events and runs the drivers, and a keeper for
// what blocks. Devices may come and go at any time.

#include <functional>
#include <memory>

#include "device/device_loop.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

struct UsbBusOptions {
  LoopOptions loop;
  std::function<void()> on_start;  // in the device thread, before it does anything; may be empty
};

class UsbBus {
 public:
  /// Starts the threads. The sink is called in the device thread only.
  /// @return an error where the system has no USB at all
  static Result<std::unique_ptr<UsbBus>> start(const UsbBusOptions& options, SampleSink sink);

  /// Takes all force off the devices, closes them, gives them back to the kernel's drivers, and
  /// ends the threads.
  ~UsbBus();
  UsbBus(const UsbBus&) = delete;
  UsbBus& operator=(const UsbBus&) = delete;
  UsbBus(UsbBus&&) = delete;
  UsbBus& operator=(UsbBus&&) = delete;

  /// Transfers that the bus refused because the device had gone in between: they have no end.
  [[nodiscard]] std::uint64_t submits_after_loss() const;

 private:
  struct State;
  explicit UsbBus(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace torsion::engine
