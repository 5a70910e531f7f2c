#pragma once

#include <cstdint>
#include <optional>
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

/// The poses of all tools, step by step, through the way and back.
/// @param world  of the scene, at any rate
/// @param hold   steps for which they are held still
/// @param parts  steps for one of the others
std::vector<std::vector<Pose>> poses_of(const RandomScene& random, const World& world, int hold,
                                        int parts = 1);

/// A scene at a rate that its tools' ways allow, and these.
struct Journey {
  RandomScene scene;
  int hold = 0;  // steps for which the tools are held still
  std::vector<std::vector<Pose>> poses;
};

/// @return nothing where the scene cannot be prepared
std::optional<Journey> journey_of(const RandomScene& random);

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
  int strained = 0;  // those in which a contact was loaded too much for linear elasticity
};

Run run(Simulation& simulation, std::span<const RandomWay> ways,
        const std::vector<std::vector<Pose>>& poses);

}  // namespace torsion::engine::test
