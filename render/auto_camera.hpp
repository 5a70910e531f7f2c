#pragma once

#include <span>
#include <vector>

#include "ecs/frame_world.hpp"
#include "ecs/scene_description.hpp"
#include "render/camera.hpp"

namespace torsion::engine {

/// A camera of the scene file.
Camera camera_of(const CameraDescription& description);

/// A camera that shows the whole of all bodies and tools as `frame` has them, and near the bodies
/// the tools on their way, with the longest arrow over them: from the front right and above, as one
/// looks at a thing on a table.
/// @param aspect  width / height of the picture
/// @param poses   (times) of (tools), where they will be; may be empty
Camera auto_camera(const FrameWorld& frame, double aspect,
                   std::span<const std::vector<Pose>> poses = {});

}  // namespace torsion::engine
