#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "systems/step.hpp"
#include "tests/fuzz/random_scene.hpp"

namespace torsion::engine::test {

// Steps. Slow enough that ten of them are a small part of every motion.
inline constexpr int kCome = 60;
inline constexpr int kPress = 150;
inline constexpr int kMove = 150;
inline constexpr int kHeld = kCome + kPress + kMove;  // from here on it is held still
inline constexpr int kStill = 20;  // steps at the end of that in which nothing changes

/// Steps for which the tools of a scene at this rate are held still: what events have done to a
/// force fades in 10 ms (region_wrenches.cpp).
int hold_steps(double rate);

/// The poses of all tools, step by step, through the way and back.
/// @param hold   hold_steps
/// @param parts  steps for one of the others
std::vector<std::vector<Pose>> poses_of(const RandomScene& random, const World& world, int hold,
                                        int parts = 1);

/// The rate, or a lower one at which no step is half a jump (tool_motion.cpp).
double slow_enough_rate(const std::vector<std::vector<Pose>>& poses, double rate);

/// What is seen while the tools go their ways.
struct Run {
  std::vector<std::vector<glm::dvec3>> forces;   // (tools) (steps) N
  std::vector<std::vector<glm::dvec3>> torques;  // N m
  std::vector<double> work;                      // (steps) J, of all tools
  std::vector<std::vector<std::size_t>> let_go;  // (tools) steps in which friction alone let go
  std::uint32_t faults = 0;
  int fault_step = -1;
  bool into_a_side = false;  // whether a tool that moved over the body met a side of it
  double friction = 0.0;     // the largest of a region's over what its pressure can hold
  int friction_step = -1;
  int pressed = 0;   // steps with a force
  int unsolved = 0;  // those that left equations of `patch` far from solved
};

Run run(Simulation& simulation, std::span<const RandomWay> ways,
        const std::vector<std::vector<Pose>>& poses);

}  // namespace torsion::engine::test
