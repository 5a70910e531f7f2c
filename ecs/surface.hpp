#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace torsion::engine {

/// A triangle mesh outside the tables: what load-time work reads. For physics it is welded, closed
/// and oriented (counter-clockwise seen from outside).
struct SurfaceMesh {
  std::vector<glm::dvec3> positions;  // m
  std::vector<glm::uvec3> triangles;  // rows of positions
};

}  // namespace torsion::engine
