#include "ecs/triple_buffer.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hpp"

namespace torsion::engine {
namespace {

TEST(TripleBufferTest, TheReaderGetsTheNewestValueOnce) {
  TripleBuffer<int> box;
  EXPECT_FALSE(box.refresh());
  for (const int value : {1, 2, 3}) {
    box.back() = value;
    box.publish();
  }
  EXPECT_TRUE(box.refresh());
  EXPECT_EQ(box.front(), 3);
  EXPECT_FALSE(box.refresh());
  EXPECT_EQ(box.front(), 3);
}

TEST(TripleBufferTest, TheWriterSeesWhetherItsValueWasTaken) {
  TripleBuffer<int> box;
  box.publish();
  EXPECT_FALSE(box.taken());
  box.refresh();
  EXPECT_TRUE(box.taken());
}

TEST(TripleBufferTest, PrepareReachesAllThreeSlots) {
  TripleBuffer<int> box;
  int calls = 0;
  box.prepare([&calls](int& value) {
    value = 5;
    calls += 1;
  });
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(box.back(), 5);
  EXPECT_EQ(box.front(), 5);
}

// A value of several cache lines, whose words must all come from one publish.
using Wide = std::array<std::uint64_t, 64>;

TEST(TripleBufferTest, TwoThreadsNeverSeeATornOrOlderValue) {
  constexpr std::uint64_t kValues = 100000;
  TripleBuffer<Wide> box;
  std::uint64_t writer_allocations = 1;
  std::thread writer([&box, &writer_allocations] {
    const test::AllocationGuard guard;
    for (std::uint64_t value = 1; value <= kValues; ++value) {
      box.back().fill(value);
      box.publish();
    }
    writer_allocations = guard.allocations();
  });
  std::uint64_t last = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  while (last < kValues) {
    if (!box.refresh()) {
      std::this_thread::yield();
      continue;
    }
    const Wide& seen = box.front();
    torn += std::ranges::count(seen, seen[0]) == static_cast<std::ptrdiff_t>(seen.size()) ? 0U : 1U;
    backwards += seen[0] > last ? 0U : 1U;
    last = seen[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(backwards, 0U);
  EXPECT_EQ(last, kValues);  // the newest value is never lost
  EXPECT_EQ(writer_allocations, 0U);
}

}  // namespace
}  // namespace torsion::engine
