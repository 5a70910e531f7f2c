#include "systems/scratch.hpp"

namespace torsion {

void Scratch::reserve(const World& world) {
  contact.reserve(world);
  paper.reserve(world);
  patch.reserve(world);
  skeleton.reserve(world);
  compliance.reserve(world);
  if (!world.mdr_layers.empty()) {
    mdr = make_mdr_tables();
  }
  if (!world.patch_cells.empty()) {
    rings = make_ring_profiles();
  }
}

StepContext Scratch::context(World& world, std::span<const Pose> tool_poses) {
  return {world, tool_poses, contact, paper, mdr, patch, skeleton, compliance, rings};
}

}  // namespace torsion
