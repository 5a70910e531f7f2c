#include "device/usb/usb_bus.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include <libusb-1.0/libusb.h>

#include "device/steady_clock.hpp"
#include "device/usb/release_process.hpp"
#include "device/usb/usb_keeper.hpp"

namespace torsion::engine {
namespace {

constexpr double kLongestWait = 0.1;  // s: nothing of ours is missed, this is for what is not ours
constexpr double kReopen = 1.0;       // s: after an open that was not allowed
constexpr double kLookAgain = 0.1;    // s
constexpr std::uint32_t kMostLooks = 50;
constexpr double kLetGoTime = 0.1;     // s: for the last packets when the bus is stopped
constexpr double kLongestClose = 3.0;  // s: a transfer that never comes back is left to the system

}  // namespace

struct UsbBus::State {
  libusb_context* context = nullptr;
  libusb_hotplug_callback_handle hotplug = 0;
  DeviceLoop loop;
  std::function<void()> on_start;
  std::array<UsbPort, kMostDevices> ports;
  std::vector<libusb_device*> came;  // with references
  std::vector<libusb_device*> left;  // only to compare with
  std::vector<KeeperJob> done;
  std::unique_ptr<UsbKeeper> keeper;
  std::unique_ptr<ReleaseProcess> release;  // null: the system makes no process
  std::atomic<bool> stop = false;
  std::atomic<std::uint64_t> submits_after_loss = 0;
  double stop_at = kNever;     // s: when the devices are closed
  double give_up_at = kNever;  // s: when the thread ends whatever is still open
  std::thread thread;

  void ask(UsbPort& port, KeeperTask task, const UsbRequest& request = {}) const {
    port.jobs += 1;
    keeper->ask({task, &port, request, UsbStatus::kCompleted});
  }

  /// The device is not used any more: the loop forgets it, its transfers end.
  void lose(UsbPort& port) {
    if (port.looked_after) {
      port.looked_after = false;
      release->forget(port.row);
    }
    if (port.attached) {
      port.attached = false;
      detach(loop, port.row, steady_now());
    }
    if (port.state == UsbPortState::kOpen || port.state == UsbPortState::kRefused) {
      port.state = UsbPortState::kClosing;
    }
  }

  void execute(UsbPort& port, const UsbRequests& requests) {
    for (std::size_t i = 0; i < requests.count && port.state == UsbPortState::kOpen; ++i) {
      const UsbRequest& request = requests.rows[i];
      switch (request.job) {
        case UsbJob::kClaim:
          ask(port, KeeperTask::kClaim, request);
          break;
        case UsbJob::kRelease:
          ask(port, KeeperTask::kRelease, request);
          break;
        case UsbJob::kClearHalt:
          ask(port, KeeperTask::kClearHalt, request);
          break;
        default:
          if (!submit(port, request)) {
            submits_after_loss.fetch_add(1, std::memory_order_relaxed);
            lose(port);
          }
          break;
      }
    }
  }

  /// From when a device is live until it is lost, another process knows how to let go of it.
  void look_after(UsbPort& port) {
    const DeviceRow& device = loop.rows[port.row];
    if (port.looked_after || !release || device.report.sample.state != DeviceState::kLive) {
      return;
    }
    port.looked_after = true;
    UsbRequests last;
    plan_rest(loop, port.row, steady_now(), last);
    release->look_after(port.row, port.identity, last);
  }

  void deliver(UsbPort& port, const UsbEvent& event) {
    if (!port.attached || port.state != UsbPortState::kOpen) {
      return;
    }
    UsbRequests requests;
    take(loop, port.row, event, steady_now(), requests);
    execute(port, requests);
    if (port.attached) {
      look_after(port);
    }
  }

  static void LIBUSB_CALL on_transfer(libusb_transfer* usb) {
    auto& transfer = *static_cast<UsbTransfer*>(usb->user_data);
    UsbPort& port = *transfer.port;
    auto& state = *static_cast<State*>(port.owner);
    const UsbEvent event = event_of(transfer);
    port.under_way -= 1;
    port.to_device -= event.job == UsbJob::kRead ? 0U : 1U;
    if (event.status == UsbStatus::kGone) {
      state.lose(port);
    } else {
      state.deliver(port, event);  // the buffer is the event's until here
    }
    transfer.under_way = false;
  }

