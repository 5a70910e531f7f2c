#pragma once

#include <vector>

#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// The scene of one case of tests/reference/finite_elements/cases.py, y up: its z is our y, its y
/// our -z.
struct ElementScene {
  std::string name;  // of the case
  std::string title;
  std::string description;
  SceneDescription scene;
  Pose touching;            // of the tool when it just touches, world
  bool finite_body = true;  // false: stands for a half-space
  bool flat_top = true;     // twist fields are compared on flat tops only
};

std::vector<ElementScene> element_scenes();

}  // namespace torsion::engine
