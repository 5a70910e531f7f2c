#include "systems/hold/thermal_limit.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

ThermalLimit motor() {
  ThermalLimit limit;
  limit.continuous = 2.0;
  limit.time = 5.0;
  return limit;
}

/// Always the most that is allowed, of 8, for `seconds`. @return what is allowed in the end
double push(ThermalLimit& limit, double seconds, double period) {
  double allowed = 8.0;
  for (double time = 0.0; time < seconds; time += period) {
    allowed = allowed_now(limit, 8.0);
    take_loss(limit, allowed, period);
  }
  return allowed;
}

TEST(ThermalLimitTest, AllowsThePeakUntilTheMotorIsWarm) {
  // From cold the mean square of a constant force rises as 1 - exp(-t / time): to four fifths of
  // 2^2 of 8^2 after -ln(1 - 0.05) of it.
  const double free = -5.0 * std::log1p(-0.8 * 4.0 / 64.0);
  for (const double period : {1e-2, 1e-3, 1.25e-4}) {
    ThermalLimit limit = motor();
    EXPECT_EQ(push(limit, free - 2.0 * period, period), 8.0);
    EXPECT_LT(push(limit, 4.0 * period, period), 8.0);
  }
}

TEST(ThermalLimitTest, ComesToWhatTheMotorBearsForEverAndNoHigher) {
  ThermalLimit limit = motor();
  EXPECT_NEAR(push(limit, 60.0, 1e-3), 2.0, 1e-3 * 2.0 + 0.5);
  EXPECT_LE(limit.loss, 4.0 * (1.0 + 1e-9));
  // A force under it is never touched.
  for (int i = 0; i < 100000; ++i) {
    take_loss(limit, 1.7, 1e-3);
    EXPECT_GE(allowed_now(limit, 8.0), 1.7);
  }
  // Cooled down it has all of its peak again.
  for (int i = 0; i < 30000; ++i) {
    take_loss(limit, 0.0, 1e-3);
  }
  EXPECT_EQ(allowed_now(limit, 8.0), 8.0);
}

TEST(ThermalLimitTest, LimitsNothingWhereNothingIsKnown) {
  ThermalLimit limit;
  EXPECT_EQ(push(limit, 100.0, 1e-2), 8.0);
}

}  // namespace
}  // namespace torsion::engine
