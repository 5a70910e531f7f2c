#include "scenes/write_materials.hpp"

#include <algorithm>
#include <span>

#include "scenes/gltf_rows.hpp"

namespace torsion::engine {
namespace {

/// What an image's first byte says; glTF has PNG and JPEG (glTF 2.0, section 3.8.3).
const char* mime_type(const std::vector<unsigned char>& bytes) {
  constexpr unsigned char kPngStart = 0x89;
  return !bytes.empty() && bytes[0] == kPngStart ? "image/png" : "image/jpeg";
}

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

int MaterialWriter::texture_of(const DrawMaterial& material) {
  const auto found = std::ranges::find(images_, material.texture.get());
  tinygltf::Texture texture;
  texture.source = static_cast<int>(found - images_.begin());
  if (found == images_.end()) {
    images_.push_back(material.texture.get());
    tinygltf::Image image;
    image.name = material.texture->name;
    image.mimeType = mime_type(material.texture->bytes);
    image.bufferView = append_view(model_, 0, std::as_bytes(std::span(material.texture->bytes)));
    model_.images.push_back(image);
  }
  tinygltf::Sampler sampler;
  sampler.wrapS = gltf_wrap(material.wrap_u);
  sampler.wrapT = gltf_wrap(material.wrap_v);
  model_.samplers.push_back(sampler);
  texture.sampler = last_row(model_.samplers);
  model_.textures.push_back(texture);
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
  if (material.alpha_mode == AlphaMode::kBlend) {
    written.alphaMode = "BLEND";
  }
  if (material.scattering > 0.0F) {
    constexpr const char* kExtension = "KHR_materials_diffuse_transmission";
    written.extensions[kExtension] = tinygltf::Value(tinygltf::Value::Object{
        {"diffuseTransmissionFactor", tinygltf::Value(static_cast<double>(material.scattering))}});
    if (std::ranges::find(model_.extensionsUsed, kExtension) == model_.extensionsUsed.end()) {
      model_.extensionsUsed.emplace_back(kExtension);
    }
  }
  if (material.texture && !material.texture->bytes.empty()) {
    pbr.baseColorTexture.index = texture_of(material);
  }
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
