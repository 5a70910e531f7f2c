#include "device/drivers/driver.hpp"

#include <algorithm>
#include <utility>

namespace torsion::engine {
namespace {

constexpr std::uint32_t kReadsUnderWay = 2;
constexpr std::uint32_t kMostFailures = 10;  // in a row
constexpr double kRateMemory = 0.02;         // share of one sample's interval in the mean
constexpr double kDelayMemory = 0.02;        // likewise of one write
constexpr double kRetry = 0.5;               // s

}  // namespace

Wrench publish_pose(DriverCall& call, const Pose& pose, std::uint32_t buttons) {
  DeviceSample& sample = call.report.sample;
  const double interval = call.now - sample.time;
  if (sample.number > 0 && interval > 0.0) {
    const double mean = sample.rate > 0.0 ? 1.0 / sample.rate : interval;
    sample.rate = 1.0 / (mean + kRateMemory * (interval - mean));
  }
  sample.pose = pose;
  sample.buttons = buttons;
  sample.time = call.now;
  sample.number += 1;
  const Wrench wrench = call.sink.on_sample(call.sink.context, sample);
  return sample.state == DeviceState::kLive ? wrench : Wrench{};
}

void set_state(DriverCall& call, DeviceState state, DeviceTrouble trouble) {
  DeviceSample& sample = call.report.sample;
  if (sample.state == state && sample.trouble == trouble) {
    return;
  }
  sample.epoch += state == DeviceState::kLive && sample.state != state ? 1U : 0U;
  sample.state = state;
  sample.trouble = trouble;
  if (state != DeviceState::kLive) {
    call.sink.on_sample(call.sink.context, sample);  // a live one is heard of with its first pose
  }
}

void retry_later(DriverCall& call, DeviceTrouble trouble) {
  set_state(call, DeviceState::kStarting, trouble);
  call.report.wake_at = call.now + kRetry;
}

void retry_claim(DriverCall& call, const UsbEvent& claim) {
  retry_later(call, claim.status == UsbStatus::kNoAccess ? DeviceTrouble::kNoAccess
                                                         : DeviceTrouble::kHeldElsewhere);
}

const UsbEndpoint* find_endpoint(const UsbInterface& interface, UsbEndpointKind kind,
                                 std::uint8_t direction) {
  const auto found = std::ranges::find_if(interface.endpoints, [&](const UsbEndpoint& endpoint) {
    return endpoint.kind == kind && (endpoint.address & kUsbIn) == direction;
  });
  return found != interface.endpoints.end() ? &*found : nullptr;
}

void write_through(WriteGate& gate, DriverCall& call, Bytes packet, bool may_take_long) {
  if (!gate.under_way) {
    write_usb(call.requests, gate.endpoint, packet, may_take_long);
    gate.under_way = true;
    gate.asked_at = call.now;
  }
}

bool let_go_through(WriteGate& gate, DriverCall& call, Bytes packet) {
  gate.let_go_after = gate.under_way;
  write_through(gate, call, packet);
  return !gate.let_go_after;
}

void write_last(WriteGate& gate, DriverCall& call, Bytes packet) {
  gate.under_way = false;
  write_through(gate, call, packet);
}

bool take_write(WriteGate& gate, DriverCall& call, const UsbEvent& event) {
  gate.under_way = false;
  if (event.status == UsbStatus::kStall) {
    // Until it is cleared nothing gets out, and no packet without force either.
    call.report.counts.stalls += 1;
    clear_usb_halt(call.requests, gate.endpoint);
    gate.let_go_after = false;
    return true;
  }
  call.report.counts.failures += event.status == UsbStatus::kCompleted ? 0U : 1U;
  DeviceSample& sample = call.report.sample;
  if (event.status == UsbStatus::kCompleted && sample.state == DeviceState::kLive) {
    // The force goes out as soon as its sample has come: it is as late as its way out takes.
    const double late = call.now - gate.asked_at;
    sample.traits.delay += kDelayMemory * (late - sample.traits.delay);
  }
  return std::exchange(gate.let_go_after, false) && event.status != UsbStatus::kGone;
}

void keep_reading(ReadQueue& queue, DriverCall& call) {
  while (queue.under_way < kReadsUnderWay) {
    read_usb(call.requests, queue.endpoint, queue.length);
    queue.under_way += 1;
  }
}

ReadOutcome take_read(ReadQueue& queue, DriverCall& call, const UsbEvent& event) {
  if (event.endpoint != queue.endpoint) {
    return ReadOutcome::kNothing;
  }
  if (event.job == UsbJob::kClearHalt) {
    if (event.status != UsbStatus::kCompleted) {
      return ReadOutcome::kBroken;
    }
    keep_reading(queue, call);
    return ReadOutcome::kNothing;
  }
  if (event.job != UsbJob::kRead) {
    return ReadOutcome::kNothing;
  }
  queue.under_way -= std::min(queue.under_way, 1U);
  switch (event.status) {
    case UsbStatus::kCompleted:
      queue.failures = 0;
      return ReadOutcome::kData;
    case UsbStatus::kStall:
      call.report.counts.stalls += 1;
      break;
    case UsbStatus::kCancelled:
    case UsbStatus::kGone:
      return ReadOutcome::kNothing;
    default:
      call.report.counts.failures += 1;
      break;
  }
  queue.failures += 1;
  if (queue.failures > kMostFailures) {
    return ReadOutcome::kBroken;
  }
  if (event.status == UsbStatus::kStall) {
    clear_usb_halt(call.requests, queue.endpoint);
  } else {
    keep_reading(queue, call);
  }
  return ReadOutcome::kNothing;
}

}  // namespace torsion::engine
