#include "scenes/gltf_accessors.hpp"

#include <algorithm>
#include <cstring>

namespace torsion::engine {
namespace {

template <class T>
T value_at(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// One component as the number that it stands for: normalised integers become 0 to 1 or -1 to 1
/// (glTF 2.0, 3.6.2.2).
double component(const unsigned char* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const auto value = static_cast<double>(value_at<std::int8_t>(bytes));
      return normalized ? std::max(value / 127.0, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const auto value = static_cast<double>(*bytes);
      return normalized ? value / 255.0 : value;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const auto value = static_cast<double>(value_at<std::int16_t>(bytes));
      return normalized ? std::max(value / 32767.0, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const auto value = static_cast<double>(value_at<std::uint16_t>(bytes));
      return normalized ? value / 65535.0 : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<double>(value_at<std::uint32_t>(bytes));
    default:
      return static_cast<double>(value_at<float>(bytes));
  }
}

/// Where elements lie in a buffer.
struct Elements {
  const unsigned char* first;
  std::size_t stride;  // bytes
  std::size_t components;
  std::size_t component_bytes;
  int type;
  bool normalized;

  void read(std::size_t element, double* out) const {
    const unsigned char* bytes = first + element * stride;
    for (std::size_t i = 0; i < components; ++i) {
      out[i] = component(bytes + i * component_bytes, type, normalized);
    }
  }
};

Elements elements_of(const tinygltf::Model& model, int view, std::size_t offset, int type,
                     std::size_t components, bool normalized, bool may_stride) {
  const tinygltf::BufferView& from = model.bufferViews[static_cast<std::size_t>(view)];
  const auto& data = model.buffers[static_cast<std::size_t>(from.buffer)].data;
  const auto component_bytes =
      static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
  const std::size_t packed = components * component_bytes;
  return {data.data() + from.byteOffset + offset,
          may_stride && from.byteStride != 0 ? from.byteStride : packed,
          components,
          component_bytes,
          type,
          normalized};
}

}  // namespace

std::vector<double> read_numbers(const tinygltf::Model& model, int accessor) {
  const tinygltf::Accessor& from = model.accessors[static_cast<std::size_t>(accessor)];
  const auto components = static_cast<std::size_t>(
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(from.type)));
  std::vector<double> numbers(from.count * components, 0.0);
  if (from.bufferView >= 0) {
    const Elements elements = elements_of(model, from.bufferView, from.byteOffset,
                                          from.componentType, components, from.normalized, true);
    for (std::size_t element = 0; element < from.count; ++element) {
      elements.read(element, numbers.data() + element * components);
    }
  }
  if (from.sparse.isSparse) {
    const auto& sparse = from.sparse;
    const Elements places = elements_of(model, sparse.indices.bufferView,
                                        static_cast<std::size_t>(sparse.indices.byteOffset),
                                        sparse.indices.componentType, 1, false, false);
    const Elements values = elements_of(model, sparse.values.bufferView,
                                        static_cast<std::size_t>(sparse.values.byteOffset),
                                        from.componentType, components, from.normalized, false);
    for (std::size_t i = 0; i < static_cast<std::size_t>(sparse.count); ++i) {
      double place = 0.0;
      places.read(i, &place);
      values.read(i, numbers.data() + static_cast<std::size_t>(place) * components);
    }
  }
  return numbers;
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor) {
  const std::vector<double> numbers = read_numbers(model, accessor);
  std::vector<std::uint32_t> indices(numbers.size());
  std::ranges::transform(numbers, indices.begin(),
                         [](double number) { return static_cast<std::uint32_t>(number); });
  return indices;
}

std::vector<std::uint32_t> read_sparse_indices(const tinygltf::Model& model, int accessor) {
  const auto& sparse = model.accessors[static_cast<std::size_t>(accessor)].sparse;
  const Elements places = elements_of(model, sparse.indices.bufferView,
                                      static_cast<std::size_t>(sparse.indices.byteOffset),
                                      sparse.indices.componentType, 1, false, false);
  std::vector<std::uint32_t> indices(static_cast<std::size_t>(sparse.count));
  for (std::size_t i = 0; i < indices.size(); ++i) {
    double place = 0.0;
    places.read(i, &place);
    indices[i] = static_cast<std::uint32_t>(place);
  }
  return indices;
}

}  // namespace torsion::engine
