#pragma once

// What is drawn: rows that the GPU reads as they are, float, 16-byte rows or single floats.
// Units, frames and "written by": ecs/components.hpp.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/range.hpp"

namespace torsion::engine {

/// Written by: load.
struct VertexRest {
  glm::vec4 position{0.0F};  // m, body; w = 1 if the vertex is fixed, else 0
};

/// Written by: load.
struct VertexNormal {
  glm::vec4 normal{0.0F};  // body, unit; w unused, 0
};

/// Written by: load.
struct VertexPaint {
  glm::vec2 uv{0.0F};     // of the base colour's texture, (0, 0) at its top left
  glm::vec3 color{0.0F};  // linear rgb, times the material's; white where the mesh has none
};

/// Written by: surface_field.
struct VertexDisplacement {
  glm::vec4 displacement{0.0F};  // m, body; w = normal contact pressure, Pa, for the heat map
};

/// Twist about one region's axis. Rows of a body: region-major, kMaxRegionsPerBody blocks of its
/// vertex count. Written by: surface_field.
struct TwistAngle {
  float angle = 0.0F;  // rad
};

/// Three vertex rows, relative to the body's first vertex. Written by: load.
struct Triangle {
  glm::uvec3 vertices{0};
};

/// The axis about which a body's region slot turns vertices. Written by: surface_field.
struct TwistAxis {
  glm::vec4 point{0.0F};      // m, body; w unused, 0
  glm::vec4 direction{0.0F};  // body, unit; w unused, 0
};

/// One drawn thing: a body, or a tool. Written by: load.
struct DrawRange {
  Range vertices;   // in the vertex table of its kind
  Range triangles;  // likewise
  Range groups;     // likewise
};

/// Triangles of one drawn thing that have one material. Written by: load.
struct DrawGroup {
  Range triangles;             // in the triangle table of its kind
  std::uint32_t material = 0;  // row of FrameWorld::materials
};

}  // namespace torsion::engine
