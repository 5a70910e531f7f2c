// Steps, loads and copies as other programs have them, against exact solutions.

#include <cmath>
#include <numbers>
#include <thread>

#include <gtest/gtest.h>

#include "tests/library/library_scenes.hpp"
#include "tests/support/allocation_guard.hpp"

namespace torsion::test {
namespace {

constexpr double kDepth = 4e-4;                 // m: a contact of a seventh of the ball's radius
constexpr double kContactModulus = 1e5 / 0.75;  // Pa: E / (1 - nu^2) at nu = 0.5
constexpr double kShearModulus = 1e5 / 3.0;     // Pa
const double kContactRadius = std::sqrt(kRadius * kDepth);  // m: Hertz

double hertz_force() {
  return 4.0 / 3.0 * kContactModulus * kContactRadius * kDepth;
}

TEST(LibrarySimulationTest, ABallPressesAsHertzAndTurnsAsLubkinSay) {
  Simulation simulation = simulation_of(ball_on_pad("mdr"));
  press(simulation, kDepth);
  // The ball is no paraboloid: a^2 / R^2 of the force, 2 %, is more than it makes.
  EXPECT_NEAR(simulation.wrench(0).force[1], hertz_force(), 0.02 * hertz_force());
  for (int step = 1; step <= 1000; ++step) {
    const Pose pose = pressed(kDepth, 1e-3 * step);
    simulation.step({&pose, 1});
  }
  ASSERT_EQ(simulation.region_count(), 1U);
  const Region region = simulation.region(0);
  const double saturated = 3.0 * std::numbers::pi / 16.0 * 0.5 * region.normal_force *
                           region.radius;  // Lubkin, 1951: all slips
  EXPECT_NEAR(-region.couple, saturated, 0.01 * saturated);
  EXPECT_NEAR(region.turn, 1.0, 1e-9);
  EXPECT_EQ(region.stick_share, 0.0);
  EXPECT_NEAR(region.radius, kContactRadius, 0.02 * kContactRadius);
  EXPECT_EQ(simulation.faults_ever(), 0U);
}

TEST(LibrarySimulationTest, PartsOfTheLoadAddUpToTheWrench) {
  for (const char* const model : {"paper", "mdr", "patch", "winkler"}) {
    SCOPED_TRACE(model);
    Simulation simulation = simulation_of(ball_on_pad(model));
    press(simulation, kDepth);
    for (int step = 1; step <= 300; ++step) {
      Pose pose = pressed(kDepth, 1e-4 * step);
      pose.position[0] = 1e-6 * step;
      simulation.step({&pose, 1});
    }
    const Vector3 about{0.3, -0.2, 0.1};
    const LoadParts parts = simulation.load_parts(0, about);
    const Wrench wrench = simulation.wrench(0, about);
    const double force = length(wrench.force);
    // What an event, such as a grid that has moved on, still fades in: patch has such.
    const double bound = model == std::string("patch") ? 2e-3 : 1e-12;
    EXPECT_LT(length(minus(plus(parts.normal_force, parts.friction), wrench.force)), bound * force);
    EXPECT_LT(length(minus(plus(parts.couple, parts.lever_torque), wrench.torque)),
              bound * length(wrench.torque));
    EXPECT_GT(length(parts.couple), 0.0);
    // About the tool's frame, less the arm from the point to there.
    const Wrench at_frame = simulation.wrench(0);
    const Vector3 arm = minus(simulation.pose(0).position, about);
    const Vector3 moved{arm[1] * wrench.force[2] - arm[2] * wrench.force[1],
                        arm[2] * wrench.force[0] - arm[0] * wrench.force[2],
                        arm[0] * wrench.force[1] - arm[1] * wrench.force[0]};
    EXPECT_LT(length(minus(plus(at_frame.torque, moved), wrench.torque)),
              1e-12 * length(wrench.torque));
  }
}

TEST(LibrarySimulationTest, StiffnessIsThatOfADiscThatSticks) {
  Simulation simulation = simulation_of(ball_on_pad("mdr"));
  press(simulation, kDepth);
  const Matrix6 stiffness = simulation.stiffness(0);
  const double a = simulation.region(0).radius;
  // Johnson, Contact Mechanics, 1985, 4.2 and 7.2; a turn about the vertical meets no arm.
  EXPECT_NEAR(stiffness[1][1], 2.0 * kContactModulus * a, 0.03 * stiffness[1][1]);
  EXPECT_NEAR(stiffness[0][0], 8.0 * kShearModulus * a / 1.5, 0.03 * stiffness[0][0]);
  EXPECT_NEAR(stiffness[4][4], 16.0 / 3.0 * kShearModulus * a * a * a, 0.03 * stiffness[4][4]);
}

TEST(LibrarySimulationTest, CellsCarryTheRegionsForce) {
  Simulation simulation = simulation_of(ball_on_pad("patch"));
  press(simulation, kDepth);
  double force = 0.0;
  for (const Cell& cell : simulation.cells(0)) {
    force += cell.pressure * cell.area;
    EXPECT_LT(std::hypot(cell.point[0], cell.point[2]), 1.5 * kContactRadius);
  }
  // Less what the energy's books take off the force: regridding lends up to 0.2 %
  // (patch/energy.cpp).
  const double carried = simulation.region(0).normal_force;
  EXPECT_NEAR(force, carried, 2e-3 * carried);
}

TEST(LibrarySimulationTest, ACopyGoesOnAlikeAndDisturbsNobody) {
  for (const char* const model : {"mdr", "patch"}) {
    SCOPED_TRACE(model);
    Simulation one = simulation_of(ball_on_pad(model));
    press(one, kDepth);
    Simulation other = one;
    const std::uint64_t before = one.hash();
    EXPECT_EQ(other.hash(), before);
    for (int step = 1; step <= 50; ++step) {
      const Pose pose = pressed(kDepth, 2e-3 * step);
      other.step({&pose, 1});
    }
    EXPECT_EQ(one.hash(), before);
    for (int step = 1; step <= 50; ++step) {
      const Pose pose = pressed(kDepth, 2e-3 * step);
      one.step({&pose, 1});
    }
    EXPECT_EQ(one.hash(), other.hash());
    other = simulation_of(ball_on_pad(model));
    one.reset();
    EXPECT_EQ(one.hash(), other.hash());
    EXPECT_EQ(one.step_count(), 0U);
  }
}

TEST(LibrarySimulationTest, ThreadsShareAModel) {
  const Simulation start = simulation_of(ball_on_pad("patch"));
  std::array<std::uint64_t, 2> hashes{};
  std::vector<std::thread> threads;
  for (std::uint64_t& hash : hashes) {
    threads.emplace_back([&start, &hash] {
      Simulation simulation(start.shared_model());
      press(simulation, kDepth);
      hash = simulation.hash();
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(LibrarySimulationTest, AStepTakesNothingFromTheHeap) {
  Simulation simulation = simulation_of(ball_on_pad("patch"));
  const engine::test::AllocationGuard guard;
  press(simulation, kDepth);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_GT(simulation.region(0).normal_force, 0.0);
}

TEST(LibrarySimulationTest, AQuaternionInFloatIsMadeUnit) {
  Simulation exact = simulation_of(ball_on_pad("mdr"));
  Simulation rounded = simulation_of(ball_on_pad("mdr"));
  for (int step = 0; step <= 100; ++step) {
    const Pose pose = pressed(kDepth * step / 100, 0.7);
    Pose in_float = pose;
    for (double& number : in_float.orientation) {
      number = static_cast<double>(static_cast<float>(number));
    }
    exact.step({&pose, 1});
    rounded.step({&in_float, 1});
  }
  EXPECT_NEAR(rounded.wrench(0).force[1], exact.wrench(0).force[1],
              1e-6 * exact.wrench(0).force[1]);
  EXPECT_EQ(rounded.faults_ever(), 0U);
}

TEST(LibrarySimulationTest, AFaultIsNamedAndTheForceFades) {
  Simulation simulation = simulation_of(ball_on_pad("mdr"));
  press(simulation, kDepth);
  Pose broken = pressed(kDepth);
  broken.position[1] = std::nan("");
  simulation.step({&broken, 1});
  EXPECT_EQ(simulation.faults(), fault::kPoseNotFinite);
  EXPECT_FALSE(describe_faults(simulation.faults()).empty());
  for (int step = 0; step < 20; ++step) {
    simulation.step({&broken, 1});
  }
  EXPECT_EQ(length(simulation.wrench(0).force), 0.0);
}

TEST(LibrarySimulationTest, ABrokenPreconditionGoesToTheHostsHandler) {
  const Simulation simulation = simulation_of(ball_on_pad("mdr"));
  const AssertionHandler before = set_assertion_handler(
      [](const char* condition, const char*, int) { throw std::logic_error(condition); });
  EXPECT_THROW((void)simulation.model().contact_model(1), std::logic_error);
  set_assertion_handler(before);
  EXPECT_DEATH((void)simulation.model().contact_model(1), "assertion failed");
}

}  // namespace
}  // namespace torsion::test
