#include "scenes/materials.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/gltf_accessors.hpp"

namespace torsion::engine {
namespace {

template <class Row>
const Row* row_or_null(const std::vector<Row>& rows, int row) {
  const bool there = row >= 0 && static_cast<std::size_t>(row) < rows.size();
  return there ? &rows[static_cast<std::size_t>(row)] : nullptr;
}

const tinygltf::Material* material_of(const tinygltf::Model& model,
                                      const tinygltf::Primitive& primitive) {
  return row_or_null(model.materials, primitive.material);
}

const tinygltf::Texture* base_texture(const tinygltf::Model& model,
                                      const tinygltf::Material& material) {
  return row_or_null(model.textures, material.pbrMetallicRoughness.baseColorTexture.index);
}

/// Also of what is no number.
float share(double value) {
  return value > 0.0 ? static_cast<float>(std::min(value, 1.0)) : 0.0F;
}

TextureWrap wrap_of(int mode) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return TextureWrap::kClamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return TextureWrap::kMirror;
    default:
      return TextureWrap::kRepeat;
  }
}

double number_or(const tinygltf::Value& object, const char* name, double otherwise) {
  if (!object.IsObject() || !object.Has(name) || !object.Get(name).IsNumber()) {
    return otherwise;
  }
  return object.Get(name).GetNumberAsDouble();
}

glm::dvec2 pair_or(const tinygltf::Value& object, const char* name, const glm::dvec2& otherwise) {
  if (!object.IsObject() || !object.Has(name) || object.Get(name).ArrayLen() != 2) {
    return otherwise;
  }
  const tinygltf::Value& pair = object.Get(name);
  const bool numbers = pair.Get(0).IsNumber() && pair.Get(1).IsNumber();
  return numbers ? glm::dvec2(pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble())
                 : otherwise;
}

}  // namespace

SceneImages read_images(const tinygltf::Model& model) {
  SceneImages images(model.images.size());
  for (const tinygltf::Material& material : model.materials) {
    const tinygltf::Texture* texture = base_texture(model, material);
    const tinygltf::Image* image =
        texture == nullptr ? nullptr : row_or_null(model.images, texture->source);
    if (image == nullptr) {
      continue;
    }
    const auto row = static_cast<std::size_t>(texture->source);
    if (!images[row]) {
      std::string name = !image->uri.empty() ? image->uri : image->name;
      images[row] = std::make_shared<const EncodedImage>(EncodedImage{
          name.empty() ? "images[" + std::to_string(row) + "]" : std::move(name), image->image});
    }
  }
  return images;
}

DrawMaterial read_material(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                           const MeshLook& look) {
  const tinygltf::Material* material = material_of(model, primitive);
  if (material == nullptr) {
    return look.plain;
  }
  const tinygltf::PbrMetallicRoughness& said = material->pbrMetallicRoughness;
  DrawMaterial read;
  for (int i = 0; i < 4 && said.baseColorFactor.size() == 4; ++i) {
    read.color[i] = share(said.baseColorFactor[static_cast<std::size_t>(i)]);
  }
  read.metallic = share(said.metallicFactor);
  read.roughness = share(said.roughnessFactor);
  read.alpha_mode = material->alphaMode == "BLEND" ? AlphaMode::kBlend : AlphaMode::kOpaque;
  const auto scattering = material->extensions.find("KHR_materials_diffuse_transmission");
  if (scattering != material->extensions.end()) {
    read.scattering = share(number_or(scattering->second, "diffuseTransmissionFactor", 0.0));
  }
  const tinygltf::Texture* texture = base_texture(model, *material);
  if (texture != nullptr && texture->source < 0) {
    // Of an extension's kind of image.
    const int row = said.baseColorTexture.index;
    read.texture = std::make_shared<const EncodedImage>(
        EncodedImage{"textures[" + std::to_string(row) + "]", {}});
  } else if (texture != nullptr && row_or_null(look.images, texture->source) != nullptr) {
    read.texture = look.images[static_cast<std::size_t>(texture->source)];
    if (const tinygltf::Sampler* sampler = row_or_null(model.samplers, texture->sampler)) {
      read.wrap_u = wrap_of(sampler->wrapS);
      read.wrap_v = wrap_of(sampler->wrapT);
    }
  }
  return read;
}

std::vector<glm::vec2> read_texcoords(const tinygltf::Model& model,
                                      const tinygltf::Primitive& primitive) {
  const tinygltf::Material* material = material_of(model, primitive);
  if (material == nullptr || base_texture(model, *material) == nullptr) {
    return {};
  }
  const tinygltf::TextureInfo& info = material->pbrMetallicRoughness.baseColorTexture;
  tinygltf::Value transform;
  const auto extension = info.extensions.find("KHR_texture_transform");
  if (extension != info.extensions.end()) {
    transform = extension->second;
  }
  const double set = number_or(transform, "texCoord", static_cast<double>(info.texCoord));
  const auto attribute =
      primitive.attributes.find("TEXCOORD_" + std::to_string(static_cast<int>(set)));
  if (attribute == primitive.attributes.end()) {
    return {};
  }
  const int type = model.accessors[static_cast<std::size_t>(attribute->second)].type;
  if (type != TINYGLTF_TYPE_VEC2) {
    return {};
  }
  // uv' = translation * rotation * scale * uv (KHR_texture_transform).
  const glm::dvec2 scale = pair_or(transform, "scale", glm::dvec2(1.0));
  const glm::dvec2 offset = pair_or(transform, "offset", glm::dvec2(0.0));
  const double angle = number_or(transform, "rotation", 0.0);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const std::vector<double> numbers = read_numbers(model, attribute->second);
  std::vector<glm::vec2> texcoords(numbers.size() / 2);
  for (std::size_t i = 0; i < texcoords.size(); ++i) {
    const double u = scale.x * numbers[2 * i];
    const double v = scale.y * numbers[2 * i + 1];
    texcoords[i] = glm::vec2(glm::dvec2(c * u + s * v + offset.x, c * v - s * u + offset.y));
  }
  return texcoords;
}

std::vector<glm::vec3> read_colors(const tinygltf::Model& model,
                                   const tinygltf::Primitive& primitive) {
  const auto attribute = primitive.attributes.find("COLOR_0");
  if (attribute == primitive.attributes.end()) {
    return {};
  }
  const int type = model.accessors[static_cast<std::size_t>(attribute->second)].type;
  if (type != TINYGLTF_TYPE_VEC3 && type != TINYGLTF_TYPE_VEC4) {
    return {};
  }
  const std::size_t components = type == TINYGLTF_TYPE_VEC3 ? 3 : 4;  // alpha: not drawn
  const std::vector<double> numbers = read_numbers(model, attribute->second);
  std::vector<glm::vec3> colors(numbers.size() / components);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      colors[i][static_cast<int>(c)] = share(numbers[components * i + c]);
    }
  }
  return colors;
}

}  // namespace torsion::engine
