#include "tests/device/fake_bus.hpp"

#include <algorithm>
#include <utility>

namespace torsion::engine::test {
namespace {

constexpr double kSoon = 1e-4;           // s: a transfer's end
constexpr double kControl = 1e-3;        // s: a control's
constexpr double kControlTimeout = 0.5;  // s
constexpr double kAnswer = 8e-4;         // s: from a packet to the device's answer

}  // namespace

std::size_t FakeBus::plug(EmulatedDevice device) {
  const std::size_t row = free_row(loop_);
  Plugged& plugged = devices_[row];
  const std::uint32_t generation = plugged.generation + 1;
  plugged = {};
  plugged.device = std::move(device);
  plugged.here = true;
  plugged.generation = generation;
  plugged.let_go_at = now_;
  const UsbIdentity identity = identity_of(plugged.device);
  UsbRequests requests;
  attach(loop_, row, identity, *kind_of(identity), now_, requests);
  execute(row, requests);
  return row;
}

void FakeBus::unplug(std::size_t row) {
  Plugged& plugged = devices_[row];
  plugged.here = false;
  plugged.generation += 1;  // nothing that was under way ends otherwise
  for (; plugged.reads > 0; --plugged.reads) {
    Due due;
    due.event.endpoint = plugged.read_endpoint;
    due.event.status = UsbStatus::kGone;
    schedule(row, kSoon, due);
  }
  Due due;
  due.detaches = true;
  schedule(row, 2.0 * kSoon, due);
}

void FakeBus::rest(std::size_t row) {
  UsbRequests requests;
  torsion::engine::rest(loop_, row, now_, requests);
  execute(row, requests);
}

void FakeBus::send(std::size_t row, const Buffer& packet) {
  Due due;
  due.arrives = true;
  due.bytes = packet;
  schedule(row, kSoon, due);
}

double FakeBus::without_force_for(std::size_t row) const {
  return without_force(devices_[row].device) ? now_ - devices_[row].let_go_at : 0.0;
}

void FakeBus::schedule(std::size_t row, double delay, Due due) {
  due.time = now_ + delay;
  due.order = order_++;
  due.row = row;
  due.generation = devices_[row].generation;
  queue_.push(std::move(due));
}

void FakeBus::execute(std::size_t row, const UsbRequests& requests) {
  for (std::size_t i = 0; i < requests.count; ++i) {
    execute_one(row, requests.rows[i]);
  }
}

void FakeBus::execute_one(std::size_t row, const UsbRequest& request) {
  Plugged& plugged = devices_[row];
  set_time(plugged.device, now_);
  Due due;
  due.event.job = request.job;
  due.event.endpoint = request.endpoint;
  due.event.interface = request.interface;
  due.event.setup = request.setup;
  if (!plugged.here) {
    due.event.status = UsbStatus::kGone;  // a bus refuses at once, and the driver hears of it
    schedule(row, 0.0, due);
    return;
  }
  switch (request.job) {
    case UsbJob::kRead:
      plugged.reads += 1;
      plugged.read_endpoint = request.endpoint;
      match(row);
      return;
    case UsbJob::kWrite: {
      plugged.writes += 1;
      if (plugged.halted_out) {
        due.event.status = UsbStatus::kStall;
        schedule(row, kSoon, due);
        return;
      }
      if (std::exchange(plugged.loses_write, false)) {
        schedule(row, kSoon, due);
        return;
      }
      const bool before = without_force(plugged.device);
      const Buffer said = told(plugged.device, request.data());
      if (!before || !without_force(plugged.device)) {
        plugged.let_go_at = now_;
      }
      plugged.most_pushed = std::max(plugged.most_pushed, share_pushed(plugged.device));
      schedule(row, kSoon, due);
      if (!said.empty() && !plugged.silent) {
        answer(row, said);
      }
      return;
    }
    case UsbJob::kControl: {
      if (plugged.silent) {
        due.event.status = UsbStatus::kTimedOut;
        schedule(row, kControlTimeout, due);
        return;
      }
      const auto answer = controlled(plugged.device, request.setup,
                                     (request.setup.type & kUsbIn) != 0 ? Bytes{} : request.data());
      due.event.status = answer ? UsbStatus::kCompleted : UsbStatus::kStall;
      due.bytes = answer.value_or(Buffer{});
      schedule(row, kControl, due);
      return;
    }
    case UsbJob::kClearHalt:
      plugged.halted_out = plugged.halted_out && (request.endpoint & kUsbIn) != 0;
      schedule(row, kSoon, due);
      return;
    case UsbJob::kClaim:
      schedule(row, kControl, due);
      return;
    default:
      schedule(row, kSoon, due);
      return;
  }
}

void FakeBus::spoil_next_answer(std::size_t row, std::uint32_t flips, bool lose, bool twice) {
  devices_[row].flips = flips;
  devices_[row].loses_answer = lose;
  devices_[row].doubles_answer = twice;
}

void FakeBus::brown_out(std::size_t row) {
  if (!without_force(devices_[row].device)) {
    devices_[row].let_go_at = now_;
  }
  test::brown_out(devices_[row].device);
}

void FakeBus::make_ready(std::size_t row) {
  if (auto* const falcon = std::get_if<EmulatedFalcon>(&devices_[row].device)) {
    falcon->homed = true;
  }
}

void FakeBus::answer(std::size_t row, Buffer packet) {
  Plugged& plugged = devices_[row];
  for (; plugged.flips > 0; --plugged.flips) {
    const std::size_t bit = random_() % (8 * packet.size());
    packet[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
  const int times = plugged.loses_answer ? 0 : plugged.doubles_answer ? 2 : 1;
  plugged.loses_answer = false;
  plugged.doubles_answer = false;
  for (int i = 0; i < times; ++i) {
    Due arrival;
    arrival.arrives = true;
    arrival.bytes = packet;
    schedule(row, kAnswer, arrival);
  }
}

void FakeBus::match(std::size_t row) {
  Plugged& plugged = devices_[row];
  while (plugged.reads > 0 && (!plugged.waiting.empty() || plugged.fault)) {
    Due due;
    due.event.endpoint = plugged.read_endpoint;
    if (plugged.fault) {
      due.event.status = *plugged.fault;
      plugged.fault.reset();
    } else {
      due.bytes = plugged.waiting.front();
      plugged.waiting.erase(plugged.waiting.begin());
    }
    plugged.reads -= 1;
    schedule(row, 0.0, due);
  }
}

void FakeBus::happen(const Due& due) {
  if (due.generation != devices_[due.row].generation) {
    return;  // it was pulled out since
  }
  if (due.detaches) {
    detach(loop_, due.row, now_);
    return;
  }
  if (due.arrives) {
    devices_[due.row].waiting.push_back(due.bytes);
    match(due.row);
    return;
  }
  UsbEvent event = due.event;
  event.bytes = due.bytes;
  if (event.job == UsbJob::kClaim && event.status == UsbStatus::kCompleted) {
    event.status = devices_[due.row].claim;
  }
  UsbRequests requests;
  take(loop_, due.row, event, now_, requests);
  execute(due.row, requests);
}

void FakeBus::run_until(double time) {
  while (true) {
    const double wake_at = next_wake(loop_);
    const double next_event = queue_.empty() ? kNever : queue_.top().time;
    const double next = std::min(wake_at, next_event);
    if (next > time) {
      break;
    }
    now_ = std::max(now_, next);
    if (next_event <= wake_at) {
      const Due due = queue_.top();
      queue_.pop();
      happen(due);
      continue;
    }
    for (std::size_t row = 0; row < kMostDevices; ++row) {
      if (loop_.rows[row].used && loop_.rows[row].report.wake_at <= now_) {
        UsbRequests requests;
        wake(loop_, row, now_, requests);
        execute(row, requests);
      }
    }
  }
  now_ = time;
  for (Plugged& plugged : devices_) {
    set_time(plugged.device, now_);
  }
}

}  // namespace torsion::engine::test
