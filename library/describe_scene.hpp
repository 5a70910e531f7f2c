#pragma once

#include "ecs/scene_description.hpp"
#include "torsion/scene.hpp"

namespace torsion {

struct SceneFile {
  engine::SceneDescription scene;
};

/// The scene as load-time work takes it. The error has everything that is wrong, one a line.
Result<engine::SceneDescription> describe(const Scene& scene);

/// A scene as its file has it.
Scene scene_of(engine::SceneDescription description);

}  // namespace torsion
