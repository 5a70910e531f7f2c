#pragma once

// A process beside the program that takes the force off the motors should the program die without a
// word (kill -9, a crash, no memory): most devices hold their last force then, some for good. It
// waits at a socket, whose end says that the program is no more.

#include <memory>

#include "device/usb/usb_identity.hpp"
#include "device/usb/usb_io.hpp"

namespace torsion::engine {

class ReleaseProcess {
 public:
  /// Forks. @return null where the system makes no process: then nothing looks after the program
  static std::unique_ptr<ReleaseProcess> start();

  /// Ends the process: the program has let go by itself.
  ~ReleaseProcess();
  ReleaseProcess(const ReleaseProcess&) = delete;
  ReleaseProcess& operator=(const ReleaseProcess&) = delete;
  ReleaseProcess(ReleaseProcess&&) = delete;
  ReleaseProcess& operator=(ReleaseProcess&&) = delete;

  /// From here on this device is to be let go of by these packets. Waits for nothing.
  /// @param row   of the devices, under kMostDevices
  /// @param last  what a driver's rest() asks for; its writes count
  void look_after(std::size_t row, const UsbIdentity& identity, const UsbRequests& last) const;

  [[nodiscard]] int process() const { return process_; }

  /// The device has gone, or has no force any more.
  void forget(std::size_t row) const;

 private:
  ReleaseProcess(int socket, int process) : socket_(socket), process_(process) {}

  int socket_;
  int process_;
};

}  // namespace torsion::engine
