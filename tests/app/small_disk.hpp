#pragma once

#include <csignal>

#include <sys/resource.h>

namespace torsion::engine::test {

/// While it lives no file of this process grows beyond a size, which a write hears of as it does of
/// a full disk.
class SmallDisk {
 public:
  /// @param size  bytes
  explicit SmallDisk(rlim_t size) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{size, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  SmallDisk(SmallDisk&&) = delete;
  SmallDisk& operator=(SmallDisk&&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

}  // namespace torsion::engine::test
