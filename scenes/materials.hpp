#pragma once

#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <tiny_gltf.h>

#include "ecs/draw_material.hpp"

namespace torsion::engine {

/// The bytes of a file's images; null for those that no material has. No bytes: they are not
/// there.
using SceneImages = std::vector<std::shared_ptr<const EncodedImage>>;

SceneImages read_images(const tinygltf::Model& model);

/// How meshes without anything of their own look, and what materials refer to.
struct MeshLook {
  SceneImages images;  // of the file; may be empty: then nothing has a texture
  DrawMaterial plain;  // of primitives without a material
};

/// What glTF's material says, as far as it is drawn: base colour, metal, roughness, emission, all
/// five textures, alpha mode, KHR_materials_diffuse_transmission. Textures whose coordinates differ
/// from the first one's are not drawn.
DrawMaterial read_material(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                           const MeshLook& look);

/// Where each vertex is on its material's textures, KHR_texture_transform applied; nothing where
/// the material has no texture, or the primitive no such coordinates.
std::vector<glm::vec2> read_texcoords(const tinygltf::Model& model,
                                      const tinygltf::Primitive& primitive);

/// Each vertex's COLOR_0, linear rgb; nothing where the primitive has none.
std::vector<glm::vec3> read_colors(const tinygltf::Model& model,
                                   const tinygltf::Primitive& primitive);

}  // namespace torsion::engine
