#pragma once

#include "systems/scratch.hpp"
#include "torsion/simulation.hpp"

namespace torsion {

struct Simulation::Data {
  engine::State state;
  engine::Scratch scratch;
  std::vector<engine::Pose> poses;  // (tools)
};

}  // namespace torsion
