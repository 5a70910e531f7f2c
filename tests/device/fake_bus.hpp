#pragma once

// A bus of made-up devices with a clock of its own: the device loop over it runs the same every
// time, and a second takes as long as its events take to count.

#include <array>
#include <queue>
#include <random>
#include <vector>

#include "device/device_loop.hpp"
#include "tests/device/emulated_devices.hpp"

namespace torsion::engine::test {

inline constexpr double kStartTime = 0.5;  // s: by then a device that needs nobody is live

/// Where a wheel's full scale is known.
inline LoopOptions with_wheel_torque() {
  LoopOptions options;
  options.drivers.wheel_torque = EmulatedWheel{}.full_scale;
  options.drivers.wheel_range = EmulatedWheel{}.range;
  return options;
}

class FakeBus {
 public:
  explicit FakeBus(const LoopOptions& options, SampleSink sink) {
    loop_.options = options;
    loop_.sink = sink;
  }

  /// @return the row it got
  std::size_t plug(EmulatedDevice device);
  /// Pulled out: all that was under way ends with kGone, in the next tenth of a millisecond.
  void unplug(std::size_t row);
  /// What the session does when it closes a device.
  void rest(std::size_t row);

  void run_until(double time);
  void run(double seconds) { run_until(now_ + seconds); }

  /// The device sends this on its IN endpoint, besides what it says when told something.
  void send(std::size_t row, const Buffer& packet);
  /// The next read ends like this.
  void fail_next_read(std::size_t row, UsbStatus status) { devices_[row].fault = status; }
  /// The OUT endpoint stalls until its halt is cleared.
  void halt_writes(std::size_t row) { devices_[row].halted_out = true; }
  /// The device does not answer any more.
  void silence(std::size_t row, bool silent) { devices_[row].silent = silent; }
  /// What becomes of the device's next answer: bits that are turned over at random, or the packet
  /// is lost or comes twice.
  void spoil_next_answer(std::size_t row, std::uint32_t flips, bool lose, bool twice);
  /// The next packet to the device does not get there, though its transfer ends well.
  void lose_next_write(std::size_t row) { devices_[row].loses_write = true; }
  /// The most that its motors were ever told, of what they may be.
  [[nodiscard]] double most_pushed(std::size_t row) const { return devices_[row].most_pushed; }
  /// Without power for a moment.
  void brown_out(std::size_t row);
  /// What a person does so that it knows its zero.
  void make_ready(std::size_t row);
  /// Claims end like this from now on.
  void claims(std::size_t row, UsbStatus status) { devices_[row].claim = status; }

  [[nodiscard]] double now() const { return now_; }
  [[nodiscard]] DeviceLoop& loop() { return loop_; }
  EmulatedDevice& device(std::size_t row) { return devices_[row].device; }
  template <class T>
  T& device(std::size_t row) {
    return std::get<T>(devices_[row].device);
  }
  /// s: how long the motors of the device have held nothing; 0 where they hold something.
  [[nodiscard]] double without_force_for(std::size_t row) const;
  [[nodiscard]] std::uint64_t writes(std::size_t row) const { return devices_[row].writes; }

 private:
  struct Plugged {
    EmulatedDevice device;
    bool here = false;
    std::uint32_t generation = 0;
    std::uint32_t reads = 0;  // waiting
    std::uint8_t read_endpoint = 0;
    std::vector<Buffer> waiting;  // packets that no read has fetched
    bool halted_out = false;
    std::optional<UsbStatus> fault;
    bool silent = false;
    std::uint32_t flips = 0;
    bool loses_answer = false;
    bool doubles_answer = false;
    bool loses_write = false;
    double most_pushed = 0.0;
    UsbStatus claim = UsbStatus::kCompleted;
    double let_go_at = 0.0;  // s: since when the motors hold nothing
    std::uint64_t writes = 0;
  };
  struct Due {
    double time = 0.0;
    std::uint64_t order = 0;
    std::size_t row = 0;
    std::uint32_t generation = 0;
    UsbEvent event;  // without its bytes
    Buffer bytes;
    bool arrives = false;  // the device's answer gets to the bus: not yet the end of a read
    bool detaches = false;
    bool operator>(const Due& other) const {
      return time != other.time ? time > other.time : order > other.order;
    }
  };

  void schedule(std::size_t row, double delay, Due due);
  void execute(std::size_t row, const UsbRequests& requests);
  void execute_one(std::size_t row, const UsbRequest& request);
  void match(std::size_t row);
  void answer(std::size_t row, Buffer packet);
  void happen(const Due& due);

  DeviceLoop loop_;
  std::array<Plugged, kMostDevices> devices_;
  std::priority_queue<Due, std::vector<Due>, std::greater<>> queue_;
  std::uint64_t order_ = 0;
  double now_ = 1.0;
  std::mt19937 random_{1};
};

}  // namespace torsion::engine::test
