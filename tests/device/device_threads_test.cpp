// The device's thread and the physics' thread: what passes between them is whole and newest, under
// ThreadSanitizer, with devices that come and go. No libusb: it is not built for that.

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "device/handle_slot.hpp"
#include "tests/device/fake_bus.hpp"

namespace torsion::engine {
namespace {

/// The sink of a session, as far as threads see it.
struct SlotSink {
  HandleSlot slot;
  std::uint64_t number = 0;
  std::uint64_t answers = 0;

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    auto& self = *static_cast<SlotSink*>(context);
    HandleSample& handle = self.slot.sample.back();
    handle.number = ++self.number;
    handle.pose.position = glm::dvec3(static_cast<double>(self.number));
    handle.epoch = sample.epoch;
    self.slot.sample.publish();
    self.answers += self.slot.answer.refresh() ? 1U : 0U;
    return self.slot.answer.front().wrench;
  }
};

TEST(DeviceThreadsTest, PosesAndWrenchesPassWholeWhileDevicesComeAndGo) {
  SlotSink sink;
  std::atomic<bool> over = false;
  std::atomic<std::uint64_t> taken = 0;
  bool whole = true;
  std::thread physics([&] {
    std::uint64_t last = 0;
    while (!over.load(std::memory_order_acquire)) {
      if (sink.slot.sample.refresh()) {
        const HandleSample& sample = sink.slot.sample.front();
        whole = whole && sample.pose.position == glm::dvec3(static_cast<double>(sample.number)) &&
                sample.number > last;
        last = sample.number;
        taken.fetch_add(1, std::memory_order_relaxed);
        HandleAnswer& answer = sink.slot.answer.back();
        answer.sample = last;
        answer.wrench.force = glm::dvec3(0.0, 1e-3 * static_cast<double>(last % 1000), 0.0);
        sink.slot.answer.publish();
      }
      std::this_thread::yield();
    }
  });
  std::thread device([&] {
    test::FakeBus bus({}, {&sink, SlotSink::on_sample});
    // Until enough has passed each way: a busy machine may hold one of the threads back for long.
    const auto enough = [&] {
      return taken.load() > 100 && sink.answers > 100;
    };
    for (int round = 0; round < 20 || (round < 20'000 && !enough()); ++round) {
      const std::size_t falcon = bus.plug(test::EmulatedFalcon{});
      const std::size_t knob = bus.plug(test::EmulatedOdrive{});
      for (int i = 0; i < 100; ++i) {
        bus.run(2e-3);
        std::this_thread::yield();
      }
      bus.unplug(falcon);
      bus.run(5e-3);
      bus.unplug(knob);
      bus.run(5e-3);
    }
  });
  device.join();
  over.store(true, std::memory_order_release);
  physics.join();
  EXPECT_TRUE(whole);
  EXPECT_GT(taken.load(), 100U);
  EXPECT_GT(sink.answers, 100U);
}

}  // namespace
}  // namespace torsion::engine
