#include "device/usb/usb_keeper.hpp"

#include <chrono>

#include <libusb-1.0/libusb.h>

#include "device/usb/usb_identity.hpp"

namespace torsion::engine {
namespace {

constexpr int kOpenTries = 20;
constexpr auto kOpenPause = std::chrono::milliseconds(5);

/// Udev sets the node's rights some time after the device has come.
UsbStatus open(UsbPort& port, const std::function<bool(const UsbIdentity&)>& wanted) {
  const auto identity = read_identity(port.device);
  if (!identity || !wanted(*identity)) {
    return identity && may_say_more(*identity) ? UsbStatus::kTimedOut : UsbStatus::kCancelled;
  }
  port.identity = *identity;
  int error = 0;
  for (int i = 0; i < kOpenTries && !port.left; ++i) {
    error = libusb_open(port.device, &port.handle);
    if (error == 0) {
      return UsbStatus::kCompleted;
    }
    port.handle = nullptr;
    std::this_thread::sleep_for(kOpenPause);
  }
  return port.left ? UsbStatus::kGone : status_of_error(error);
}

/// Takes the interface from the kernel's driver, which gets it back when it is released.
UsbStatus claim(libusb_device_handle* handle, int interface) {
  libusb_set_auto_detach_kernel_driver(handle, 1);
  int error = libusb_claim_interface(handle, interface);
  if (error == LIBUSB_ERROR_OTHER || error == LIBUSB_ERROR_NOT_SUPPORTED) {
    // Not every kernel and not every sandbox can detach a driver; there may be none.
    libusb_set_auto_detach_kernel_driver(handle, 0);
    error = libusb_claim_interface(handle, interface);
  }
  return status_of_error(error);
}

UsbStatus do_job(const KeeperJob& job, const std::function<bool(const UsbIdentity&)>& wanted) {
  UsbPort& port = *job.port;
  switch (job.task) {
    case KeeperTask::kOpen:
      return open(port, wanted);
    case KeeperTask::kClose:
      close_handle(port);
      return UsbStatus::kCompleted;
    case KeeperTask::kClaim:
      return claim(port.handle, job.request.interface);
    case KeeperTask::kRelease:
      return status_of_error(libusb_release_interface(port.handle, job.request.interface));
    case KeeperTask::kClearHalt:
      return status_of_error(libusb_clear_halt(port.handle, job.request.endpoint));
  }
  return UsbStatus::kBroken;
}

}  // namespace

UsbKeeper::UsbKeeper(std::function<bool(const UsbIdentity&)> wanted, std::function<void()> on_done)
    : wanted_(std::move(wanted)), on_done_(std::move(on_done)), thread_([this] { work(); }) {}

UsbKeeper::~UsbKeeper() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  more_.notify_one();
  thread_.join();
}

void UsbKeeper::ask(const KeeperJob& job) {
  {
    const std::lock_guard lock(mutex_);
    asked_.push_back(job);
  }
  more_.notify_one();
}

void UsbKeeper::take_done(std::vector<KeeperJob>& done) {
  const std::lock_guard lock(mutex_);
  done.swap(done_);
  done_.clear();
}

void UsbKeeper::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    more_.wait(lock, [this] { return over_ || !asked_.empty(); });
    if (asked_.empty()) {
      return;  // over, and nothing is left open
    }
    KeeperJob job = asked_.front();
    asked_.pop_front();
    lock.unlock();
    job.status = do_job(job, wanted_);
    lock.lock();
    done_.push_back(job);
    lock.unlock();
    on_done_();
    lock.lock();
  }
}

}  // namespace torsion::engine
