#include "systems/math/wide_lanes.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

constexpr std::size_t kCount = 3 * kLanes;

/// What loops over cells do with their numbers.
struct Results {
  std::array<double, kCount> mixed{};
  double sum = 0.0;
  double largest = 0.0;
};

template <class Wide>
TORSION_LANES void work(const double* a, const double* b, Results& results) {
  Wide sums{};
  Wide most{};
  const Wide none{};
  for (std::size_t k = 0; k < kCount; k += kLanes) {
    const Wide x = lanes_at<Wide>(a + k);
    const Wide y = lanes_at<Wide>(b + k);
    const Wide quotient = (2.0 * x - y) / (1.0 + y * y) + (-x) * 0.25;
    const Wide kept = choose(x > y, quotient, choose(x != 0.0, y - 1.0, none));
    sums += kept;
    sums -= 0.125 * y;
    const Wide size = choose(kept < 0.0, -kept, kept);
    most = choose(size > most, size, most);
    store_lanes(kept, results.mixed.data() + k);
  }
  results.sum = sum_of(sums);
  results.largest = largest_of(most);
}

/// The same number by number, with a sum for each of eight lanes.
Results by_numbers(const double* a, const double* b) {
  Results results;
  std::array<double, kLanes> sums{};
  for (std::size_t k = 0; k < kCount; ++k) {
    const double x = a[k];
    const double y = b[k];
    const double quotient = (2.0 * x - y) / (1.0 + y * y) + (-x) * 0.25;
    const double kept = x > y ? quotient : (x != 0.0 ? y - 1.0 : 0.0);
    sums[k % kLanes] += kept;
    sums[k % kLanes] -= 0.125 * y;
    const double size = kept < 0.0 ? -kept : kept;
    results.largest = size > results.largest ? size : results.largest;
    results.mixed[k] = kept;
  }
  results.sum =
      ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
  return results;
}

/// One number more, so that nothing is aligned to a vector's size.
std::array<double, kCount + 1> some_numbers(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> number(-3.0, 3.0);
  std::array<double, kCount + 1> numbers{};
  for (double& each : numbers) {
    each = number(random);
  }
  numbers[5] = 0.0;
  return numbers;
}

void expect_same_bits(const Results& found, const Results& expected) {
  EXPECT_EQ(std::memcmp(found.mixed.data(), expected.mixed.data(), sizeof found.mixed), 0);
  EXPECT_EQ(found.sum, expected.sum);
  EXPECT_EQ(found.largest, expected.largest);
}

// Results must not tell which machine they are from (docs/architecture.md, Determinism).
TEST(WideLanesTest, AllWidthsHaveTheBitsOfOneNumberAtATime) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto a = some_numbers(seed);
    const auto b = some_numbers(seed + 100);
    const Results expected = by_numbers(a.data() + 1, b.data() + 1);
    Results found;
    work<WideBy2>(a.data() + 1, b.data() + 1, found);
    expect_same_bits(found, expected);
    found = {};
    work<WideBy4>(a.data() + 1, b.data() + 1, found);
    expect_same_bits(found, expected);
    found = {};
    work<WideBy8>(a.data() + 1, b.data() + 1, found);
    expect_same_bits(found, expected);
    found = {};
    TORSION_IN_WIDEST(work, a.data() + 1, b.data() + 1, found);
    expect_same_bits(found, expected);
  }
}

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
TEST(WideLanesTest, Avx2HasTheSameBits) {
  if (__builtin_cpu_supports("avx2") == 0) {
    GTEST_SKIP() << "this processor has no AVX2";
  }
  const auto a = some_numbers(7);
  const auto b = some_numbers(8);
  Results found;
  InAvx2<&work<WideBy4>>::call(a.data() + 1, b.data() + 1, found);
  expect_same_bits(found, by_numbers(a.data() + 1, b.data() + 1));
}

TEST(WideLanesTest, Avx512HasTheSameBits) {
  if (__builtin_cpu_supports("avx512f") == 0) {
    GTEST_SKIP() << "this processor has no AVX-512";
  }
  const auto a = some_numbers(7);
  const auto b = some_numbers(8);
  Results found;
  InAvx512<&work<WideBy8>>::call(a.data() + 1, b.data() + 1, found);
  expect_same_bits(found, by_numbers(a.data() + 1, b.data() + 1));
}
#endif

}  // namespace
}  // namespace torsion::engine
