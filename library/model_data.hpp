#pragma once

#include "systems/step.hpp"
#include "torsion/simulation.hpp"

namespace torsion {

struct Model::Data {
  Scene scene;
  engine::SceneDescription description;
  engine::Simulation prepared;  // never stepped: its state is that of a new simulation

  [[nodiscard]] const engine::Model& model() const { return prepared.world.model; }
};

}  // namespace torsion
