#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "ecs/range.hpp"

namespace torsion::engine {

/// An image as its file has it, PNG or JPEG: it is decoded where it is drawn.
struct EncodedImage {
  std::string name;  // of the image or its file, for messages
  std::vector<unsigned char> bytes;
};

/// glTF's alphaMode, as far as it is drawn: MASK is taken as OPAQUE.
enum class AlphaMode : std::uint8_t {
  kUnsaid,  // there is no material: a body is opaque, a tool is glass
  kOpaque,
  kBlend,
};

/// glTF's sampler.wrapS and wrapT.
enum class TextureWrap : std::uint8_t { kRepeat, kMirror, kClamp };

/// How a surface looks: glTF's metallic-roughness material (glTF 2.0, section 3.9).
struct DrawMaterial {
  glm::vec4 color{0.8F, 0.8F, 0.8F, 1.0F};  // linear RGB and alpha
  float metallic = 0.0F;                    // 0: dielectric, 1: metal
  float roughness = 0.6F;                   // 0 to 1, the square root of GGX's alpha
  float scattering = 0.0F;  // KHR_materials_diffuse_transmission: share of light let through
  AlphaMode alpha_mode = AlphaMode::kUnsaid;
  TextureWrap wrap_u = TextureWrap::kRepeat;
  TextureWrap wrap_v = TextureWrap::kRepeat;
  std::shared_ptr<const EncodedImage> texture;  // of the base colour, sRGB; null: none

  bool operator==(const DrawMaterial&) const = default;
};

/// Triangles one after another that have one material.
struct MaterialRun {
  Range triangles;
  std::uint32_t material = 0;
};

/// The runs of a mesh.
/// @param materials  (triangles) their materials; empty: all have the first
inline std::vector<MaterialRun> material_runs(std::span<const std::uint32_t> materials,
                                              std::uint32_t triangles) {
  std::vector<MaterialRun> runs;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const std::uint32_t material = materials.empty() ? 0 : materials[i];
    if (runs.empty() || runs.back().material != material) {
      runs.push_back({{i, 0}, material});
    }
    runs.back().triangles.count += 1;
  }
  return runs;
}

}  // namespace torsion::engine