  static int LIBUSB_CALL on_hotplug(libusb_context* /*context*/, libusb_device* device,
                                    libusb_hotplug_event event, void* self) {
    auto& state = *static_cast<State*>(self);
    if (event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED) {
      state.came.push_back(libusb_ref_device(device));  // nothing that blocks is allowed here
    } else {
      state.left.push_back(device);
    }
    return 0;
  }

  void take_hotplug() {
    for (libusb_device* device : left) {
      for (UsbPort& port : ports) {
        if (port.state != UsbPortState::kFree && port.device == device) {
          port.left = true;
          lose(port);
        }
      }
    }
    left.clear();
    std::vector<libusb_device*> waiting;
    for (libusb_device* device : came) {
      auto* const free = std::ranges::find(ports, UsbPortState::kFree, &UsbPort::state);
      if (stop || free == ports.end()) {
        waiting.push_back(device);  // until a port is free
        continue;
      }
      free->device = device;
      free->state = UsbPortState::kOpening;
      ask(*free, KeeperTask::kOpen);
    }
    came.swap(waiting);
  }

  void opened(UsbPort& port, UsbStatus status) {
    constexpr std::uint32_t kWheels = 1U << static_cast<std::uint32_t>(DeviceKind::kWheel);
    const bool may_be_wheel = status == UsbStatus::kTimedOut && (loop.options.kinds & kWheels) != 0;
    if (may_be_wheel && !port.left && !stop && port.looks < kMostLooks) {
      // Just plugged in: what it is will be known once the kernel has read its descriptors.
      port.looks += 1;
      port.state = UsbPortState::kRefused;
      port.retry_at = steady_now() + kLookAgain;
      return;
    }
    const bool useless = status == UsbStatus::kTimedOut || status == UsbStatus::kCancelled ||
                         status == UsbStatus::kGone;
    if (useless || port.left || stop) {
      port.state = UsbPortState::kClosing;
      return;
    }
    if (port.attached) {
      port.attached = false;
      detach(loop, port.row, steady_now());  // it was known as refused
    }
    const std::size_t row = free_row(loop);
    TORSION_ASSERT(row < kMostDevices);  // there are as many ports
    port.row = row;
    port.attached = true;
    const DeviceKind kind = kind_of(port.identity).value_or(DeviceKind::kSpaceMouse);
    if (status != UsbStatus::kCompleted) {
      port.state = UsbPortState::kRefused;
      port.retry_at = steady_now() + kReopen;
      torsion::engine::refuse(loop, row, port.identity, kind,
                              status == UsbStatus::kNoAccess ? DeviceTrouble::kNoAccess
                                                             : DeviceTrouble::kHeldElsewhere);
      return;
    }
    port.state = UsbPortState::kOpen;
    prepare_port(port, on_transfer);
    UsbRequests requests;
    attach(loop, row, port.identity, kind, steady_now(), requests);
    execute(port, requests);
  }

  static void closed(UsbPort& port) {
    free_transfers(port);
    port.looks = 0;
    libusb_unref_device(port.device);
    port.device = nullptr;
    port.state = UsbPortState::kFree;
    port.cancelled = false;
    port.left = false;
    port.refused.clear();
  }

  void take_done() {
    keeper->take_done(done);
    for (const KeeperJob& job : done) {
      UsbPort& port = *job.port;
      port.jobs -= 1;
      if (job.task == KeeperTask::kOpen) {
        opened(port, job.status);
      } else if (job.task == KeeperTask::kClose) {
        closed(port);
      } else if (job.status == UsbStatus::kGone && job.task != KeeperTask::kRelease) {
        lose(port);
      } else {
        UsbEvent event;
        event.job = job.request.job;
        event.endpoint = job.request.endpoint;
        event.interface = job.request.interface;
        event.status = job.status;
        deliver(port, event);
      }
    }
    done.clear();
  }

  void take_refused(UsbPort& port) {
    std::vector<UsbEvent> refused;
    refused.swap(port.refused);
    for (const UsbEvent& event : refused) {
      deliver(port, event);
    }
  }

  void tend(UsbPort& port, double now) {
    if (!port.refused.empty()) {
      take_refused(port);
    }
    if (port.state == UsbPortState::kOpen && loop.rows[port.row].report.wake_at <= now) {
      UsbRequests requests;
      wake(loop, port.row, now, requests);
      execute(port, requests);
    }
    if (port.state == UsbPortState::kRefused && port.retry_at <= now) {
      port.state = UsbPortState::kOpening;
      ask(port, KeeperTask::kOpen);
    }
    if (port.state != UsbPortState::kClosing) {
      return;
    }
    if (!port.cancelled) {
      port.cancelled = true;
      cancel_all(port);
    }
    if (port.under_way == 0 && port.jobs == 0) {
      ask(port, KeeperTask::kClose);
    }
  }

