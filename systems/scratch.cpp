#include "systems/scratch.hpp"

#include "systems/step.hpp"

namespace torsion {

void Scratch::reserve(const Model& model, State& state) {
  contact.reserve(model, state);
  paper.reserve(model);
  patch.reserve(model, state);
  compliance.reserve(state);
  if (!state.mdr_layers.empty()) {
    mdr = make_mdr_tables();
  }
  schedule = Schedule<StepContext>(step_systems(), context(model, state, {}));
}

StepContext Scratch::context(const Model& model, State& state, std::span<const Pose> tool_poses) {
  return {model, state, tool_poses, contact, paper, mdr, patch, compliance};
}

}  // namespace torsion
