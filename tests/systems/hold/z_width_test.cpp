// Colgate's bound against walls that are simulated: no wall within it shakes, whoever holds the
// device, and without a hand and virtual damping it is where shaking begins.

#include "tests/systems/hold/z_width.hpp"

#include <gtest/gtest.h>

#include "systems/hold/virtual_coupling.hpp"

namespace torsion::engine {
namespace {

using test::kWallDevices;
using test::largest_stable_stiffness;
using test::passive_stiffness;
using test::WallDevice;

TEST(ZWidthTest, NothingWithinColgatesBoundShakes) {
  for (const WallDevice& device : kWallDevices) {
    for (const double share : {0.0, 0.3, 0.6, 0.9}) {
      SCOPED_TRACE(testing::Message() << device.name << ", B = " << share << " b");
      const double damping = share * device.damping;
      const double passive = passive_stiffness(device, damping);
      EXPECT_GE(largest_stable_stiffness(device, damping, false), 0.995 * passive);
      EXPECT_GE(largest_stable_stiffness(device, damping, true), 0.995 * passive);
    }
  }
}

// A spring that is sampled and late turns its stiffness into K (T / 2 + t_d) of damping with a
// minus in front, as long as it is slow against its own frequency: to the square of w (T / 2 +
// t_d).
TEST(ZWidthTest, AHandThatDoesNotDampFindsTheBound) {
  for (const WallDevice& device : kWallDevices) {
    SCOPED_TRACE(device.name);
    const double passive = passive_stiffness(device, 0.0);
    const double lag = 0.5 * device.period + device.delay;
    const double square = passive / device.mass * lag * lag;
    EXPECT_NEAR(largest_stable_stiffness(device, 0.0, false), passive, (0.005 + square) * passive);
  }
}

TEST(ZWidthTest, TheCouplingThatIsChosenIsWithinIt) {
  for (const WallDevice& device : kWallDevices) {
    DeviceTraits traits;
    traits.damping = device.damping;
    traits.mass = device.mass;
    traits.period = device.period;
    traits.delay = device.delay;
    const double chosen = choose_coupling(traits).coupling.stiffness;
    EXPECT_NEAR(chosen, 0.9 * passive_stiffness(device, 0.0), 1e-9 * chosen);
    EXPECT_TRUE(is_stable(device, chosen, 0.0, false)) << device.name;
    EXPECT_TRUE(is_stable(device, chosen, 0.0, true)) << device.name;
  }
}

}  // namespace
}  // namespace torsion::engine
