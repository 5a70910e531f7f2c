#include "scenes/write_materials.hpp"

#include <algorithm>
#include <cstring>

namespace torsion::engine {
namespace {

/// What an image's first byte says; glTF has PNG and JPEG (glTF 2.0, section 3.8.3).
const char* mime_type(const std::vector<unsigned char>& bytes) {
  constexpr unsigned char kPngStart = 0x89;
  return !bytes.empty() && bytes[0] == kPngStart ? "image/png" : "image/jpeg";
}

/// @return row of the model's views
int append_view(tinygltf::Model& model, const std::vector<unsigned char>& bytes) {
  if (model.buffers.empty()) {
    model.buffers.emplace_back();
  }
  std::vector<unsigned char>& data = model.buffers[0].data;
  data.resize((data.size() + 3) / 4 * 4);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();
  view.byteLength = bytes.size();
  data.insert(data.end(), bytes.begin(), bytes.end());
  model.bufferViews.push_back(view);
  return static_cast<int>(model.bufferViews.size()) - 1;
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
    image.bufferView = append_view(model_, material.texture->bytes);
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
      image.bufferView = append_view(model, image.image);
      image.uri.clear();
    }
  }
}

}  // namespace torsion::engine
