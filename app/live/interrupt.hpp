#pragma once

#include <csignal>

namespace torsion::engine {

/// While it lives, SIGINT and SIGTERM do not end the program but are there to be asked for, so that
/// a device is let go of and given back before the end. Make it before any thread.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  Interrupt(Interrupt&&) = delete;
  Interrupt& operator=(Interrupt&&) = delete;

  /// Waits up to this long. @return true when the program was asked to end
  [[nodiscard]] bool within(long milliseconds) const;

 private:
  sigset_t signals_{};
  sigset_t before_{};
};

}  // namespace torsion::engine
