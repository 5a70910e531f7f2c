#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "ecs/scene_description.hpp"
#include "systems/step.hpp"

namespace torsion::engine::test {

/// What one tool of a random scene does, in axes of its own: it comes down along -y and is pressed
/// in, slides and turns about y at that depth, goes the same way back, and leaves.
struct RandomWay {
  glm::dquat axes{1.0, 0.0, 0.0, 0.0};  // in the world
  glm::dvec2 beside{0.0};               // m, x and z: where over the body
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  double depth = 0.0;     // m
  glm::dvec2 slide{0.0};  // m
  double turn = 0.0;      // rad
};

/// A body, tools, materials, models and a rate, all of a seed.
struct RandomScene {
  SceneDescription scene;
  PrepareOptions options;
  std::vector<RandomWay> ways;  // (tools)
  double size = 0.0;            // m, of the body's longest side
  std::string text;             // what it is, a line
};

/// Sizes from 1 um to 100 m, E from 1 to 1e12 Pa, nu 0 to 0.5, mu 0 to 10, 100 Hz to 100 kHz; exact
/// shapes and meshes, also coarse ones with sharp edges, one or two parts, one or two tools.
RandomScene random_scene(std::uint64_t seed);

/// A column on its end that two tools pinch from both sides, and along which they mostly slide
/// together; materials, models and the rate as above.
RandomScene random_pinch(std::uint64_t seed);

/// The same as random_scene with each tool over an edge of the body, a little before or beyond it.
RandomScene random_scene_at_edge(std::uint64_t seed);

}  // namespace torsion::engine::test
