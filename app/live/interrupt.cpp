#include "app/live/interrupt.hpp"

#include <ctime>

namespace torsion::engine {

Interrupt::Interrupt() {
  ::sigemptyset(&signals_);
  ::sigaddset(&signals_, SIGINT);
  ::sigaddset(&signals_, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &signals_, &before_);
}

Interrupt::~Interrupt() {
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool Interrupt::within(long milliseconds) const {
  const timespec time{milliseconds / 1000, milliseconds % 1000 * 1'000'000};
  return ::sigtimedwait(&signals_, nullptr, &time) > 0;
}

}  // namespace torsion::engine
