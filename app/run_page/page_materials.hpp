#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "ecs/draw_material.hpp"
#include "scenes/write_gltf.hpp"

namespace torsion::engine {

/// The materials of a page's meshes and their images, each once.
class PageMaterials {
 public:
  /// What a mesh has of them: its runs of triangles, each with the row of its material, and its
  /// texture coordinates and colours.
  nlohmann::json look_of(const WrittenMesh& mesh);

  /// All rows: materials, and images as data: addresses.
  [[nodiscard]] nlohmann::json materials() const;
  [[nodiscard]] nlohmann::json images() const;

 private:
  std::uint32_t row_of(const DrawMaterial& material);

  std::vector<DrawMaterial> rows_;
};

/// The light that surfaces mirror, as the six sides of a cube in WebGL's order, sRGB bytes: x from
/// the other side, as three.js looks them up.
nlohmann::json studio_sides();

}  // namespace torsion::engine
