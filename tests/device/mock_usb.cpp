#include "tests/device/mock_usb.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "device/steady_clock.hpp"
// usbdevice_fs.h uses what ioctl.h defines.
#include <linux/ioctl.h>
#include <linux/usbdevice_fs.h>

namespace torsion::engine::test {
namespace {

constexpr std::size_t kSetupSize = 8;

std::string root_of(UMockdevTestbed* bed) {
  const std::unique_ptr<char, decltype(&g_free)> root(umockdev_testbed_get_root_dir(bed), g_free);
  return root.get();
}

gboolean complete(UMockdevIoctlClient* client, int result, int error) {
  umockdev_ioctl_client_complete(client, result, error);
  return TRUE;
}

gboolean granted(UMockdevIoctlClient* client) {
  return complete(client, 0, 0);
}

gboolean refused(UMockdevIoctlClient* client, int error) {
  return complete(client, -1, error);
}

/// The interface that a request names first.
unsigned interface_in(UMockdevIoctlData* argument) {
  const std::unique_ptr<UMockdevIoctlData, decltype(&g_object_unref)> data(
      umockdev_ioctl_data_resolve(argument, 0, sizeof(unsigned), nullptr), g_object_unref);
  unsigned interface = 0;
  std::memcpy(&interface, data->data, sizeof interface);
  return interface;
}

UsbSetup setup_of(const std::uint8_t* bytes) {
  const auto word = [bytes](std::size_t at) {
    return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
  };
  return {bytes[0], bytes[1], word(2), word(4), word(6)};
}

}  // namespace

MockDevice::MockDevice(UMockdevTestbed* bed, int number, EmulatedDevice device, std::string driver)
    : bed_(bed),
      handler_(umockdev_ioctl_base_new()),
      number_(number),
      node_(fmt::format("/dev/bus/usb/001/{:03}", number)),
      sysfs_(fmt::format("/sys/devices/usb1/1-{}", number)),
      root_(root_of(bed)),
      device_(std::move(device)),
      own_driver_(std::move(driver)) {
  g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(&MockDevice::on_ioctl), this);
  g_signal_connect(handler_, "client-vanished", G_CALLBACK(&MockDevice::on_vanished), this);
}

MockDevice::~MockDevice() {
  {
    const std::lock_guard lock(mutex_);
    reads_.clear();
    done_.clear();
  }
  g_object_unref(handler_);
}

void MockDevice::send(const Buffer& packet) {
  const std::lock_guard lock(mutex_);
  packets_.push_back(packet);
  match();
}

void MockDevice::fail_next_read(int status) {
  const std::lock_guard lock(mutex_);
  fault_ = status;
  match();
}

void MockDevice::hang_writes(bool hangs) {
  const std::lock_guard lock(mutex_);
  hangs_ = hangs;
  tell_all();
}

void MockDevice::refuse_claims(int error) {
  const std::lock_guard lock(mutex_);
  refused_ = error;
}

void MockDevice::close_files() {
  const std::lock_guard lock(mutex_);
  claims_.clear();
  done_.clear();
  reads_.clear();
  writes_.clear();
}

void MockDevice::close_node() {
  constexpr mode_t kMarksACharacterDevice = S_ISVTX;  // to umockdev
  ::chmod((root_ + node_).c_str(), kMarksACharacterDevice);
}

bool MockDevice::without_force() {
  const std::lock_guard lock(mutex_);
  set_time(device_, steady_now());
  return test::without_force(device_);
}

bool MockDevice::kernel_has_it() {
  const std::lock_guard lock(mutex_);
  return driver_ == own_driver_ && claims_.empty();
}

int MockDevice::clears() {
  const std::lock_guard lock(mutex_);
  return clears_;
}

gboolean MockDevice::on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client,
                              gpointer self) {
  return static_cast<MockDevice*>(self)->answer(client);
}

void MockDevice::on_vanished(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client,
                             gpointer self) {
  auto& device = *static_cast<MockDevice*>(self);
  const std::lock_guard lock(device.mutex_);
  device.forget(client);
}

void MockDevice::forget(UMockdevIoctlClient* client) {
  done_.erase(client);
  std::erase_if(claims_, [client](const auto& claim) { return claim.second == client; });
  std::erase_if(reads_, [client](const Urb& urb) { return urb.client == client; });
  std::erase_if(writes_, [client](const Urb& urb) { return urb.client == client; });
}

