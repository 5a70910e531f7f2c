#include "systems/scratch.hpp"

namespace torsion {

void Scratch::reserve(const World& world) {
  contact.reserve(world);
  paper.reserve(world);
  patch.reserve(world);
  compliance.reserve(world);
  if (!world.mdr_layers.empty()) {
    mdr = make_mdr_tables();
  }
}

StepContext Scratch::context(World& world, std::span<const Pose> tool_poses) {
  return {world, tool_poses, contact, paper, mdr, patch, compliance};
}

}  // namespace torsion
