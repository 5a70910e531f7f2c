#include "tests/support/allocation_guard.hpp"

#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace torsion::engine::test {
namespace {

// Written through, so that the compiler may not leave an allocation out.
void* volatile kept = nullptr;

TEST(AllocationGuardTest, CountsNewAndDelete) {
  const AllocationGuard guard;
  kept = ::operator new(100);
  ::operator delete(kept);
  EXPECT_EQ(guard.allocations(), 1U);
  EXPECT_EQ(guard.releases(), 1U);
}

TEST(AllocationGuardTest, CountsAlignedNew) {
  constexpr std::align_val_t kAlignment{64};
  const AllocationGuard guard;
  kept = ::operator new(128, kAlignment);
  ::operator delete(kept, kAlignment);
  EXPECT_EQ(guard.allocations(), 1U);
  EXPECT_EQ(guard.releases(), 1U);
}

TEST(AllocationGuardTest, CountsTheCFamily) {
  const AllocationGuard guard;
  kept = std::malloc(10);
  kept = std::realloc(kept, 100000);
  std::free(kept);
  kept = std::calloc(3, 5);
  std::free(kept);
  EXPECT_EQ(guard.allocations(), 3U);
  EXPECT_EQ(guard.releases(), 3U);
}

#ifndef TORSION_SANITIZED_THREADS  // ThreadSanitizer tells its listeners nothing of aligned_alloc
TEST(AllocationGuardTest, CountsAlignedAlloc) {
  const AllocationGuard guard;
  kept = std::aligned_alloc(64, 64);
  std::free(kept);
  EXPECT_EQ(guard.allocations(), 1U);
  EXPECT_EQ(guard.releases(), 1U);
}
#endif

TEST(AllocationGuardTest, CountsNothingWhenNothingIsTaken) {
  std::vector<int> numbers(1000);
  const AllocationGuard guard;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = static_cast<int>(i);
  }
  kept = numbers.data();
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.releases(), 0U);
}

TEST(AllocationGuardTest, LeavesOtherThreadsOut) {
  std::unique_ptr<AllocationGuard> inner;
  std::thread other([&inner] {
    inner = std::make_unique<AllocationGuard>();
    const std::vector<int> numbers(1000, 7);
    kept = const_cast<int*>(numbers.data());
    EXPECT_EQ(inner->allocations(), 1U);
  });
  const AllocationGuard guard;
  other.join();
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace torsion::engine::test
