#pragma once

#include <chrono>
#include <string>

namespace torsion::engine {

/// A bar on stderr for what takes longer than a second; silent where stderr is not a terminal.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  /// @param share  0 to 1; cheap enough to be called often
  void show(double share);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool on_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point next_;
};

}  // namespace torsion::engine
