#include "app/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace torsion::engine {

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)),
      on_(!quiet && ::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      next_(start_ + std::chrono::seconds(1)) {}

Progress::~Progress() {
  if (drawn_) {
    std::fputs("\r\033[K", stderr);
  }
}

void Progress::show(double share) {
  if (!on_ || Clock::now() < next_) {
    return;
  }
  constexpr int kBarWidth = 40;
  const int filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * kBarWidth);
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double left = share > 0.0 ? elapsed / share - elapsed : 0.0;
  fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3.0f} %, {:.0f} s left \033[K", what_, "", filled, "",
             kBarWidth - filled, 100.0 * share, left);
  std::fflush(stderr);
  drawn_ = true;
  next_ = Clock::now() + std::chrono::milliseconds(100);
}

}  // namespace torsion::engine
