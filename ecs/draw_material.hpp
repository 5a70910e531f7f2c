#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/range.hpp"

namespace torsion::engine {

/// An image as its file has it, PNG or JPEG: it is decoded where it is drawn.
struct EncodedImage {
  std::string name;  // of the image or its file, for messages
  std::vector<unsigned char> bytes;
  std::string fault;  // why it is not drawn, for messages; then there are no bytes
};

/// glTF's alphaMode.
enum class AlphaMode : std::uint8_t {
  kUnsaid,  // there is no material: a body is opaque, a tool is glass
  kOpaque,
  kMask,  // what has less alpha than the cutoff is not there
  kBlend,
};

/// glTF's sampler.wrapS and wrapT.
enum class TextureWrap : std::uint8_t { kRepeat, kMirror, kClamp };

/// What a texture of a material is for. All of them have the same coordinates.
enum class TextureRole : std::uint8_t {
  kBaseColor,       // sRGB and alpha, times the colour
  kMetalRoughness,  // linear: green times the roughness, blue times the metal
  kNormal,          // linear, tangent space
  kOcclusion,       // linear: red is the share of the light from all around that arrives
  kEmission,        // sRGB, times the emission
};
inline constexpr std::size_t kTextureRoles = 5;

struct MaterialTexture {
  std::shared_ptr<const EncodedImage> image;  // null: none
  TextureWrap wrap_u = TextureWrap::kRepeat;
  TextureWrap wrap_v = TextureWrap::kRepeat;

  bool operator==(const MaterialTexture&) const = default;
};

/// How a surface looks: glTF's metallic-roughness material (glTF 2.0, section 3.9).
struct DrawMaterial {
  glm::vec4 color{0.8F, 0.8F, 0.8F, 1.0F};  // linear RGB and alpha
  float metallic = 0.0F;                    // 0: dielectric, 1: metal
  float roughness = 0.6F;                   // 0 to 1, the square root of GGX's alpha
  float scattering = 0.0F;   // KHR_materials_diffuse_transmission: share of light let through
  glm::vec3 emission{0.0F};  // linear RGB: light of its own, beside which lit white is 1
  float alpha_cutoff = 0.5F;
  float normal_scale = 1.0F;        // of the normals' tangential part
  float occlusion_strength = 1.0F;  // 0: the texture counts for nothing, 1: in full
  AlphaMode alpha_mode = AlphaMode::kUnsaid;
  bool double_sided = false;  // seen from behind, too
  std::array<MaterialTexture, kTextureRoles> textures;

  [[nodiscard]] MaterialTexture& texture(TextureRole role) {
    return textures[static_cast<std::size_t>(role)];
  }
  [[nodiscard]] const MaterialTexture& texture(TextureRole role) const {
    return textures[static_cast<std::size_t>(role)];
  }

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
