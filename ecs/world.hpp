#pragma once

#include "ecs/model.hpp"
#include "ecs/state.hpp"

namespace torsion::engine {

/// A scene at work: all that one step knows.
struct World {
  Model model;
  State state;
};

}  // namespace torsion::engine
