#pragma once

#include "ecs/frame_world.hpp"
#include "ecs/scene_description.hpp"
#include "render/camera.hpp"

namespace torsion::engine {

/// A camera of the scene file.
Camera camera_of(const CameraDescription& description);

/// A camera that shows the whole of all bodies and tools as `frame` has them, from the front right
/// and above, as one looks at a thing on a table.
/// @param aspect  width / height of the picture
Camera auto_camera(const FrameWorld& frame, double aspect);

}  // namespace torsion::engine
