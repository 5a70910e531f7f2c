#include "ecs/ring.hpp"

#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hpp"

namespace torsion::engine {
namespace {

TEST(RingTest, ValuesComeOutInOrder) {
  Ring<int> ring;
  ring.reserve(4);
  EXPECT_FALSE(ring.pop().has_value());
  for (int round = 0; round < 5; ++round) {
    EXPECT_TRUE(ring.push(2 * round));
    EXPECT_TRUE(ring.push(2 * round + 1));
    EXPECT_EQ(ring.pop(), 2 * round);
    EXPECT_EQ(ring.pop(), 2 * round + 1);
  }
  EXPECT_FALSE(ring.pop().has_value());
}

TEST(RingTest, AFullRingRefusesAndKeepsWhatItHas) {
  Ring<int> ring;
  ring.reserve(3);
  ASSERT_EQ(ring.capacity(), 4U);
  for (int value = 0; value < 4; ++value) {
    EXPECT_TRUE(ring.push(value));
  }
  EXPECT_FALSE(ring.push(4));
  EXPECT_EQ(ring.pop(), 0);
  EXPECT_TRUE(ring.push(5));
  EXPECT_EQ(ring.pop(), 1);
}

TEST(RingTest, ARingWithoutMemoryIsFullAndEmpty) {
  Ring<int> ring;
  EXPECT_FALSE(ring.push(1));
  EXPECT_FALSE(ring.pop().has_value());
}

struct Message {
  std::uint64_t number = 0;
  std::uint64_t copies[7] = {};
};

TEST(RingTest, TwoThreadsLoseNothingAndKeepTheOrder) {
  constexpr std::uint64_t kMessages = 100000;
  Ring<Message> ring;
  ring.reserve(64);
  std::thread writer([&ring] {
    Message message;
    for (std::uint64_t number = 0; number < kMessages; ++number) {
      message.number = number;
      for (std::uint64_t& copy : message.copies) {
        copy = number;
      }
      while (!ring.push(message)) {
        std::this_thread::yield();
      }
    }
  });
  const test::AllocationGuard guard;
  std::uint64_t expected = 0;
  std::uint64_t wrong = 0;
  while (expected < kMessages) {
    const auto message = ring.pop();
    if (!message) {
      std::this_thread::yield();
      continue;
    }
    wrong += message->number == expected ? 0U : 1U;
    for (const std::uint64_t copy : message->copies) {
      wrong += copy == expected ? 0U : 1U;
    }
    expected += 1;
  }
  EXPECT_EQ(guard.allocations(), 0U);
  writer.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_FALSE(ring.pop().has_value());
}

}  // namespace
}  // namespace torsion::engine
