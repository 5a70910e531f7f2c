#pragma once

// What blocks: opening, claiming, clearing, closing. A thread of its own does it, so that a device
// that is being opened does not hold up the force of another.

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "device/usb/usb_port.hpp"

namespace torsion::engine {

enum class KeeperTask : std::uint8_t { kOpen, kClose, kClaim, kRelease, kClearHalt };

struct KeeperJob {
  KeeperTask task = KeeperTask::kOpen;
  UsbPort* port = nullptr;
  UsbRequest request;                        // of kClaim, kRelease, kClearHalt
  UsbStatus status = UsbStatus::kCompleted;  // once it is done
};

class UsbKeeper {
 public:
  /// @param wanted   whether a device is one to open
  /// @param on_done  called in the keeper's thread after each job
  UsbKeeper(std::function<bool(const UsbIdentity&)> wanted, std::function<void()> on_done);
  ~UsbKeeper();
  UsbKeeper(const UsbKeeper&) = delete;
  UsbKeeper& operator=(const UsbKeeper&) = delete;
  UsbKeeper(UsbKeeper&&) = delete;
  UsbKeeper& operator=(UsbKeeper&&) = delete;

  void ask(const KeeperJob& job);
  /// Takes the jobs that are done into `done`.
  void take_done(std::vector<KeeperJob>& done);

 private:
  void work();

  std::function<bool(const UsbIdentity&)> wanted_;
  std::function<void()> on_done_;
  std::mutex mutex_;
  std::condition_variable more_;
  std::deque<KeeperJob> asked_;
  std::vector<KeeperJob> done_;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace torsion::engine
