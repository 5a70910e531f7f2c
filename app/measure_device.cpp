#include "app/measure_device.hpp"

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "app/commands.hpp"
#include "app/live/interrupt.hpp"
#include "app/live/measured_traits.hpp"
#include "app/live/realtime_mode.hpp"
#include "device/device_text.hpp"
#include "device/usb/usb_bus.hpp"
#include "ecs/triple_buffer.hpp"
#include "systems/hold/device_measurement.hpp"

namespace torsion::engine {
namespace {

constexpr long kLook = 50;             // ms: between two looks at what the device does
constexpr double kLongestWait = 20.0;  // s: for the device

/// What the device's thread shows.
struct MeasurementView {
  MeasurementStage stage = MeasurementStage::kDevice;
  DeviceSample sample;
};

/// Between the device's thread and the person's.
struct Meter {
  std::atomic<bool> is_held = false;
  std::atomic<bool> is_alone = false;
  TripleBuffer<MeasurementView> views;
  DeviceMeasurement measurement;  // of the device's thread, and of the other when that has ended

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    auto& meter = *static_cast<Meter*>(context);
    meter.measurement.is_held = meter.is_held.load(std::memory_order_relaxed);
    meter.measurement.is_alone = meter.is_alone.load(std::memory_order_relaxed);
    const Wrench wrench = take_measurement_sample(meter.measurement, sample);
    meter.views.back() = {meter.measurement.stage, sample};
    meter.views.publish();
    return wrench;
  }
};

enum class Answer : std::uint8_t { kNone, kYes, kEnd };

/// Whether the person has pressed Enter by now.
Answer answer_now() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) {
    return Answer::kNone;
  }
  char byte = 0;
  while (true) {
    const ssize_t count = ::read(STDIN_FILENO, &byte, 1);
    if (count != 1) {
      return Answer::kEnd;
    }
    if (byte == '\n') {
      return Answer::kYes;
    }
  }
}

void say(const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

/// What the person is to do now; empty where nothing.
std::string request_of(MeasurementStage stage) {
  switch (stage) {
    case MeasurementStage::kHold:
      return "Hold the handle loosely in the middle of its range and press Enter. It will tremble "
             "for some seconds.";
    case MeasurementStage::kLetGo:
      return "It goes where it is pushed. It holds itself now: let go of it, keep clear of it, and "
             "press Enter.";
    default:
      return "";
  }
}

std::string why_failed(const DeviceMeasurement& measurement) {
  if (measurement.axes == 0) {
    return "it displays nothing, so that nothing can swing it";
  }
  if (measurement.identification.strayed) {
    return "it left its place: 40 mm or 1 rad. Was it pushed, or is it too heavy for its motors?";
  }
  switch (measurement.guard.signs) {
    case SignVerdict::kReversed:
      return "it goes the other way than it is pushed; mend the signs of its motors or encoders";
    case SignVerdict::kUnresolved:
      return "it did not move when it was pushed; is its power on, and is it held loosely?";
    default:
      break;
  }
  switch (measurement.guard.reason) {
    case GuardReason::kReversed:
      return "it goes the other way than it is pushed; mend the signs of its motors or encoders";
    case GuardReason::kTooFast:
      return "it moved faster than a hand should. Was it pushed, or is it too heavy for its "
             "motors?";
    default:
      return "the device was silent or went away";
  }
}

void print_axes(const DeviceMeasurement& measurement) {
  constexpr std::array<const char*, kIdentifiedAxes> kNames = {
      "x", "y", "z", "turning about x", "turning about y", "turning about z"};
  for (std::size_t axis = 0; axis < kIdentifiedAxes; ++axis) {
    if ((measurement.axes >> axis & 1U) == 0U) {
      continue;
    }
    const bool turns = axis >= 3;
    const AxisDynamics found = measured_axis(measurement, axis);
    if (!found.found) {
      say(fmt::format("{}: it hardly moved; nothing was found", kNames[axis]));
      continue;
    }
    say(
        fmt::format("{}: {} {:.3g} {}, damping {:.3g} {}, dry friction {:.3g} {}, {:.1f} ms late; "
                    "off by {:.0f} %",
                    kNames[axis], turns ? "inertia" : "mass", found.mass, turns ? "kg m^2" : "kg",
                    found.damping, turns ? "N m s/rad" : "N s/m", found.friction,
                    turns ? "N m" : "N", 1e3 * found.delay, 100.0 * found.misfit));
    if (!is_reliable(found)) {
      say("  That is too far off, and is not counted on: was it touched meanwhile, or does it "
          "rub?");
    }
  }
}

/// The bus runs until there is something to look at. @return the problem; nothing: it is done
std::optional<std::string> run(Meter& meter, const Interrupt& interrupt, bool agreed) {
  MeasurementStage before = MeasurementStage::kDevice;
  double waited = 0.0;
  while (true) {
    if (interrupt.within(kLook)) {
      return "interrupted: nothing was measured";
    }
    meter.views.refresh();
    const MeasurementView& view = meter.views.front();
    if (view.stage == MeasurementStage::kMeasured || view.stage == MeasurementStage::kNotMeasured) {
      return std::nullopt;
    }
    if (view.stage == MeasurementStage::kDevice) {
      waited += 1e-3 * kLook;
      if (waited > kLongestWait) {
        const std::string trouble = trouble_text(view.sample);
        return trouble.empty() ? "no such device is plugged in" : trouble;
      }
      continue;
    }
    std::atomic<bool>& agreement =
        view.stage == MeasurementStage::kHold ? meter.is_held : meter.is_alone;
    const std::string request = request_of(view.stage);
    if (view.stage != before) {
      before = view.stage;
      if (!request.empty() && !agreed) {
        say(request);
      } else if (view.stage == MeasurementStage::kSwinging) {
        say("It is swung to and fro. Do not touch it.");
      }
    }
    if (request.empty() || agreement) {
      continue;
    }
    const Answer answer = agreed ? Answer::kYes : answer_now();
    if (answer == Answer::kEnd) {
      return "nobody is there to be asked; --yes lets it move without";
    }
    agreement = answer == Answer::kYes;
  }
}

}  // namespace

