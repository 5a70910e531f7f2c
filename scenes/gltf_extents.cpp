#include "scenes/gltf_extents.hpp"

#include <map>
#include <optional>
#include <set>

#include "scenes/json_visit.hpp"

namespace torsion::engine {
namespace {

using nlohmann::json;

const std::map<std::uint64_t, std::uint64_t> kComponentBytes = {{5120, 1}, {5121, 1}, {5122, 2},
                                                                {5123, 2}, {5125, 4}, {5126, 4}};
const std::map<std::string, std::uint64_t> kComponents = {
    {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};

/// Reads numbers of one object and notes what is wrong with them.
class Numbers {
 public:
  Numbers(const json& object, std::string place, const ProblemList& problems)
      : object_(object), place_(std::move(place)), problems_(problems) {}

  /// A whole number of at least `least` and at most `most`; `otherwise` where it is not there.
  std::uint64_t whole(const char* key, std::uint64_t least, std::uint64_t most,
                      std::uint64_t otherwise) {
    if (!object_.contains(key)) {
      return otherwise;
    }
    const json& value = object_[key];
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() < least ||
        value.get<std::uint64_t>() > most) {
      wrong(key, "expected a whole number from " + std::to_string(least) + " to " +
                     std::to_string(most));
      return otherwise;
    }
    return value.get<std::uint64_t>();
  }

  void wrong(const std::string& key, const std::string& expected) {
    const std::string value = object_.contains(key) ? shown(object_[key]) : "";
    problems_.add("", place_ + "." + key, value, expected);
    good_ = false;
  }

  [[nodiscard]] bool good() const { return good_; }

 private:
  const json& object_;
  std::string place_;
  const ProblemList& problems_;
  bool good_ = true;
};

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 31;

void check_buffers(const json& document, const ProblemList& problems) {
  visit_json(document, "buffers/[]", [&](const json& buffer, const std::string& place) {
    Numbers(buffer, place, problems).whole("byteLength", 1, kMostBytes, 0);
  });
}

void check_views(const json& document, const ProblemList& problems) {
  visit_json(document, "bufferViews/[]", [&](const json& view, const std::string& place) {
    Numbers numbers(view, place, problems);
    const std::uint64_t offset = numbers.whole("byteOffset", 0, kMostBytes, 0);
    const std::uint64_t length = numbers.whole("byteLength", 1, kMostBytes, 0);
    const std::uint64_t stride = numbers.whole("byteStride", 4, 252, 4);
    if (stride % 4 != 0) {
      numbers.wrong("byteStride", "expected a multiple of 4");
    }
    const json& size = document["buffers"][view["buffer"].get<std::size_t>()]["byteLength"];
    if (numbers.good() && size.is_number_unsigned() && offset + length > size) {
      numbers.wrong("byteLength", "with its byteOffset it ends at byte " +
                                      std::to_string(offset + length) + ", but its buffer has " +
                                      shown(size) + " bytes");
    }
  });
}

struct Element {
  std::uint64_t component_bytes;
  std::uint64_t bytes;
};

std::optional<Element> element_of(const json& accessor, Numbers& numbers) {
  const json& component = accessor["componentType"];
  const json& type = accessor["type"];
  if (!component.is_number_unsigned() || !kComponentBytes.contains(component)) {
    numbers.wrong("componentType", "expected 5120, 5121, 5122, 5123, 5125 or 5126");
  }
  if (!type.is_string() || !kComponents.contains(type)) {
    numbers.wrong("type", "expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
  }
  if (!numbers.good()) {
    return std::nullopt;
  }
  const std::uint64_t bytes = kComponentBytes.at(component);
  return Element{bytes, bytes * kComponents.at(type)};
}

/// That `count` elements lie within view `view` from `offset` on.
void check_inside(const json& document, const json& view_index, std::uint64_t offset,
                  std::uint64_t count, const Element& element, bool may_stride, Numbers& numbers) {
  const json& view = document["bufferViews"][view_index.get<std::size_t>()];
  const std::uint64_t length = view["byteLength"];
  const std::uint64_t stride = may_stride && view.contains("byteStride")
                                   ? view["byteStride"].get<std::uint64_t>()
                                   : element.bytes;
  const std::uint64_t start =
      view.contains("byteOffset") ? view["byteOffset"].get<std::uint64_t>() : 0;
  if (stride < element.bytes) {
    numbers.wrong("bufferView", "its byteStride " + std::to_string(stride) +
                                    " is shorter than an element of " +
                                    std::to_string(element.bytes) + " bytes");
    return;
  }
  // Counts and strides are below 2^31 and 252: no product overflows.
  const std::uint64_t end = offset + stride * (count - 1) + element.bytes;
  if (end > length) {
    numbers.wrong("count", "its elements end at byte " + std::to_string(end) +
                               " of its bufferView, which has " + std::to_string(length) +
                               " bytes");
  }
  if ((start + offset) % element.component_bytes != 0) {
    numbers.wrong("byteOffset", "expected a multiple of " +
                                    std::to_string(element.component_bytes) +
                                    " together with that of the bufferView");
  }
}

void check_sparse(const json& document, const json& accessor, const Element& element,
                  std::uint64_t count, const std::string& place, const ProblemList& problems) {
  if (!accessor.contains("sparse")) {
    return;
  }
  const json& sparse = accessor["sparse"];
  for (const char* part : {"indices", "values"}) {
    if (!sparse.contains(part) || !sparse[part].contains("bufferView")) {
      problems.add("", place + ".sparse." + part + ".bufferView", "", "is missing");
      return;
    }
  }
  Numbers numbers(sparse, place + ".sparse", problems);
  const std::uint64_t replaced = numbers.whole("count", 1, count, 0);
  Numbers indices(sparse["indices"], place + ".sparse.indices", problems);
  const std::uint64_t type = indices.whole("componentType", 5121, 5125, 0);
  const std::uint64_t offset = indices.whole("byteOffset", 0, kMostBytes, 0);
  if (type != 5121 && type != 5123 && type != 5125) {
    indices.wrong("componentType", "expected 5121, 5123 or 5125");
  }
  Numbers values(sparse["values"], place + ".sparse.values", problems);
  const std::uint64_t value_offset = values.whole("byteOffset", 0, kMostBytes, 0);
  if (replaced == 0) {
    numbers.wrong("count", "expected a whole number from 1 to the accessor's count");
    return;
  }
  if (indices.good() && values.good()) {
    const std::uint64_t bytes = kComponentBytes.at(type);
    check_inside(document, sparse["indices"]["bufferView"], offset, replaced, {bytes, bytes}, false,
                 indices);
    check_inside(document, sparse["values"]["bufferView"], value_offset, replaced, element, false,
                 values);
  }
}

void check_accessors(const json& document, const ProblemList& problems) {
  visit_json(document, "accessors/[]", [&](const json& accessor, const std::string& place) {
    Numbers numbers(accessor, place, problems);
    const std::uint64_t count = numbers.whole("count", 1, kMostElements, 0);
    const std::uint64_t offset = numbers.whole("byteOffset", 0, kMostBytes, 0);
    const std::optional<Element> element = element_of(accessor, numbers);
    if (count == 0 || !element || !numbers.good()) {
      return;
    }
    if (accessor.contains("bufferView")) {
      check_inside(document, accessor["bufferView"], offset, count, *element, true, numbers);
    }
    check_sparse(document, accessor, *element, count, place, problems);
  });
}

}  // namespace

void check_gltf_extents(const json& document, const ProblemList& problems) {
  const std::size_t before = problems.problems.size();
  check_buffers(document, problems);
  check_views(document, problems);
  if (problems.problems.size() == before) {
    check_accessors(document, problems);
  }
}

}  // namespace torsion::engine
