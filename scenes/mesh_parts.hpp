#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include "ecs/scene_description.hpp"
#include "scenes/materials.hpp"
#include "scenes/problem.hpp"

namespace torsion::engine {

/// The triangles of one mesh in its owner's frame, vertices as the file has them.
struct MeshTriangles {
  std::vector<glm::dvec3> positions;  // m
  std::vector<glm::dvec3> normals;    // unit; as many as positions, or none where the file has none
  std::vector<double> fixed;          // the _FIXED attribute, as many as positions, or none
  std::vector<glm::vec2> texcoords;   // as many as positions, or none
  std::vector<glm::vec3> colors;      // linear rgb; as many as positions, or none
  std::vector<glm::uvec3> triangles;  // counter-clockwise seen from outside
  std::vector<DrawMaterial> materials;            // one for each primitive
  std::vector<std::uint32_t> triangle_materials;  // one for each triangle
};

/// All primitives of a mesh: lists, strips and fans of triangles. Points and lines are problems. A
/// mirroring `to_owner` turns the triangles about.
/// @param to_owner  mesh to owner's frame, scale included
MeshTriangles read_mesh(const tinygltf::Model& model, const tinygltf::Mesh& mesh,
                        const glm::dmat4& to_owner, const MeshLook& look, const std::string& where,
                        const ProblemList& problems);

/// Appends to what is drawn; normals that the file lacks are averaged from the faces.
void append_draw_mesh(const MeshTriangles& mesh, DrawMesh& draw);

}  // namespace torsion::engine
