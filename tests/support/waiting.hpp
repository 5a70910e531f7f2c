#pragma once

#include <chrono>
#include <thread>

namespace torsion::engine::test {

/// How long a test waits for what another thread or process is to do, s: far longer than any
/// machine takes that runs other tests beside it, under a sanitizer.
inline constexpr double kPatience = 300.0;

/// Calls holds() every millisecond or so; false where it stays false for kPatience.
template <class F>
bool comes_true(F&& holds) {
  using Time = std::chrono::steady_clock;
  for (const auto start = Time::now();
       std::chrono::duration<double>(Time::now() - start).count() < kPatience;) {
    if (holds()) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace torsion::engine::test
