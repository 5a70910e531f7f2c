#pragma once

#include <span>
#include <vector>

#include "ecs/model.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// Cuts what is drawn of the bodies finely enough to show dent and twist: everywhere a sixteenth of
/// the body's longest side, and where the tools' expected way touches it, edges shorter than the
/// contact's radius.
/// @param model  prepared of the scene
/// @param poses  as PrepareOptions::expected_poses
void refine_drawn_bodies(SceneDescription& scene, const Model& model,
                         std::span<const std::vector<Pose>> poses);

}  // namespace torsion::engine
