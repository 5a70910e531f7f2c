#pragma once

#include <string>
#include <vector>

#include "ecs/scene_description.hpp"
#include "systems/step.hpp"

namespace torsion::engine {

/// What of a legal scene will disappoint whoever runs it, a sentence each: a tool that never
/// touches, faces coarser than the contact, an exact shape drawn as another one, a texture that is
/// not drawn, a tolerance that nothing reaches.
/// @param poses    what moves the tools, (times) of (tools); empty: unknown
/// @param options  with which the simulation was prepared
std::vector<std::string> scene_warnings(const SceneDescription& scene, const Simulation& simulation,
                                        const std::vector<std::vector<Pose>>& poses,
                                        const PrepareOptions& options);

}  // namespace torsion::engine
