#pragma once

// The kernel's side of USB, made up: libusb, as it is, finds and opens the emulated devices. On
// umockdev, whose preload library is linked into the test and hides the machine's own /sys and
// /dev.

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <umockdev.h>

#include "tests/device/emulated_devices.hpp"

namespace torsion::engine::test {

/// One device on the emulated bus. Its ioctls come on a thread of umockdev.
class MockDevice {
 public:
  /// @param driver  of the kernel, that holds its interfaces; empty: none
  MockDevice(UMockdevTestbed* bed, int number, EmulatedDevice device, std::string driver);
  ~MockDevice();
  MockDevice(const MockDevice&) = delete;
  MockDevice& operator=(const MockDevice&) = delete;
  MockDevice(MockDevice&&) = delete;
  MockDevice& operator=(MockDevice&&) = delete;

  void plug();
  void unplug();

  /// It sends this on its IN endpoint.
  void send(const Buffer& packet);
  /// The next read ends with this, as the kernel says it: -EPIPE, -EOVERFLOW, -EPROTO.
  void fail_next_read(int status);
  /// It takes no packet any more, until it does again: those of before that were not called back.
  void hang_writes(bool hangs);
  /// Claims end with this errno; 0: they are granted, but of what another open file has.
  void refuse_claims(int error);
  /// As the kernel does for a process that ends: umockdev does not say so of one that is killed.
  void close_files();
  /// Nobody but who may open everything may open its node. @pre it is plugged in
  void close_node();

  /// f(device) while no packet is on its way.
  template <class T, class F>
  auto with(F&& f) {
    const std::lock_guard lock(mutex_);
    return f(std::get<T>(device_));
  }
  [[nodiscard]] bool without_force();
  [[nodiscard]] bool kernel_has_it();
  [[nodiscard]] int clears();

 private:
  struct Unref {
    void operator()(UMockdevIoctlData* data) const { g_object_unref(data); }
  };
  using Data = std::unique_ptr<UMockdevIoctlData, Unref>;
  /// Transfers belong to the open file that submitted them, and come back through it alone.
  struct Urb {
    UMockdevIoctlClient* client;
    Data data;
  };
  struct Done {
    Data data;
    int status;
    Buffer bytes;
  };

  static gboolean on_ioctl(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  static void on_vanished(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  /// Its open file is closed.
  void forget(UMockdevIoctlClient* client);
  gboolean answer(UMockdevIoctlClient* client);
  gboolean submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  gboolean bulk(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  /// As the kernel does: only whose file has the interface may talk to its endpoint.
  [[nodiscard]] bool may_use(UMockdevIoctlClient* client, std::uint8_t endpoint) const;
  gboolean reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  gboolean discard(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  gboolean driver(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  gboolean claim(UMockdevIoctlClient* client, UMockdevIoctlData* argument, bool disconnect);
  gboolean release(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  void finish(Urb urb, int status, Buffer bytes = {});
  void match();
  /// Packets get to the device, unless it takes none.
  void tell_all();
  void show_report_descriptor(std::uint8_t interface);
  void show_driver(unsigned interface, const std::string& driver) const;

  UMockdevTestbed* bed_;
  UMockdevIoctlBase* handler_;
  int number_;
  std::string node_;
  std::string sysfs_;
  std::string root_;  // of the emulated /dev and /sys
  std::mutex mutex_;
  EmulatedDevice device_;
  const std::string own_driver_;
  std::string driver_;
  std::map<unsigned, UMockdevIoctlClient*> claims_;  // of an interface, by an open file
  bool gone_ = true;
  bool bound_ = false;
  int refused_ = 0;
  int clears_ = 0;
  std::optional<int> fault_;
  std::deque<Urb> reads_;
  bool hangs_ = false;
  std::deque<Urb> writes_;  // that hang
  std::deque<Buffer> packets_;
  std::map<UMockdevIoctlClient*, std::deque<Done>> done_;
};

/// The bus. Has to be there before libusb is first used.
class MockUsb {
 public:
  MockUsb() : bed_(umockdev_testbed_new()) {}
  ~MockUsb() {
    devices_.clear();
    g_object_unref(bed_);
  }
  MockUsb(const MockUsb&) = delete;
  MockUsb& operator=(const MockUsb&) = delete;
  MockUsb(MockUsb&&) = delete;
  MockUsb& operator=(MockUsb&&) = delete;

  /// Plugs in another device.
  MockDevice& plug(EmulatedDevice device, std::string driver = "");

 private:
  UMockdevTestbed* bed_;
  std::vector<std::unique_ptr<MockDevice>> devices_;
};

}  // namespace torsion::engine::test
