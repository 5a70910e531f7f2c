#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/components.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// One mesh of a written glTF, under a node of its own.
struct WrittenMesh {
  std::string name;
  Pose pose;                         // mesh to world
  std::vector<glm::vec3> positions;  // m
  std::vector<glm::vec3> normals;    // unit; as many as positions
  std::vector<glm::uvec3> triangles;
  std::vector<float> twist_angles;          // rad: attribute _TWIST_ANGLE; may be empty
  std::vector<glm::vec3> rest_positions;    // m: attribute _REST_POSITION; may be empty
  glm::vec4 color{0.8F, 0.8F, 0.8F, 1.0F};  // linear RGB and alpha
};

/// The bytes of a .glb, or of a .gltf with its buffer inside.
Result<std::string> gltf_bytes(const std::vector<WrittenMesh>& meshes, bool binary);

}  // namespace torsion::engine
