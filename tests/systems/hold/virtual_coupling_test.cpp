#include "systems/hold/virtual_coupling.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/math/frames.hpp"
#include "tests/systems/hold/held_tool.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;
using test::kUnlimited;

VirtualCoupling springs() {
  return {1000.0, 0.0, 2.0, 0.0, kUnlimited, kUnlimited};
}

MovingFrame turned(double angle, const glm::dvec3& axis = {0.0, 1.0, 0.0}) {
  return {{glm::dvec3(0.0), glm::angleAxis(angle, glm::normalize(axis))}};
}

TEST(VirtualCouplingTest, PullsAndTurnsTheToolToTheHandle) {
  MovingFrame handle = turned(0.01);
  handle.pose.position = {0.002, 0.0, -0.001};
  const Wrench wrench = coupling_wrench(springs(), handle, {});
  EXPECT_LT(glm::distance(wrench.force, glm::dvec3(2.0, 0.0, -1.0)), 1e-12);
  EXPECT_NEAR(wrench.torque.y, 2.0 * 2.0 * std::sin(0.005), 1e-15);
}

TEST(VirtualCouplingTest, TorqueIsThatOfItsPotentialAtAnyAngle) {
  // tau = d/d(theta) of 4 k (1 - cos(theta / 2)), largest at pi and small beyond, where the short
  // way is the other one.
  for (const double angle : {0.1, 1.0, 2.0, 3.0}) {
    const Wrench wrench = coupling_wrench(springs(), turned(angle, {1.0, 2.0, -0.5}), {});
    EXPECT_NEAR(glm::length(wrench.torque), 2.0 * 2.0 * std::sin(angle / 2.0), 1e-14);
  }
  EXPECT_GT(coupling_wrench(springs(), turned(pi - 0.01), {}).torque.y, 0.0);
  EXPECT_LT(coupling_wrench(springs(), turned(pi + 0.01), {}).torque.y, 0.0);
}

TEST(VirtualCouplingTest, ClosedPathsOfTurnsTakeNoWork) {
  const VirtualCoupling coupling = springs();
  constexpr int kSteps = 20000;
  const auto rotation = [](double t) {
    return glm::angleAxis(0.8 + 0.5 * std::sin(t), glm::dvec3(0.0, 1.0, 0.0)) *
           glm::angleAxis(0.6 * std::sin(2.0 * t), glm::dvec3(1.0, 0.0, 0.0)) *
           glm::angleAxis(0.4 * std::cos(t), glm::dvec3(0.0, 0.0, 1.0));
  };
  double work = 0.0;
  double throughput = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dquat from = rotation(2.0 * pi * i / kSteps);
    const glm::dquat to = rotation(2.0 * pi * (i + 1) / kSteps);
    const glm::dquat middle = glm::normalize(from + to);
    const glm::dvec3 torque = coupling_wrench(coupling, {{glm::dvec3(0.0), middle}}, {}).torque;
    const double step = glm::dot(torque, turn_between(from, to));
    work += step;
    throughput += std::abs(step);
  }
  // The midpoint rule's error falls with the square of the step: (2 pi / 20000)^2 is 1e-7.
  EXPECT_LT(std::abs(work), 1e-6 * throughput);
}

TEST(VirtualCouplingTest, DoesNotDependOnTheFrame) {
  VirtualCoupling coupling = springs();
  coupling.damping = 3.0;
  coupling.turn_damping = 0.01;
  coupling.largest_force = 2.0;
  coupling.largest_torque = 0.7;
  const MovingFrame handle{{{0.003, 0.001, -0.002}, turned(0.7, {1.0, 1.0, 0.0}).pose.rotation},
                           {0.1, -0.2, 0.0},
                           {1.0, 0.0, 2.0}};
  const MovingFrame tool{{{0.001, 0.002, 0.0}, turned(-0.2, {0.0, 1.0, 3.0}).pose.rotation}};
  const glm::dquat turn = turned(1.1, {0.3, -1.0, 2.0}).pose.rotation;
  const auto in_other = [&](const MovingFrame& frame) -> MovingFrame {
    return {{turn * frame.pose.position + glm::dvec3(1.0), turn * frame.pose.rotation},
            turn * frame.velocity,
            turn * frame.angular_velocity};
  };
  const Wrench here = coupling_wrench(coupling, handle, tool);
  const Wrench there = coupling_wrench(coupling, in_other(handle), in_other(tool));
  EXPECT_LT(glm::distance(turn * here.force, there.force), 1e-12);
  EXPECT_LT(glm::distance(turn * here.torque, there.torque), 1e-12);
}