  /// The bus is to stop: first all let go, then all are closed.
  /// @return true when nothing is open any more
  bool close_down(double now) {
    if (stop_at == kNever) {
      stop_at = now + kLetGoTime;
      give_up_at = now + kLongestClose;
      for (UsbPort& port : ports) {
        if (port.state == UsbPortState::kOpen) {
          UsbRequests requests;
          rest(loop, port.row, now, requests);
          execute(port, requests);
        }
      }
    }
    const bool said =
        std::ranges::all_of(ports, [](const UsbPort& port) { return port.to_device == 0; });
    if (said || now >= stop_at) {
      for (UsbPort& port : ports) {
        lose(port);
      }
    }
    return now >= give_up_at || std::ranges::all_of(ports, [](const UsbPort& port) {
             return port.state == UsbPortState::kFree;
           });
  }

  void wait_for_events(double now) const {
    const double until = std::min(next_wake(loop), now + (stop ? 1e-3 : kLongestWait));
    const auto microseconds =
        static_cast<std::int64_t>(1e6 * std::clamp(until - now, 0.0, kLongestWait));
    timeval timeout{0, static_cast<suseconds_t>(microseconds)};
    libusb_handle_events_timeout_completed(context, &timeout, nullptr);
  }

  void run() {
    if (on_start) {
      on_start();
    }
    libusb_hotplug_register_callback(
        context, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
        LIBUSB_HOTPLUG_ENUMERATE, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
        LIBUSB_HOTPLUG_MATCH_ANY, on_hotplug, this, &hotplug);
    while (true) {
      take_hotplug();
      take_done();
      const double now = steady_now();
      for (UsbPort& port : ports) {
        tend(port, now);
      }
      if (stop && close_down(now)) {
        break;
      }
      wait_for_events(now);
    }
    libusb_hotplug_deregister_callback(context, hotplug);
    for (libusb_device* device : came) {
      libusb_unref_device(device);
    }
  }
};

UsbBus::UsbBus(std::unique_ptr<State> state) : state_(std::move(state)) {}

Result<std::unique_ptr<UsbBus>> UsbBus::start(const UsbBusOptions& options, SampleSink sink) {
  auto state = std::make_unique<State>();
  state->release = ReleaseProcess::start();  // before there are threads and open devices
  const int error = libusb_init(&state->context);
  if (error != 0) {
    return Error{std::string("USB cannot be used: ") + libusb_strerror(error)};
  }
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0) {
    libusb_exit(state->context);
    return Error{"USB cannot be used: this libusb does not say when devices come and go"};
  }
  state->loop.options = options.loop;
  state->loop.sink = sink;
  state->on_start = options.on_start;
  for (UsbPort& port : state->ports) {
    port.owner = state.get();
  }
  State* const raw = state.get();
  const std::uint32_t kinds = options.loop.kinds;
  state->keeper = std::make_unique<UsbKeeper>(
      [kinds](const UsbIdentity& identity) {
        const auto kind = kind_of(identity);
        return kind && (kinds >> static_cast<std::uint32_t>(*kind) & 1U) != 0;
      },
      [raw] { libusb_interrupt_event_handler(raw->context); });
  state->thread = std::thread([raw] { raw->run(); });
  return std::unique_ptr<UsbBus>(new UsbBus(std::move(state)));
}

UsbBus::~UsbBus() {
  state_->stop = true;
  libusb_interrupt_event_handler(state_->context);
  state_->thread.join();
  state_->keeper.reset();
  state_->release.reset();  // all have been let go of
  const bool all_back =
      std::ranges::all_of(state_->ports, [](const UsbPort& port) { return port.under_way == 0; });
  if (!all_back) {
    // The system may still write into these buffers: they stay until the program ends.
    static_cast<void>(state_.release());
    return;
  }
  for (UsbPort& port : state_->ports) {
    if (port.state != UsbPortState::kFree) {  // the thread gave up before it was closed
      close_handle(port);
      State::closed(port);
    }
  }
  libusb_exit(state_->context);
}

std::uint64_t UsbBus::submits_after_loss() const {
  return state_->submits_after_loss.load(std::memory_order_relaxed);
}

}  // namespace torsion::engine
