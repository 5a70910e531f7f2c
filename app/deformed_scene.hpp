#pragma once

#include <vector>

#include "app/session.hpp"
#include "scenes/write_gltf.hpp"

namespace torsion::engine {

/// The bodies as they are deformed after the last step, and the tools where they are.
std::vector<WrittenMesh> deformed_scene(const Session& session);

}  // namespace torsion::engine
