#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/components.hpp"
#include "ecs/draw_material.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// One mesh of a written glTF, under a node of its own.
struct WrittenMesh {
  std::string name;
  Pose pose;                         // mesh to world
  std::vector<glm::vec3> positions;  // m
  std::vector<glm::vec3> normals;    // unit; as many as positions
  std::vector<glm::uvec3> triangles;
  std::vector<float> twist_angles;         // rad: attribute _TWIST_ANGLE; may be empty
  std::vector<glm::vec3> rest_positions;   // m: attribute _REST_POSITION; may be empty
  std::vector<glm::vec2> texcoords;        // as many as positions; may be empty
  std::vector<glm::vec3> colors;           // linear rgb, likewise
  std::vector<DrawMaterial> materials{1};  // as DrawMesh has them
  std::vector<std::uint32_t> triangle_materials;
};

/// What a mesh is at one time, beside its rest: differences of each vertex's place and normal.
struct MorphTarget {
  std::vector<glm::vec3> positions;  // m
  std::vector<glm::vec3> normals;
  std::vector<float> twist_angles;  // rad, not differences; glTF has no place for them
};

/// A mesh that moves as a whole, or bends, or neither.
struct AnimatedMesh {
  WrittenMesh rest;
  std::vector<Pose> poses;           // (times), of the node; or empty
  std::vector<MorphTarget> targets;  // (times); or empty
};

/// The bytes of a .glb, or of a .gltf with its buffer inside, of meshes that move: nodes by keys,
/// vertices by one morph target a time, whose weights go linearly from one to the next.
/// @param times  s, of the keys, strictly increasing, at least one
Result<std::string> animated_gltf_bytes(const std::vector<AnimatedMesh>& meshes,
                                        const std::vector<float>& times, bool binary);

/// The bytes of a .glb, or of a .gltf with its buffer inside.
Result<std::string> gltf_bytes(const std::vector<WrittenMesh>& meshes, bool binary);

}  // namespace torsion::engine
