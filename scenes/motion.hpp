#pragma once

#include <vector>

#include <tiny_gltf.h>

#include "ecs/motion_script.hpp"
#include "scenes/node_tree.hpp"
#include "scenes/problem.hpp"

namespace torsion::engine {

/// How the scene node `tool` moves by the animations of the file. Scaling the tool is a problem,
/// and so is turning it below a scale that differs along x, y, z: a rigid tool keeps its shape.
MotionScript read_motion(const tinygltf::Model& model, const std::vector<SceneNode>& nodes,
                         std::size_t tool, const ProblemList& problems);

/// True when an animation moves this row of the file's nodes.
bool is_animated(const tinygltf::Model& model, std::size_t row);

/// Notes properties of a node that two channels move at once.
void check_channels(const tinygltf::Model& model, const ProblemList& problems);

}  // namespace torsion::engine
