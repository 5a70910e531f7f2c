#include "scenes/materials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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

/// What glTF's textureInfo objects have in common.
struct TextureReference {
  int texture = -1;
  int set = 0;
  const tinygltf::ExtensionMap* extensions = nullptr;
};

using TextureReferences = std::array<TextureReference, kTextureRoles>;

/// Of each role.
TextureReferences references_of(const tinygltf::Material& material) {
  TextureReferences references;
  const auto take = [&](TextureRole role, const auto& info) {
    references[static_cast<std::size_t>(role)] = {info.index, info.texCoord, &info.extensions};
  };
  take(TextureRole::kBaseColor, material.pbrMetallicRoughness.baseColorTexture);
  take(TextureRole::kMetalRoughness, material.pbrMetallicRoughness.metallicRoughnessTexture);
  take(TextureRole::kNormal, material.normalTexture);
  take(TextureRole::kOcclusion, material.occlusionTexture);
  take(TextureRole::kEmission, material.emissiveTexture);
  return references;
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

/// Where a texture has its coordinates: a set of them, moved as KHR_texture_transform says.
struct Coordinates {
  int set = 0;
  glm::dvec2 scale{1.0};
  glm::dvec2 offset{0.0};
  double angle = 0.0;  // rad

  bool operator==(const Coordinates&) const = default;
};

Coordinates coordinates_of(const TextureReference& reference) {
  Coordinates read;
  tinygltf::Value transform;
  const auto extension = reference.extensions->find("KHR_texture_transform");
  if (extension != reference.extensions->end()) {
    transform = extension->second;
  }
  read.set = static_cast<int>(number_or(transform, "texCoord", reference.set));
  read.scale = pair_or(transform, "scale", read.scale);
  read.offset = pair_or(transform, "offset", read.offset);
  read.angle = number_or(transform, "rotation", read.angle);
  return read;
}

/// Of a material's textures: those of the first of them.
std::optional<Coordinates> shared_coordinates(const TextureReferences& references) {
  for (const TextureReference& reference : references) {
    if (reference.texture >= 0) {
      return coordinates_of(reference);
    }
  }
  return std::nullopt;
}

std::shared_ptr<const EncodedImage> undrawn(int texture, const char* fault) {
  return std::make_shared<const EncodedImage>(
      EncodedImage{"textures[" + std::to_string(texture) + "]", {}, fault});
}

MaterialTexture read_texture(const tinygltf::Model& model, const TextureReference& reference,
                             const SceneImages& images, const Coordinates& shared) {
  const tinygltf::Texture* texture = row_or_null(model.textures, reference.texture);
  MaterialTexture read;
  if (texture == nullptr || images.empty()) {
    return read;
  }
  if (coordinates_of(reference) != shared) {
    read.image = undrawn(reference.texture,
                         "its coordinates differ from those of the material's first texture");
  } else if (texture->source < 0) {
    read.image = undrawn(reference.texture, "its image is of an extension's kind");
  } else if (row_or_null(images, texture->source) != nullptr) {
    read.image = images[static_cast<std::size_t>(texture->source)];
  }
  if (const tinygltf::Sampler* sampler = row_or_null(model.samplers, texture->sampler)) {
    read.wrap_u = wrap_of(sampler->wrapS);
    read.wrap_v = wrap_of(sampler->wrapT);
  }
  return read;
}

AlphaMode alpha_mode_of(const tinygltf::Material& material) {
  if (material.alphaMode == "BLEND") {
    return AlphaMode::kBlend;
  }
  return material.alphaMode == "MASK" ? AlphaMode::kMask : AlphaMode::kOpaque;
}

}  // namespace

SceneImages read_images(const tinygltf::Model& model) {
  SceneImages images(model.images.size());
  for (const tinygltf::Material& material : model.materials) {
    for (const TextureReference& reference : references_of(material)) {
      const tinygltf::Texture* texture = row_or_null(model.textures, reference.texture);
      const tinygltf::Image* image =
          texture == nullptr ? nullptr : row_or_null(model.images, texture->source);
      if (image == nullptr) {
        continue;
      }
      const auto row = static_cast<std::size_t>(texture->source);
      if (!images[row]) {
        std::string name = !image->uri.empty() ? image->uri : image->name;
        images[row] = std::make_shared<const EncodedImage>(
            EncodedImage{name.empty() ? "images[" + std::to_string(row) + "]" : std::move(name),
                         image->image,
                         {}});
      }
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
  for (int i = 0; i < 3 && material->emissiveFactor.size() == 3; ++i) {
    read.emission[i] = share(material->emissiveFactor[static_cast<std::size_t>(i)]);
  }
  read.alpha_mode = alpha_mode_of(*material);
  read.double_sided = material->doubleSided;
  read.alpha_cutoff = static_cast<float>(material->alphaCutoff);
  read.normal_scale = static_cast<float>(material->normalTexture.scale);
  read.occlusion_strength = share(material->occlusionTexture.strength);
  const auto scattering = material->extensions.find("KHR_materials_diffuse_transmission");
  if (scattering != material->extensions.end()) {
    read.scattering = share(number_or(scattering->second, "diffuseTransmissionFactor", 0.0));
  }
  const TextureReferences references = references_of(*material);
  if (const auto shared = shared_coordinates(references)) {
    for (std::size_t role = 0; role < kTextureRoles; ++role) {
      read.textures[role] = read_texture(model, references[role], look.images, *shared);
    }
  }
  return read;
}

std::vector<glm::vec2> read_texcoords(const tinygltf::Model& model,
                                      const tinygltf::Primitive& primitive) {
  const tinygltf::Material* material = material_of(model, primitive);
  if (material == nullptr) {
    return {};
  }
  const std::optional<Coordinates> coordinates = shared_coordinates(references_of(*material));
  if (!coordinates) {
    return {};
  }
  const auto attribute = primitive.attributes.find("TEXCOORD_" + std::to_string(coordinates->set));
  if (attribute == primitive.attributes.end()) {
    return {};
  }
  const int type = model.accessors[static_cast<std::size_t>(attribute->second)].type;
  if (type != TINYGLTF_TYPE_VEC2) {
    return {};
  }
  // uv' = translation * rotation * scale * uv (KHR_texture_transform).
  const glm::dvec2& scale = coordinates->scale;
  const glm::dvec2& offset = coordinates->offset;
  const double c = std::cos(coordinates->angle);
  const double s = std::sin(coordinates->angle);
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