gboolean MockDevice::answer(UMockdevIoctlClient* client) {
  const gulong request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  const std::lock_guard lock(mutex_);
  const bool reaps = request == USBDEVFS_REAPURBNDELAY || request == USBDEVFS_REAPURB ||
                     request == USBDEVFS_DISCARDURB;
  if (gone_ && !reaps) {
    return refused(client, ENODEV);
  }
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES: {
      const Data data(umockdev_ioctl_data_resolve(argument, 0, sizeof(guint32), nullptr));
      const guint32 capabilities = USBDEVFS_CAP_BULK_CONTINUATION |
                                   USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_ZERO_PACKET |
                                   USBDEVFS_CAP_BULK_SCATTER_GATHER |
                                   USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      std::memcpy(data->data, &capabilities, sizeof capabilities);
      return granted(client);
    }
    case USBDEVFS_GETDRIVER:
      return driver(client, argument);
    case USBDEVFS_IOCTL: {
      const Data data(umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_ioctl), nullptr));
      const auto* in = reinterpret_cast<const usbdevfs_ioctl*>(data->data);
      const bool detaches = in->ioctl_code == static_cast<int>(USBDEVFS_DISCONNECT);
      if (detaches && driver_.empty()) {
        return refused(client, ENODATA);
      }
      driver_ = detaches ? "" : own_driver_;
      show_driver(static_cast<unsigned>(in->ifno), driver_);
      return granted(client);
    }
    case USBDEVFS_DISCONNECT_CLAIM:
      return claim(client, argument, true);
    case USBDEVFS_CLAIMINTERFACE:
      return claim(client, argument, false);
    case USBDEVFS_RELEASEINTERFACE:
      return release(client, argument);
    case USBDEVFS_CLEAR_HALT:
      clears_ += 1;
      return granted(client);
    case USBDEVFS_SUBMITURB:
      return submit(client, argument);
    case USBDEVFS_BULK:
      return bulk(client, argument);
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY:
      return reap(client, argument);
    case USBDEVFS_DISCARDURB:
      return discard(client, argument);
    default:
      return granted(client);
  }
}

gboolean MockDevice::driver(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  // Whole at once: what is resolved once keeps its size.
  const Data data(umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_getdriver), nullptr));
  auto* out = reinterpret_cast<usbdevfs_getdriver*>(data->data);
  const bool claimed = claims_.contains(out->interface);
  if (!claimed && driver_.empty()) {
    return refused(client, ENODATA);
  }
  std::snprintf(out->driver, sizeof out->driver, "%s", claimed ? "usbfs" : driver_.c_str());
  return granted(client);
}

gboolean MockDevice::claim(UMockdevIoctlClient* client, UMockdevIoctlData* argument,
                           bool disconnect) {
  if (refused_ != 0) {
    return refused(client, refused_);
  }
  const unsigned interface = interface_in(argument);
  const auto held = claims_.find(interface);
  if ((held != claims_.end() && held->second != client) || (!disconnect && !driver_.empty())) {
    return refused(client, EBUSY);
  }
  driver_.clear();
  claims_[interface] = client;
  show_driver(interface, "usbfs");
  return granted(client);
}

gboolean MockDevice::release(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  const auto held = claims_.find(interface_in(argument));
  if (held == claims_.end() || held->second != client) {
    return refused(client, EINVAL);
  }
  show_driver(held->first, "");
  claims_.erase(held);
  return granted(client);
}

void MockDevice::finish(Urb urb, int status, Buffer bytes) {
  done_[urb.client].push_back({std::move(urb.data), status, std::move(bytes)});
}

void MockDevice::match() {
  while (!reads_.empty() && (fault_ || !packets_.empty())) {
    Urb urb = std::move(reads_.front());
    reads_.pop_front();
    if (fault_) {
      finish(std::move(urb), *std::exchange(fault_, std::nullopt));
    } else {
      finish(std::move(urb), 0, std::move(packets_.front()));
      packets_.pop_front();
    }
  }
}

bool MockDevice::may_use(UMockdevIoctlClient* client, std::uint8_t endpoint) const {
  for (const UsbInterface& interface : identity_of(device_).interfaces) {
    const bool has = std::ranges::any_of(interface.endpoints, [endpoint](const UsbEndpoint& one) {
      return one.address == endpoint;
    });
    const auto claim = claims_.find(interface.number);
    if (has && claim != claims_.end() && claim->second == client) {
      return true;
    }
  }
  return false;
}

/// A packet out, at once.
gboolean MockDevice::bulk(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  const Data data(umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_bulktransfer), nullptr));
  const auto* transfer = reinterpret_cast<const usbdevfs_bulktransfer*>(data->data);
  if (!may_use(client, static_cast<std::uint8_t>(transfer->ep))) {
    return refused(client, EBUSY);
  }
  const Data buffer(umockdev_ioctl_data_resolve(data.get(), offsetof(usbdevfs_bulktransfer, data),
                                                transfer->len, nullptr));
  if ((transfer->ep & kUsbIn) != 0 || hangs_) {
    return refused(client, ETIMEDOUT);
  }
  told(device_, Bytes(reinterpret_cast<const std::uint8_t*>(buffer->data), transfer->len));
  return complete(client, static_cast<int>(transfer->len), 0);
}