int measure_device(const DeviceChoice& choice, bool agreed) {
  const Result<std::uint32_t> kinds = kinds_of(choice.what);
  if (!kinds) {
    return fail(kinds.error().text);
  }
  if (std::popcount(kinds.value()) != 1) {
    return fail("--measure wants one kind of device, such as --device usb:falcon");
  }
  const auto kind = static_cast<DeviceKind>(std::countr_zero(kinds.value()));
  Result<std::vector<std::uint8_t>> firmware = load_firmware(choice.falcon_firmware);
  if (!firmware) {
    return fail(firmware.error().text);
  }
  const Interrupt interrupt;
  Meter meter;
  UsbBusOptions options;
  options.loop = loop_of(choice, kinds.value(), firmware.value());
  options.on_start = [] {
    become_realtime();
  };
  auto bus = UsbBus::start(options, {&meter, Meter::on_sample});
  if (!bus) {
    return fail(bus.error().text);
  }
  say(fmt::format("{}: it will be moved by its own motors, with up to 15 % of its largest force.",
                  name_of(kind)));
  const auto problem = run(meter, interrupt, agreed);
  bus.value().reset();
  if (problem) {
    return fail(*problem);
  }
  if (meter.measurement.stage == MeasurementStage::kNotMeasured) {
    return fail("not measured: " + why_failed(meter.measurement));
  }
  print_axes(meter.measurement);
  const DeviceTraits found = measured_traits(meter.measurement);
  if (found.mass == 0.0 && found.inertia == 0.0) {
    return fail("not measured: it hardly moved, or not as a mass with damping and friction does");
  }
  if (found.weight > 0.0) {
    say(
        fmt::format("it weighs {:.3g} N at its handle, which its motors will carry while it holds "
                    "a tool",
                    found.weight));
  }
  const Result<Done> saved = save_measured_traits(
      kind,
      {found.mass, found.damping, found.inertia, found.turn_damping, found.delay, found.weight});
  if (!saved) {
    return fail(saved.error().text);
  }
  say(fmt::format("kept in {}; sessions count on it from now on",
                  measured_traits_file(kind).string()));
  return kDone;
}

}  // namespace torsion::engine