TEST(VirtualCouplingTest, ComesSmoothlyToItsLargestForce) {
  VirtualCoupling coupling = springs();
  coupling.largest_force = 5.0;
  double before = 0.0;
  for (double stretch = 1e-4; stretch < 1.0; stretch *= 1.5) {
    MovingFrame handle;
    handle.pose.position.x = stretch;
    const double force = coupling_wrench(coupling, handle, {}).force.x;
    EXPECT_GT(force, before);
    EXPECT_LT(force, 5.0);
    before = force;
  }
  EXPECT_GT(before, 4.99);
  EXPECT_EQ(soft_limit({1.0, 0.0, 0.0}, 0.0), glm::dvec3(0.0));
}

TEST(VirtualCouplingTest, DampsWhatMovesApart) {
  VirtualCoupling coupling = springs();
  coupling.damping = 4.0;
  coupling.turn_damping = 0.5;
  const MovingFrame handle{{}, {0.5, 0.0, 0.0}, {0.0, 2.0, 0.0}};
  const MovingFrame tool{{}, {0.25, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  const Wrench wrench = coupling_wrench(coupling, handle, tool);
  EXPECT_NEAR(wrench.force.x, 1.0, 1e-15);
  EXPECT_NEAR(wrench.torque.y, 0.5, 1e-15);
}

TEST(VirtualCouplingTest, ABalancingHandleAnswersTheContactsWrench) {
  const VirtualCoupling coupling{500.0, 0.0, 0.8, 0.0, 4.0, 0.3};
  const Pose tool{{0.1, -0.2, 0.3}, glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, 3.0)))};
  for (const double share : {0.0, 0.01, 0.4, 0.89}) {
    const Wrench contact{share * 4.0 * glm::normalize(glm::dvec3(1.0, -2.0, 0.5)),
                         share * 0.3 * glm::normalize(glm::dvec3(-0.3, 0.1, 1.0))};
    const Pose handle = balancing_handle(coupling, tool, contact);
    const Wrench pull = coupling_wrench(coupling, {handle}, {tool});
    EXPECT_LT(glm::length(pull.force + contact.force), 1e-12);
    EXPECT_LT(glm::length(pull.torque + contact.torque), 1e-12);
  }
  // What is more than the coupling can do it answers with nine tenths of that.
  const Pose handle = balancing_handle(coupling, tool, {{0.0, 50.0, 0.0}, {0.0, 0.0, -2.0}});
  const Wrench pull = coupling_wrench(coupling, {handle}, {tool});
  EXPECT_NEAR(pull.force.y, -0.9 * 4.0, 1e-12);
  EXPECT_NEAR(pull.torque.z, 0.9 * 0.3, 1e-12);
  EXPECT_EQ(balancing_handle({}, tool, {{1.0, 0.0, 0.0}, {}}).position, tool.position);
}

TEST(VirtualCouplingTest, OneThatIsStrongEnoughAnswersAnyContact) {
  const VirtualCoupling coupling{500.0, 0.0, 0.8, 0.0, 4.0, 0.3};
  const Pose tool{{0.1, -0.2, 0.3}, glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, 3.0)))};
  const Wrench contact{{3.0, 50.0, -1.0}, {0.5, 0.0, -2.0}};
  const VirtualCoupling stronger = strong_enough(coupling, contact);
  const Pose handle = balancing_handle(stronger, tool, contact);
  const Wrench pull = coupling_wrench(stronger, {handle}, {tool});
  EXPECT_LT(glm::length(pull.force + contact.force), 1e-12 * 50.0);
  EXPECT_LT(glm::length(pull.torque + contact.torque), 1e-12 * 2.0);
  EXPECT_LT(glm::angle(glm::inverse(tool.rotation) * handle.rotation), glm::radians(60.0001));
  // What it can do is not made less.
  const VirtualCoupling same = strong_enough(coupling, {{1.0, 0.0, 0.0}, {0.0, 0.1, 0.0}});
  EXPECT_EQ(same.largest_force, 4.0);
  EXPECT_EQ(same.largest_torque, 0.3);
  EXPECT_EQ(same.turn_stiffness, 0.8);
}

}  // namespace
}  // namespace torsion::engine
