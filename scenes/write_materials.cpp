#include "scenes/write_materials.hpp"

#include <algorithm>
#include <span>

#include "scenes/gltf_rows.hpp"

namespace torsion::engine {
namespace {

int gltf_wrap(TextureWrap wrap) {
  switch (wrap) {
    case TextureWrap::kClamp:
      return TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    case TextureWrap::kMirror:
      return TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    case TextureWrap::kRepeat:
      break;
  }
  return TINYGLTF_TEXTURE_WRAP_REPEAT;
}

template <class Row>
int last_row(const std::vector<Row>& rows) {
  return static_cast<int>(rows.size()) - 1;
}

}  // namespace

const char* mime_type(const std::vector<unsigned char>& bytes) {
  constexpr unsigned char kPngStart = 0x89;
  return !bytes.empty() && bytes[0] == kPngStart ? "image/png" : "image/jpeg";
}

int MaterialWriter::add_texture(const MaterialTexture& texture) {
  if (!texture.image || texture.image->bytes.empty()) {
    return -1;
  }
  const auto found = std::ranges::find(images_, texture.image.get());
  tinygltf::Texture written;
  written.source = static_cast<int>(found - images_.begin());
  if (found == images_.end()) {
    images_.push_back(texture.image.get());
    tinygltf::Image image;
    image.name = texture.image->name;
    image.mimeType = mime_type(texture.image->bytes);
    image.bufferView = append_view(model_, 0, std::as_bytes(std::span(texture.image->bytes)));
    model_.images.push_back(image);
  }
  tinygltf::Sampler sampler;
  sampler.wrapS = gltf_wrap(texture.wrap_u);
  sampler.wrapT = gltf_wrap(texture.wrap_v);
  model_.samplers.push_back(sampler);
  written.sampler = last_row(model_.samplers);
  model_.textures.push_back(written);
  return last_row(model_.textures);
}

int MaterialWriter::add(const DrawMaterial& material, const std::string& name) {
  tinygltf::Material written;
  written.name = name;
  tinygltf::PbrMetallicRoughness& pbr = written.pbrMetallicRoughness;
  for (int i = 0; i < 4; ++i) {
    pbr.baseColorFactor[static_cast<std::size_t>(i)] = static_cast<double>(material.color[i]);
  }
  pbr.metallicFactor = static_cast<double>(material.metallic);
  pbr.roughnessFactor = static_cast<double>(material.roughness);
  written.emissiveFactor.clear();
  for (int i = 0; i < 3; ++i) {
    written.emissiveFactor.push_back(static_cast<double>(material.emission[i]));
  }
  written.doubleSided = material.double_sided;
  if (material.alpha_mode == AlphaMode::kBlend) {
    written.alphaMode = "BLEND";
  } else if (material.alpha_mode == AlphaMode::kMask) {
    written.alphaMode = "MASK";
    written.alphaCutoff = static_cast<double>(material.alpha_cutoff);
  }
  if (material.scattering > 0.0F) {
    constexpr const char* kExtension = "KHR_materials_diffuse_transmission";
    written.extensions[kExtension] = tinygltf::Value(tinygltf::Value::Object{
        {"diffuseTransmissionFactor", tinygltf::Value(static_cast<double>(material.scattering))}});
    if (std::ranges::find(model_.extensionsUsed, kExtension) == model_.extensionsUsed.end()) {
      model_.extensionsUsed.emplace_back(kExtension);
    }
  }
  pbr.baseColorTexture.index = add_texture(material.texture(TextureRole::kBaseColor));
  pbr.metallicRoughnessTexture.index = add_texture(material.texture(TextureRole::kMetalRoughness));
  written.normalTexture.index = add_texture(material.texture(TextureRole::kNormal));
  written.normalTexture.scale = static_cast<double>(material.normal_scale);
  written.occlusionTexture.index = add_texture(material.texture(TextureRole::kOcclusion));
  written.occlusionTexture.strength = static_cast<double>(material.occlusion_strength);
  written.emissiveTexture.index = add_texture(material.texture(TextureRole::kEmission));
  model_.materials.push_back(written);
  return last_row(model_.materials);
}

void embed_images(tinygltf::Model& model) {
  for (tinygltf::Image& image : model.images) {
    if (!image.image.empty() && image.bufferView < 0) {
      image.mimeType = mime_type(image.image);
      if (model.buffers.empty()) {
        model.buffers.emplace_back();
      }
      image.bufferView = append_view(model, 0, std::as_bytes(std::span(image.image)));
      image.uri.clear();
    }
  }
}

}  // namespace torsion::engine
