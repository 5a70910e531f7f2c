// A hand that holds a tool through the library.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/library/library_scenes.hpp"

namespace torsion::test {
namespace {

DeviceTraits desk_device() {
  DeviceTraits traits;
  traits.damping = 2.0;
  traits.turn_damping = 0.01;
  traits.mass = 0.1;
  traits.inertia = 1e-4;
  traits.largest_force = 10.0;
  traits.largest_torque = 0.2;
  traits.largest_stiffness = 1500.0;
  traits.largest_turn_stiffness = 2.0;
  return traits;
}

TEST(LibraryCouplingTest, SpringAndContactBalanceAndTheHandFeelsTheContact) {
  Simulation simulation = simulation_of(ball_on_pad("mdr"));
  Coupling coupling(simulation.model(), 0, desk_device());
  EXPECT_GT(coupling.stiffness(), 0.0);
  EXPECT_LE(coupling.stiffness(), 1500.0);
  Wrench felt;
  Pose handle;
  for (int step = 0; step <= 1500; ++step) {
    handle = pressed(2e-3 * std::min(step, 1000) / 1000.0, 0.2 * std::min(step, 1000) / 1000.0);
    const Pose tool = coupling.next(simulation, handle);
    simulation.step({&tool, 1});
    felt = coupling.felt(simulation);
  }
  const Vector3 gap = minus(simulation.pose(0).position, handle.position);
  EXPECT_GT(gap[1], 0.0);
  const double contact = simulation.wrench(0).force[1];
  EXPECT_GT(contact, 0.0);
  // At rest the hand feels what the body does to the tool.
  EXPECT_NEAR(felt.force[1], contact, 0.01 * contact);
  EXPECT_NEAR(felt.torque[1], simulation.wrench(0).torque[1],
              0.02 * std::abs(simulation.wrench(0).torque[1]));
  EXPECT_LT(felt.torque[1], 0.0);  // against the turn
}

TEST(LibraryCouplingTest, HeldDirectlyTheToolIsWhereTheHandleIs) {
  Simulation simulation = simulation_of(ball_on_pad("mdr"));
  Coupling coupling(simulation.model(), 0, desk_device(), Hold::kDirect);
  for (int step = 0; step <= 100; ++step) {
    const Pose handle = pressed(4e-6 * step);
    const Pose tool = coupling.next(simulation, handle);
    EXPECT_EQ(tool.position, handle.position);
    simulation.step({&tool, 1});
    coupling.felt(simulation);
  }
  EXPECT_GT(simulation.wrench(0).force[1], 0.0);
}

}  // namespace
}  // namespace torsion::test
