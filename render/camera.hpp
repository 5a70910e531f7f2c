#pragma once

#include <glm/mat4x4.hpp>

#include "ecs/components.hpp"

namespace torsion::engine {

/// Where a picture is taken from. The camera's frame is glTF's: it looks along -z, +y is up.
struct Camera {
  Pose pose;                            // camera frame in the world
  double vertical_field_of_view = 0.8;  // rad, 0 to pi
  double near_plane = 0.01;             // m, > 0
  double far_plane = 100.0;             // m, > near_plane; 0: infinite
  double shift =
      0.0;  // of the picture's width: what is straight ahead is so far right of its middle
};

/// World to camera frame.
glm::dmat4 view_matrix(const Camera& camera);

/// Camera frame to Vulkan's clip space: x right, y down, depth 0 at the near plane to 1 at the far
/// plane.
/// @param aspect  width / height of the picture
glm::dmat4 projection_matrix(const Camera& camera, double aspect);

}  // namespace torsion::engine