gboolean MockDevice::submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  Data data(umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr));
  const auto* urb = reinterpret_cast<const usbdevfs_urb*>(data->data);
  const auto size = static_cast<std::size_t>(urb->buffer_length);
  if (urb->type != USBDEVFS_URB_TYPE_CONTROL && !may_use(client, urb->endpoint)) {
    return refused(client, EBUSY);
  }
  // What is resolved belongs to `data`, which keeps it until it is reaped.
  const Data buffer(
      umockdev_ioctl_data_resolve(data.get(), offsetof(usbdevfs_urb, buffer), size, nullptr));
  const auto* bytes = buffer ? reinterpret_cast<const std::uint8_t*>(buffer->data) : nullptr;
  if (urb->type == USBDEVFS_URB_TYPE_CONTROL) {
    const UsbSetup setup = setup_of(bytes);
    const Bytes out((setup.type & kUsbIn) != 0 ? Bytes{}
                                               : Bytes(bytes + kSetupSize, size - kSetupSize));
    const auto in = controlled(device_, setup, out);
    finish({client, std::move(data)}, in ? 0 : -EPIPE, in.value_or(Buffer{}));
  } else if ((urb->endpoint & kUsbIn) != 0) {
    reads_.push_back({client, std::move(data)});
    match();
  } else {
    writes_.push_back({client, std::move(data)});
    tell_all();
  }
  return granted(client);
}

void MockDevice::tell_all() {
  while (!hangs_ && !writes_.empty()) {
    Urb urb = std::move(writes_.front());
    writes_.pop_front();
    const auto* request = reinterpret_cast<const usbdevfs_urb*>(urb.data->data);
    const auto size = static_cast<std::size_t>(request->buffer_length);
    set_time(device_, steady_now());
    Buffer in = told(device_, Bytes(static_cast<const std::uint8_t*>(request->buffer), size));
    finish(std::move(urb), 0);
    if (!in.empty()) {
      packets_.push_back(std::move(in));
      match();
    }
  }
}

gboolean MockDevice::reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  auto& queue = done_[client];
  if (queue.empty()) {
    return refused(client, gone_ ? ENODEV : EAGAIN);
  }
  const Done done = std::move(queue.front());
  queue.pop_front();
  auto* urb = reinterpret_cast<usbdevfs_urb*>(done.data->data);
  auto* buffer = static_cast<std::uint8_t*>(urb->buffer);
  const bool control = urb->type == USBDEVFS_URB_TYPE_CONTROL;
  const bool in = ((control ? buffer[0] : urb->endpoint) & kUsbIn) != 0;
  const std::size_t head = control ? kSetupSize : 0;
  const std::size_t room = static_cast<std::size_t>(urb->buffer_length) - head;
  const std::size_t size = in ? std::min(room, done.bytes.size()) : room;
  urb->status = done.status;
  if (in && !control && done.bytes.size() > room) {
    urb->status = -EOVERFLOW;
  }
  if (in) {
    std::copy_n(done.bytes.begin(), size, buffer + head);
  }
  urb->actual_length = done.status == 0 ? static_cast<int>(size) : 0;
  const Data pointer(umockdev_ioctl_data_resolve(argument, 0, sizeof(gpointer), nullptr));
  if (!pointer) {  // its process was killed in the middle of this, and nobody says that it vanished
    forget(client);
    return refused(client, EFAULT);
  }
  umockdev_ioctl_data_set_ptr(pointer.get(), 0, done.data.get());
  return granted(client);
}

gboolean MockDevice::discard(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  gulong address = 0;  // the argument is the client's own pointer to the transfer
  std::memcpy(&address, argument->data, sizeof address);
  for (std::deque<Urb>* const queue : {&reads_, &writes_}) {
    const auto found = std::ranges::find_if(*queue, [&](const Urb& urb) {
      return urb.client == client && urb.data->client_addr == address;
    });
    if (found != queue->end()) {
      finish(std::move(*found), -ENOENT);
      queue->erase(found);
      return granted(client);
    }
  }
  return refused(client, EINVAL);
}

MockDevice& MockUsb::plug(EmulatedDevice device, std::string driver) {
  const int number = 2 + static_cast<int>(devices_.size());
  devices_.push_back(
      std::make_unique<MockDevice>(bed_, number, std::move(device), std::move(driver)));
  devices_.back()->plug();
  return *devices_.back();
}

}  // namespace torsion::engine::test
