#include "device/device_loop.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "ecs/assert.hpp"

namespace torsion::engine {
namespace {

constexpr double kOldWrench = 2e-3;  // s: a part does not display a wrench older than this

/// What a driver's samples come to: the row they belong to.
struct RowContext {
  DeviceLoop& loop;
  std::size_t row;
};

bool translates(DeviceRole role) {
  return role == DeviceRole::kTranslation || role == DeviceRole::kTranslationAndRotation;
}

bool turns(DeviceRole role) {
  return role == DeviceRole::kRotation || role == DeviceRole::kTranslationAndRotation;
}

/// One that works, or will without anybody's help.
bool counts(const DeviceRow& row) {
  switch (row.report.sample.trouble) {
    case DeviceTrouble::kNoAccess:
    case DeviceTrouble::kHeldElsewhere:
    case DeviceTrouble::kNoFirmware:
    case DeviceTrouble::kBadFirmware:
    case DeviceTrouble::kWrongFirmware:
    case DeviceTrouble::kNotUnderstood:
      return false;
    default:
      return row.used;
  }
}

DeviceRow* first_of(DeviceLoop& loop, DeviceKind kind) {
  auto* const found = std::ranges::find_if(
      loop.rows, [kind](const DeviceRow& row) { return counts(row) && row.kind == kind; });
  return found != loop.rows.end() ? &*found : nullptr;
}

/// Several Falcons carry the tool.
std::size_t carry_with_falcons(DeviceLoop& loop) {
  std::size_t count = 0;
  for (DeviceRow& row : loop.rows) {
    if (counts(row) && row.kind == DeviceKind::kFalcon && count < kMostPoints) {
      row.role = DeviceRole::kPoint;
      row.point = count++;
    }
  }
  if (count >= 2) {
    loop.carried = carried_at(count, loop.options.spacing);
  }
  return count;
}

/// Who does what: a device with force translates before one without, a knob turns, and what is
/// left that can turn turns.
void give_roles(DeviceLoop& loop) {
  for (DeviceRow& row : loop.rows) {
    row.role = DeviceRole::kNone;
  }
  loop.carried.count = 0;
  if (carry_with_falcons(loop) < 2) {
    DeviceRow* const falcon = first_of(loop, DeviceKind::kFalcon);
    DeviceRow* const wooden = first_of(loop, DeviceKind::kWoodenHaptics);
    DeviceRow* const mouse = first_of(loop, DeviceKind::kSpaceMouse);
    DeviceRow* const odrive = first_of(loop, DeviceKind::kOdrive);
    DeviceRow* const moteus = first_of(loop, DeviceKind::kMoteus);
    DeviceRow* const wheel = first_of(loop, DeviceKind::kWheel);
    DeviceRow* const knob = odrive != nullptr ? odrive : moteus != nullptr ? moteus : wheel;
    DeviceRow* const mover = falcon != nullptr ? falcon : wooden;
    if (mover != nullptr) {
      mover->role = DeviceRole::kTranslation;
    }
    if (mouse != nullptr) {
      mouse->role = mover != nullptr ? DeviceRole::kRotation : DeviceRole::kTranslationAndRotation;
    }
    if (knob != nullptr) {
      knob->role = DeviceRole::kKnob;
    }
  }
}

/// State and trouble of all parts: live when every one is.
void compose_state(const DeviceLoop& loop, DeviceSample& whole) {
  whole.state = DeviceState::kAbsent;
  whole.trouble = DeviceTrouble::kNone;
  bool any = false;
  bool all_live = true;
  for (const DeviceRow& row : loop.rows) {
    if (!row.used) {
      continue;
    }
    const DeviceSample& sample = row.report.sample;
    if (row.role != DeviceRole::kNone) {
      any = true;
      all_live = all_live && sample.state == DeviceState::kLive;
    }
    if (whole.trouble == DeviceTrouble::kNone && sample.trouble != DeviceTrouble::kNone) {
      whole.trouble = sample.trouble;
      whole.motor_errors = sample.motor_errors;
      whole.motor = sample.motor;
    }
    whole.state = DeviceState::kStarting;
  }
  if (any && all_live) {
    whole.state = DeviceState::kLive;
  }
}

/// What its driver says, and in the place of that what was measured.
DeviceTraits traits_of(const DeviceLoop& loop, const DeviceRow& row) {
  DeviceTraits traits = row.report.sample.traits;
  const MeasuredTraits& measured = loop.options.measured[static_cast<std::size_t>(row.kind)];
  const auto replace = [](double& said, double found) {
    said = found > 0.0 ? found : said;
  };
  replace(traits.mass, measured.mass);
  replace(traits.damping, measured.damping);
  replace(traits.inertia, measured.inertia);
  replace(traits.turn_damping, measured.turn_damping);
  replace(traits.weight, measured.weight);
  traits.delay = std::max(traits.delay, measured.delay);
  return traits;
}

void add_traits(DeviceTraits& whole, const DeviceLoop& loop, const DeviceRow& row) {
  const DeviceTraits part = traits_of(loop, row);
  whole.thermal_time = whole.thermal_time > 0.0 ? std::min(whole.thermal_time, part.thermal_time)
                                                : part.thermal_time;
  if (translates(row.role)) {
    whole.damping = part.damping;
    whole.mass = part.mass;
    whole.weight = part.weight;
    whole.encoder_step = part.encoder_step;
    whole.largest_force = part.largest_force;
    whole.continuous_force = part.continuous_force;
    whole.delay = part.delay;
    whole.largest_stiffness = part.largest_stiffness;
  }
  if (turns(row.role) || row.role == DeviceRole::kKnob) {
    whole.encoder_turn_step = std::max(whole.encoder_turn_step, part.encoder_turn_step);
    whole.largest_torque = std::max(whole.largest_torque, part.largest_torque);
    whole.continuous_torque = std::max(whole.continuous_torque, part.continuous_torque);
    whole.turn_damping = part.turn_damping;
    whole.inertia = part.inertia;
    whole.delay = std::max(whole.delay, part.delay);
  }
}

void compose_points(const DeviceLoop& loop, DeviceSample& whole) {
  std::array<glm::dvec3, kMostPoints> places{};
  for (const DeviceRow& row : loop.rows) {
    if (row.used && row.role == DeviceRole::kPoint) {
      places[row.point] = row.report.sample.pose.position;
      whole.traits.largest_force += row.report.sample.traits.largest_force;
      whole.traits.continuous_force += row.report.sample.traits.continuous_force;
      whole.traits.encoder_step = row.report.sample.traits.encoder_step;
      whole.traits.delay = std::max(whole.traits.delay, traits_of(loop, row).delay);
    }
  }
  whole.pose = carried_pose(loop.carried, std::span(places).first(loop.carried.count));
  whole.sensed = kTranslationAxes | kRotationAxes;
  whole.actuated = whole.sensed;
  // A couple of two of them, N m.
  const double one = whole.traits.largest_force / static_cast<double>(loop.carried.count);
  whole.traits.largest_torque = one * loop.options.spacing;
  whole.traits.continuous_torque = whole.traits.continuous_force /
                                   static_cast<double>(loop.carried.count) * loop.options.spacing;
  whole.traits.encoder_turn_step = whole.traits.encoder_step / loop.options.spacing;
}

/// All devices as one.
void compose(DeviceLoop& loop) {
  DeviceSample& whole = loop.whole;
  whole.traits = {};
  whole.sensed = kNoAxes;
  whole.actuated = kNoAxes;
  whole.steers_rate = false;
  whole.buttons = 0;
  whole.garbage = 0;
  Pose pose;
  glm::dquat knob_turn(1.0, 0.0, 0.0, 0.0);
  for (const DeviceRow& row : loop.rows) {
    const DeviceSample& sample = row.report.sample;
    if (!row.used || row.role == DeviceRole::kNone) {
      continue;
    }
    whole.garbage += row.report.counts.garbage;
    whole.buttons |= sample.buttons;
    add_traits(whole.traits, loop, row);
    if (translates(row.role)) {
      pose.position = sample.pose.position;
      whole.steers_rate = sample.steers_rate;
      whole.sensed |= kTranslationAxes;
      whole.actuated |= sample.actuated & kTranslationAxes;
    }
    if (turns(row.role)) {
      pose.rotation = sample.pose.rotation;
      whole.sensed |= kRotationAxes;
      whole.actuated |= sample.actuated & kRotationAxes;
    }
    if (row.role == DeviceRole::kKnob) {
      const double angle = 2.0 * std::atan2(sample.pose.rotation.y, sample.pose.rotation.w);
      knob_turn = glm::angleAxis(angle, loop.options.turn_axis);
      whole.sensed |= kTurnAxis;
      whole.actuated |= sample.actuated & kTurnAxis;
    }
  }
  whole.pose = {pose.position, pose.rotation * knob_turn};
  if (loop.carried.count >= 2) {
    compose_points(loop, whole);
  }
  compose_state(loop, whole);
}

/// Whose samples are the samples of the whole: one that translates, or the only one.
bool leads(const DeviceLoop& loop, std::size_t row) {
  const auto* const leader = std::ranges::find_if(loop.rows, [](const DeviceRow& other) {
    return other.used &&
           (translates(other.role) || (other.role == DeviceRole::kPoint && other.point == 0));
  });
  return leader == loop.rows.end() || static_cast<std::size_t>(leader - loop.rows.begin()) == row;
}

/// No longer than `largest`, in the same direction.
glm::dvec3 limited(const glm::dvec3& vector, double largest) {
  const double length = glm::length(vector);
  return length > largest ? vector * (largest / length) : vector;
}

/// A device's part of the wrench, before its own limits. A knob's is its torque about y.
Wrench part_of(const DeviceLoop& loop, const DeviceRow& row) {
  const DeviceSample& whole = loop.whole;
  switch (row.role) {
    case DeviceRole::kTranslation:
    case DeviceRole::kTranslationAndRotation:
      return {loop.wrench.force, glm::dvec3(0.0)};
    case DeviceRole::kKnob: {
      const glm::dvec3 axis = whole.pose.rotation * loop.options.turn_axis;
      return {glm::dvec3(0.0), {0.0, glm::dot(loop.wrench.torque, axis), 0.0}};
    }
    case DeviceRole::kPoint: {
      std::array<glm::dvec3, kMostPoints> places{};
      std::array<glm::dvec3, kMostPoints> forces{};
      for (const DeviceRow& other : loop.rows) {
        if (other.used && other.role == DeviceRole::kPoint) {
          places[other.point] = other.report.sample.pose.position;
        }
      }
      carried_forces(loop.carried, places, loop.wrench, forces);
      return {forces[row.point], glm::dvec3(0.0)};
    }
    default:
      return {};
  }
}

/// Likewise, with no more than the device itself can do: several together can do more than one.
Wrench share_of(const DeviceLoop& loop, const DeviceRow& row) {
  const DeviceTraits& traits = row.report.sample.traits;
  const Wrench part = part_of(loop, row);
  return {limited(part.force, traits.largest_force), limited(part.torque, traits.largest_torque)};
}

/// Where all drivers' samples arrive.
Wrench on_sample(void* context, const DeviceSample& sample) {
  auto& [loop, row] = *static_cast<RowContext*>(context);
  DeviceRow& device = loop.rows[row];
  const bool was_live = loop.whole.state == DeviceState::kLive;
  const std::uint32_t kept = loop.whole.epoch;
  if (sample.state != DeviceState::kLive || device.role == DeviceRole::kNone) {
    give_roles(loop);  // a trouble may have taken it out, or brought it back
  }
  compose(loop);
  if (leads(loop, row)) {
    loop.whole.rate = sample.rate;
  }
  loop.whole.traits.period = period_of(loop.whole.traits.period, loop.whole.rate);
  turn_by_buttons(loop.button_turn, loop.options.turn_buttons, loop.options.turn_axis, loop.whole,
                  sample.time);
  const bool live = loop.whole.state == DeviceState::kLive;
  if (live != was_live) {
    loop.whole.epoch = kept + (live ? 1U : 0U);
    loop.wrench = {};
  }
  if (leads(loop, row) || live != was_live || !live) {
    loop.whole.number += 1;
    loop.whole.time = sample.time;
    loop.wrench = loop.sink.on_sample(loop.sink.context, loop.whole);
    loop.asked = sample.time;
  }
  const bool fresh = sample.time - loop.asked <= kOldWrench;
  return live && fresh ? share_of(loop, device) : Wrench{};
}

template <class F>
void with_driver(DeviceLoop& loop, std::size_t row, double now, UsbRequests& requests, F&& f) {
  DeviceRow& device = loop.rows[row];
  TORSION_ASSERT(device.used);
  RowContext context{loop, row};
  DriverCall call{now,           device.identity, loop.options.drivers,
                  device.report, requests,        {&context, on_sample}};
  std::visit([&](auto& driver) { f(driver, call); }, device.driver);
}

void occupy(DeviceLoop& loop, std::size_t row, const UsbIdentity& identity, DeviceKind kind) {
  DeviceRow& device = loop.rows[row];
  TORSION_ASSERT(!device.used);
  device = {};
  device.used = true;
  device.kind = kind;
  device.identity = identity;
  device.driver = driver_for(kind);
}

}  // namespace

double period_of(double said, double rate) {
  constexpr double kSlower = 1.05;    // timers are off by less
  constexpr double kSlowest = 20e-3;  // s: a gap, not a period
  const double measured = rate > 0.0 ? 1.0 / rate : 0.0;
  return measured > kSlower * said ? std::min(measured, kSlowest) : said;
}

std::size_t free_row(const DeviceLoop& loop) {
  const auto* const found = std::ranges::find(loop.rows, false, &DeviceRow::used);
  return static_cast<std::size_t>(found - loop.rows.begin());
}

void attach(DeviceLoop& loop, std::size_t row, const UsbIdentity& identity, DeviceKind kind,
            double now, UsbRequests& requests) {
  occupy(loop, row, identity, kind);
  loop.whole.plugged += 1;
  with_driver(loop, row, now, requests,
              [](auto& driver, DriverCall& call) { begin(driver, call); });
}

void refuse(DeviceLoop& loop, std::size_t row, const UsbIdentity& identity, DeviceKind kind,
            DeviceTrouble trouble) {
  occupy(loop, row, identity, kind);
  DeviceSample& sample = loop.rows[row].report.sample;
  sample.state = DeviceState::kStarting;
  sample.trouble = trouble;
  RowContext context{loop, row};
  on_sample(&context, sample);
}

void take(DeviceLoop& loop, std::size_t row, const UsbEvent& event, double now,
          UsbRequests& requests) {
  with_driver(loop, row, now, requests,
              [&event](auto& driver, DriverCall& call) { take(driver, call, event); });
}

void wake(DeviceLoop& loop, std::size_t row, double now, UsbRequests& requests) {
  with_driver(loop, row, now, requests, [](auto& driver, DriverCall& call) { wake(driver, call); });
}

void rest(DeviceLoop& loop, std::size_t row, double now, UsbRequests& requests) {
  with_driver(loop, row, now, requests, [](auto& driver, DriverCall& call) { rest(driver, call); });
}

void plan_rest(const DeviceLoop& loop, std::size_t row, double now, UsbRequests& requests) {
  const DeviceRow& device = loop.rows[row];
  TORSION_ASSERT(device.used);
  Driver driver = device.driver;
  DriverReport report = device.report;
  const auto no_wrench = [](void*, const DeviceSample&) {
    return Wrench{};
  };
  DriverCall call{now,    device.identity, loop.options.drivers,
                  report, requests,        {nullptr, no_wrench}};
  std::visit([&](auto& one) { rest(one, call); }, driver);
}

void detach(DeviceLoop& loop, std::size_t row, double now) {
  DeviceRow& device = loop.rows[row];
  const bool mattered = device.role != DeviceRole::kNone;
  device = {};
  give_roles(loop);
  compose(loop);
  turn_by_buttons(loop.button_turn, loop.options.turn_buttons, loop.options.turn_axis, loop.whole,
                  now);
  loop.wrench = {};
  loop.whole.time = now;
  loop.whole.number += 1;
  if (mattered && loop.whole.state == DeviceState::kLive) {
    loop.whole.epoch += 1;  // what is left goes on by itself, from no force
  }
  loop.sink.on_sample(loop.sink.context, loop.whole);
}

double next_wake(const DeviceLoop& loop) {
  double first = kNever;
  for (const DeviceRow& row : loop.rows) {
    first = row.used ? std::min(first, row.report.wake_at) : first;
  }
  return first;
}

}  // namespace torsion::engine
