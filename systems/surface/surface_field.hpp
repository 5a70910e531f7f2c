#pragma once

#include "ecs/frame_world.hpp"
#include "ecs/scene_description.hpp"
#include "ecs/snapshot.hpp"
#include "ecs/state.hpp"

namespace torsion::engine {

/// Load-time work for the frame: vertices, triangles, and the interpolation from anchors. `world`
/// is the prepared world of the same scene.
FrameWorld prepare_frame(const SceneDescription& scene, const Model& model, const State& state);

/// What the snapshot means for the drawn surface: for each vertex a twist angle about each region's
/// axis and a displacement, and the tools' poses. Runs at frame rate. Reads `world` only where it
/// is constant after load. A vertex goes to  x = turned(rest) + displacement, where turned()
/// rotates about the axes of the slots 0..regions_drawn-1 in order (regions in their order of
/// formation).
void surface_field(const Model& model, const Snapshot& snapshot, FrameWorld& frame);

/// The CPU twin of shaders/deform.comp: positions [m, body] of `body`'s vertices from the columns
/// of `frame`.
/// @param positions  (vertices of the body) out: xyz m, w the sum of the twist angles, rad
void deform_vertices(const FrameWorld& frame, std::uint32_t body, std::span<glm::vec4> positions);

}  // namespace torsion::engine
