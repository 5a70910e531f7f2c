#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "ecs/frame_world.hpp"

namespace torsion::engine {

/// Which triangles' normals make a vertex's normal, as fans of neighbours around it. Vertices that
/// were split in the file (at a texture seam, say) but lie at one place with one normal share a
/// ring, so no seam shows; vertices at one place with different normals (a hard edge) each see only
/// their own triangles, so the edge stays hard.
struct NormalRings {
  std::vector<glm::uvec2>
      ranges;  // one for each row of FrameWorld::body_vertices: first entry and their number
  std::vector<std::uint32_t>
      entries;  // a neighbour, counted from the body's first vertex; the top bit begins a fan
};

/// Load-time work over all bodies of `frame`, from their vertices at rest.
NormalRings make_normal_rings(const FrameWorld& frame);

/// The CPU twin of shaders/normals.comp: unit normals of one body's vertices, for which the
/// vectors' sum of the cross products of neighbouring edges (twice the area times the normal of
/// each triangle around) gives the direction.
/// @param body        row in frame.bodies
/// @param positions   (vertices of the body) deformed, m, body
/// @param normals     (vertices of the body) out, w = 0; a vertex without area around it keeps its
/// normal at rest Source: area weights, Gouraud 1971 with the weights of Thürmer's comparison
/// (1998) at "mean weighted by area".
void vertex_normals(const FrameWorld& frame, const NormalRings& rings, std::uint32_t body,
                    std::span<const glm::vec4> positions, std::span<glm::vec4> normals);

}  // namespace torsion::engine
