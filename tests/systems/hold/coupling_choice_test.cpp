#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "systems/hold/virtual_coupling.hpp"
#include "tests/systems/hold/held_tool.hpp"

namespace torsion::engine {
namespace {

using test::kPeriod;

/// Energy that a spring K, sampled at T and held, gives while it is pressed slowly to and fro, less
/// what a damper of b takes, J. Below zero a passive device would be a source of energy.
double taken_by(double stiffness, double damping, double period) {
  constexpr double kDepth = 1e-2;
  constexpr int kSteps = 20000;  // to and fro: slow, as the bound's worst case is
  double taken = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const auto at = [](int step) {
      return kDepth * 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * step / kSteps));
    };
    const double way = at(i + 1) - at(i);
    taken += stiffness * at(i) * way + damping * way * way / period;
  }
  return taken;
}

TEST(CouplingChoiceTest, ExperimentFindsColgatesBound) {
  // b > K T / 2: the largest stiffness at which the hand gets back no more than it gave.
  for (const double damping : {0.005, 0.5, 5.0}) {
    double low = 0.0;
    double high = 1e6;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (taken_by(middle, damping, kPeriod) >= 0.0 ? low : high) = middle;
    }
    const double bound = 2.0 * damping / kPeriod;
    EXPECT_NEAR(low, bound, 0.05 * bound);
    // and the choice stays within what was found
    DeviceTraits device;
    device.damping = damping;
    EXPECT_LT(choose_coupling(device).coupling.stiffness, low);
    EXPECT_GT(choose_coupling(device).coupling.stiffness, 0.8 * low);
  }
}

TEST(CouplingChoiceTest, SaysWhatSetIt) {
  DeviceTraits device;
  EXPECT_EQ(choose_coupling(device).limit, StiffnessLimit::kUnknown);
  device.largest_stiffness = 2000.0;
  EXPECT_EQ(choose_coupling(device).limit, StiffnessLimit::kDevice);
  EXPECT_EQ(choose_coupling(device).coupling.stiffness, 2000.0);
  device.damping = 0.5;  // 900 N/m at 1 kHz
  EXPECT_EQ(choose_coupling(device).limit, StiffnessLimit::kPassivity);
  EXPECT_NEAR(choose_coupling(device).coupling.stiffness, 900.0, 1e-9);
  device.damping = 50.0;
  EXPECT_EQ(choose_coupling(device).limit, StiffnessLimit::kDevice);
}

TEST(CouplingChoiceTest, DelayCostsStiffness) {
  DeviceTraits device;
  device.damping = 1.0;
  const double without = choose_coupling(device).coupling.stiffness;
  device.delay = 3e-3;
  // T / 2 + t_d is seven times T / 2.
  EXPECT_NEAR(choose_coupling(device).coupling.stiffness, without / 7.0, 1e-9);
}

TEST(CouplingChoiceTest, CouplingFormAllowsPiTimesAsMuch) {
  // b >= K T / (2 pi) against b > K T / 2
  EXPECT_NEAR(virtual_coupling_bound(1.0, 1e-3), std::numbers::pi * 2000.0, 1e-9);
}

}  // namespace
}  // namespace torsion::engine
