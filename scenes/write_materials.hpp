#pragma once

#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "ecs/draw_material.hpp"

namespace torsion::engine {

/// What an image's first byte says; glTF has PNG and JPEG (glTF 2.0, section 3.8.3).
const char* mime_type(const std::vector<unsigned char>& bytes);

/// Writes materials into a model, each image once. The model's first buffer takes the images.
class MaterialWriter {
 public:
  explicit MaterialWriter(tinygltf::Model& model) : model_(model) {}

  /// @return row of the model's materials
  int add(const DrawMaterial& material, const std::string& name);

 private:
  /// @return row of the model's textures; -1 where there is none that can be drawn
  int add_texture(const MaterialTexture& texture);

  tinygltf::Model& model_;
  std::vector<const EncodedImage*> images_;  // rows of the model's images
};

/// Puts every image that has bytes into the first buffer, so that the model needs no file beside
/// it. One is made where there is no buffer.
void embed_images(tinygltf::Model& model);

}  // namespace torsion::engine
