#include "app/run_statistics.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace torsion {
namespace {

TEST(TimeHistogramTest, QuantilesAreRightWithinABin) {
  TimeHistogram histogram;
  for (int i = 1; i <= 1000; ++i) {
    histogram.add(static_cast<double>(i));  // us
  }
  // A bin is a factor of sqrt(2) wide, and times are taken as even within it.
  EXPECT_NEAR(histogram.quantile(0.5), 500.0, 0.05 * 500.0);
  EXPECT_NEAR(histogram.quantile(0.99), 990.0, 0.05 * 990.0);
  EXPECT_EQ(histogram.quantile(1.0), 1000.0);
  EXPECT_EQ(histogram.largest(), 1000.0);
  EXPECT_EQ(histogram.count(), 1000U);
}

TEST(TimeHistogramTest, TakesAnyTime) {
  TimeHistogram histogram;
  histogram.add(0.0);
  histogram.add(1e12);
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_LE(histogram.quantile(0.25), 0.2);
  EXPECT_FALSE(histogram.text().empty());
}

}  // namespace
}  // namespace torsion
