#pragma once

#include <cstdint>

namespace torsion::engine::test {

/// Counts what the calling thread takes from and gives back to the heap while the guard lives,
/// through any door: new, malloc, aligned_alloc, the insides of a library. Linking
/// torsion_test_support is enough to be counted.
///
///   const AllocationGuard guard;
///   step(simulation, poses);
///   EXPECT_EQ(guard.allocations(), 0U);
class AllocationGuard {
 public:
  AllocationGuard();

  /// Blocks taken by this thread since construction; a realloc is one taken and one given back.
  [[nodiscard]] std::uint64_t allocations() const;

  /// Blocks given back by this thread since construction.
  [[nodiscard]] std::uint64_t releases() const;

 private:
  std::uint64_t allocations_before_;
  std::uint64_t releases_before_;
};

}  // namespace torsion::engine::test
