#include "app/run_page/page_materials.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "app/base64.hpp"
#include "render/srgb.hpp"
#include "render/studio_light.hpp"
#include "scenes/write_materials.hpp"

namespace torsion::engine {
namespace {

const char* wrap_name(TextureWrap wrap) {
  switch (wrap) {
    case TextureWrap::kClamp:
      return "clamp";
    case TextureWrap::kMirror:
      return "mirror";
    case TextureWrap::kRepeat:
      break;
  }
  return "repeat";
}

const char* alpha_name(AlphaMode mode) {
  switch (mode) {
    case AlphaMode::kOpaque:
      return "opaque";
    case AlphaMode::kMask:
      return "mask";
    case AlphaMode::kBlend:
      return "blend";
    case AlphaMode::kUnsaid:
      break;
  }
  return "unsaid";
}

std::string data_address(const EncodedImage& image) {
  return std::string("data:") + mime_type(image.bytes) + ";base64," + base64_of(image.bytes);
}

/// Images that can be shown, each once.
std::vector<const EncodedImage*> images_of(const std::vector<DrawMaterial>& materials) {
  std::vector<const EncodedImage*> images;
  for (const DrawMaterial& material : materials) {
    for (const MaterialTexture& texture : material.textures) {
      const EncodedImage* image = texture.image.get();
      if (image != nullptr && !image->bytes.empty() &&
          std::ranges::find(images, image) == images.end()) {
        images.push_back(image);
      }
    }
  }
  return images;
}

}  // namespace

std::uint32_t PageMaterials::row_of(const DrawMaterial& material) {
  const auto found = std::ranges::find(rows_, material);
  const auto row = static_cast<std::uint32_t>(found - rows_.begin());
  if (found == rows_.end()) {
    rows_.push_back(material);
  }
  return row;
}

nlohmann::json PageMaterials::look_of(const WrittenMesh& mesh) {
  nlohmann::json runs = nlohmann::json::array();
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  for (const MaterialRun& run : material_runs(mesh.triangle_materials, triangles)) {
    runs.push_back(
        {run.triangles.first, run.triangles.count, row_of(mesh.materials[run.material])});
  }
  return {
      {"runs", runs}, {"texcoords", base64_of(mesh.texcoords)}, {"paint", base64_of(mesh.colors)}};
}

nlohmann::json PageMaterials::materials() const {
  const std::vector<const EncodedImage*> images = images_of(rows_);
  nlohmann::json rows = nlohmann::json::array();
  for (const DrawMaterial& material : rows_) {
    nlohmann::json textures = nlohmann::json::array();
    for (const MaterialTexture& texture : material.textures) {
      const auto found = std::ranges::find(images, texture.image.get());
      textures.push_back({{"image", found == images.end() ? -1 : found - images.begin()},
                          {"wrap", {wrap_name(texture.wrap_u), wrap_name(texture.wrap_v)}}});
    }
    const glm::vec4& color = material.color;
    const glm::vec3& emission = material.emission;
    rows.push_back({{"color", {color.x, color.y, color.z, color.w}},
                    {"metal", material.metallic},
                    {"roughness", material.roughness},
                    {"emission", {emission.x, emission.y, emission.z}},
                    {"alpha", alpha_name(material.alpha_mode)},
                    {"cutoff", material.alpha_cutoff},
                    {"double_sided", material.double_sided},
                    {"normal_scale", material.normal_scale},
                    {"occlusion_strength", material.occlusion_strength},
                    {"textures", textures}});
  }
  return rows;
}

nlohmann::json PageMaterials::images() const {
  nlohmann::json addresses = nlohmann::json::array();
  for (const EncodedImage* image : images_of(rows_)) {
    addresses.push_back(data_address(*image));
  }
  return addresses;
}

nlohmann::json studio_sides() {
  constexpr int kSide = 32;
  nlohmann::json sides = nlohmann::json::array();
  for (int side = 0; side < 6; ++side) {
    std::vector<std::uint8_t> rgb;
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const double s = 2.0 * (column + 0.5) / kSide - 1.0;
        const double t = 2.0 * (row + 0.5) / kSide - 1.0;
        const std::array<glm::dvec3, 6> directions = {
            glm::dvec3(1.0, -t, -s), glm::dvec3(-1.0, -t, s), glm::dvec3(s, 1.0, t),
            glm::dvec3(s, -1.0, -t), glm::dvec3(s, -t, 1.0),  glm::dvec3(-s, -t, -1.0)};
        glm::dvec3 direction = glm::normalize(directions[static_cast<std::size_t>(side)]);
        direction.x = -direction.x;
        const glm::dvec3 light = studio_radiance(direction);
        for (int lane = 0; lane < 3; ++lane) {
          const double value = srgb_encoded(std::min(light[lane], 1.0));
          rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0 * value)));
        }
      }
    }
    sides.push_back(base64_of(rgb));
  }
  return sides;
}

}  // namespace torsion::engine
