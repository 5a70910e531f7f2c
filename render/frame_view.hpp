#pragma once

// What the shaders need to know of a scene and a camera, as plain numbers: no Vulkan.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "ecs/frame_world.hpp"
#include "ecs/snapshot.hpp"
#include "render/camera.hpp"
#include "render/draw_options.hpp"
#include "shaders/shared.h"

namespace torsion::engine {

/// Where the things of a scene are at the start.
struct SceneExtent {
  glm::dvec3 lowest{0.0};  // m, world: box around the bodies at rest
  glm::dvec3 highest{0.0};
  glm::dvec3 center{0.0};           // m, world: ball around bodies and tools, for the shadow map
  double radius = 1.0;              // m
  std::vector<shared::vec4> grids;  // for each body: DrawConstants::grid
  std::vector<shared::vec4> tool_centers;  // for each tool: middle of its box, m, tool
  std::vector<double> arc_radii;           // for each tool: of the arc that shows its torque, m
};

/// @param frame  with the tools' first poses
SceneExtent scene_extent(const FrameWorld& frame);

/// The largest of 1, 2, 5 times a power of ten with at least ten lines across `size` [m]. 0 for a
/// size of 0.
double grid_spacing(double size);

/// @param aspect  width / height of the picture
/// @param shadow_size  texels along the side of the shadow map
shared::FrameUniforms frame_uniforms(const SceneExtent& extent, const Camera& camera, double aspect,
                                     std::uint32_t shadow_size, const DrawOptions& options);

/// Fills in DrawConstants::to_world.
void set_pose(const Pose& pose, shared::DrawConstants& constants);

/// The contact regions of each body: `spots` in the order of bodies, `ranges` one row for each
/// body.
/// @pre both have memory for all regions and bodies, so that nothing is allocated
void contact_spots(const Snapshot& snapshot, std::uint32_t bodies,
                   std::vector<shared::ContactSpot>& spots, std::vector<Range>& ranges);

}  // namespace torsion::engine
