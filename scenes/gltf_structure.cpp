#include "scenes/gltf_structure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "scenes/json_visit.hpp"

namespace torsion::engine {
namespace {

using nlohmann::json;

constexpr std::size_t kMostNodes = 100'000;

/// Extensions that a scene may require: those that change nothing of what is read, or are read.
const std::set<std::string> kKnownExtensions = {
    "KHR_mesh_quantization", "KHR_physics_rigid_bodies", "KHR_implicit_shapes",
    "KHR_materials_unlit",   "KHR_materials_specular",   "KHR_materials_ior",
    "KHR_texture_transform", "KHR_lights_punctual",      "KHR_materials_emissive_strength",
};

struct Reference {
  std::string_view pattern;
  std::string_view array;
};

/// Every index that a reader follows, and the array that it counts in.
constexpr std::array kReferences = {
    Reference{"scene", "scenes"},
    Reference{"scenes/[]/nodes/[]", "nodes"},
    Reference{"nodes/[]/children/[]", "nodes"},
    Reference{"nodes/[]/mesh", "meshes"},
    Reference{"nodes/[]/skin", "skins"},
    Reference{"nodes/[]/camera", "cameras"},
    Reference{"meshes/[]/primitives/[]/attributes/*", "accessors"},
    Reference{"meshes/[]/primitives/[]/targets/[]/*", "accessors"},
    Reference{"meshes/[]/primitives/[]/indices", "accessors"},
    Reference{"meshes/[]/primitives/[]/material", "materials"},
    Reference{"accessors/[]/bufferView", "bufferViews"},
    Reference{"accessors/[]/sparse/indices/bufferView", "bufferViews"},
    Reference{"accessors/[]/sparse/values/bufferView", "bufferViews"},
    Reference{"bufferViews/[]/buffer", "buffers"},
    Reference{"textures/[]/source", "images"},
    Reference{"textures/[]/sampler", "samplers"},
    Reference{"images/[]/bufferView", "bufferViews"},
    Reference{"animations/[]/channels/[]/target/node", "nodes"},
    Reference{"animations/[]/samplers/[]/input", "accessors"},
    Reference{"animations/[]/samplers/[]/output", "accessors"},
    Reference{"skins/[]/joints/[]", "nodes"},
    Reference{"skins/[]/inverseBindMatrices", "accessors"},
    Reference{"skins/[]/skeleton", "nodes"},
};

enum class Kind { kArray, kObject, kString };

struct Member {
  std::string_view pattern;
  Kind kind;
};

/// Members whose kind tinygltf takes for granted or passes over in silence.
constexpr std::array kMembers = {
    Member{"asset", Kind::kObject},
    Member{"extensionsRequired", Kind::kArray},
    Member{"extensionsRequired/[]", Kind::kString},
    Member{"scenes/[]/nodes", Kind::kArray},
    Member{"nodes/[]/children", Kind::kArray},
    Member{"nodes/[]/name", Kind::kString},
    Member{"nodes/[]/extensions", Kind::kObject},
    Member{"meshes/[]/primitives", Kind::kArray},
    Member{"meshes/[]/primitives/[]", Kind::kObject},
    Member{"meshes/[]/primitives/[]/attributes", Kind::kObject},
    Member{"meshes/[]/name", Kind::kString},
    Member{"materials/[]/name", Kind::kString},
    Member{"accessors/[]/sparse", Kind::kObject},
    Member{"accessors/[]/sparse/indices", Kind::kObject},
    Member{"accessors/[]/sparse/values", Kind::kObject},
    Member{"buffers/[]/uri", Kind::kString},
    Member{"images/[]/uri", Kind::kString},
    Member{"animations/[]/channels", Kind::kArray},
    Member{"animations/[]/channels/[]", Kind::kObject},
    Member{"animations/[]/channels/[]/target", Kind::kObject},
    Member{"animations/[]/channels/[]/target/path", Kind::kString},
    Member{"animations/[]/samplers", Kind::kArray},
    Member{"animations/[]/samplers/[]", Kind::kObject},
};

/// What must be there: the owner and the name of its member.
constexpr std::array<std::array<std::string_view, 2>, 13> kRequired = {{
    {"meshes/[]", "primitives"},
    {"meshes/[]/primitives/[]", "attributes"},
    {"accessors/[]", "componentType"},
    {"accessors/[]", "count"},
    {"accessors/[]", "type"},
    {"bufferViews/[]", "buffer"},
    {"bufferViews/[]", "byteLength"},
    {"buffers/[]", "byteLength"},
    {"animations/[]", "channels"},
    {"animations/[]", "samplers"},
    {"animations/[]/channels/[]", "sampler"},
    {"animations/[]/channels/[]", "target"},
    {"animations/[]/samplers/[]", "input"},
}};

constexpr std::array<std::string_view, 13> kTopArrays = {
    "accessors", "animations", "buffers",  "bufferViews", "cameras",  "images", "materials",
    "meshes",    "nodes",      "samplers", "scenes",      "textures", "skins"};

bool is_kind(const json& value, Kind kind) {
  switch (kind) {
    case Kind::kArray:
      return value.is_array();
    case Kind::kObject:
      return value.is_object();
    case Kind::kString:
      return value.is_string();
  }
  return false;
}

std::string_view kind_name(Kind kind) {
  constexpr std::array<std::string_view, 3> kNames = {"an array", "an object", "a string"};
  return kNames[static_cast<std::size_t>(kind)];
}

void check_kinds(const json& document, const ProblemList& problems) {
  for (const std::string_view name : kTopArrays) {
    visit_json(document, name, [&](const json& value, const std::string& place) {
      if (!value.is_array()) {
        problems.add("", place, shown(value), "expected an array");
      }
    });
    visit_json(document, std::string(name) + "/[]", [&](const json& value, const std::string& at) {
      if (!value.is_object()) {
        problems.add("", at, shown(value), "expected an object");
      }
    });
  }
  for (const Member& member : kMembers) {
    visit_json(document, member.pattern, [&](const json& value, const std::string& place) {
      if (!is_kind(value, member.kind)) {
        problems.add("", place, shown(value), "expected " + std::string(kind_name(member.kind)));
      }
    });
  }
  for (const auto& required : kRequired) {
    const std::string_view name = required[1];
    visit_json(document, required[0], [&](const json& value, const std::string& place) {
      if (value.is_object() && !value.contains(name)) {
        problems.add("", place + "." + std::string(name), "", "is missing");
      }
    });
  }
}

void check_version(const json& document, const ProblemList& problems) {
  const auto version_of = [&](const char* name) -> std::string {
    const json& asset = document.contains("asset") ? document["asset"] : json();
    return asset.is_object() && asset.contains(name) && asset[name].is_string()
               ? asset[name].get<std::string>()
               : "";
  };
  const std::string version = version_of("version");
  const std::string least = version_of("minVersion");
  if (!version.starts_with("2.")) {
    problems.add("", "asset.version", version.empty() ? "missing" : '"' + version + '"',
                 "expected \"2.0\"", "export the scene as glTF 2.0");
  } else if (!least.empty() && least != "2.0") {
    problems.add("", "asset.minVersion", '"' + least + '"', "expected at most \"2.0\"");
  }
  visit_json(document, "extensionsRequired/[]", [&](const json& name, const std::string& place) {
    if (name.is_string() && !kKnownExtensions.contains(name.get<std::string>())) {
      problems.add("", place, shown(name), "is an extension that Torsion does not read",
                   "export without it, for example without mesh compression");
    }
  });
}

std::size_t size_of(const json& document, std::string_view array) {
  return document.contains(array) && document[std::string(array)].is_array()
             ? document[std::string(array)].size()
             : 0;
}

void check_index(const json& value, const std::string& place, std::string_view array,
                 std::size_t size, const ProblemList& problems) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= size) {
    problems.add("", place, shown(value),
                 "expected an index of " + std::string(array) + ", which has " +
                     std::to_string(size) + (size == 1 ? " element" : " elements"));
  }
}

void check_references(const json& document, const ProblemList& problems) {
  for (const Reference& reference : kReferences) {
    const std::size_t size = size_of(document, reference.array);
    visit_json(document, reference.pattern, [&](const json& value, const std::string& place) {
      check_index(value, place, reference.array, size, problems);
    });
  }
  visit_json(document, "animations/[]", [&](const json& animation, const std::string& place) {
    const std::size_t size = size_of(animation, "samplers");
    visit_json(animation, "channels/[]/sampler", [&](const json& value, const std::string& at) {
      check_index(value, place + "." + at, "the animation's samplers", size, problems);
    });
    if (size_of(animation, "channels") == 0) {
      problems.add("", place + ".channels", "empty", "expected at least one channel");
    }
  });
}

void check_primitives(const json& document, const ProblemList& problems) {
  visit_json(
      document, "meshes/[]/primitives/[]", [&](const json& primitive, const std::string& place) {
        if (primitive.contains("mode") && !(primitive["mode"].is_number_unsigned() &&
                                            primitive["mode"].get<std::uint64_t>() <= 6)) {
          problems.add("", place + ".mode", shown(primitive["mode"]), "expected 0 to 6");
        }
        if (primitive.contains("attributes") && !primitive["attributes"].contains("POSITION")) {
          problems.add("", place + ".attributes.POSITION", "", "is missing");
        }
      });
}

/// @param unit  the numbers are a rotation and must have length 1 within 1 %
void check_numbers(const json& value, const std::string& place, std::size_t count, bool unit,
                   const ProblemList& problems) {
  double square = 0.0;
  bool right = value.is_array() && value.size() == count;
  for (std::size_t i = 0; right && i < count; ++i) {
    right = value[i].is_number() && std::isfinite(value[i].get<double>());
    square += right ? value[i].get<double>() * value[i].get<double>() : 0.0;
  }
  if (!right) {
    problems.add("", place, shown(value),
                 "expected an array of " + std::to_string(count) + " finite numbers");
  } else if (unit && std::abs(std::sqrt(square) - 1.0) > 0.01) {
    problems.add("", place, shown(value), "expected a unit quaternion x, y, z, w");
  }
}

void check_transforms(const json& document, const ProblemList& problems) {
  struct Transform {
    std::string_view name;
    std::size_t count;
    bool unit;
  };
  constexpr std::array kTransforms = {Transform{"translation", 3, false},
                                      Transform{"rotation", 4, true}, Transform{"scale", 3, false},
                                      Transform{"matrix", 16, false}};
  for (const Transform& transform : kTransforms) {
    visit_json(document, "nodes/[]/" + std::string(transform.name),
               [&](const json& value, const std::string& place) {
                 check_numbers(value, place, transform.count, transform.unit, problems);
               });
  }
  visit_json(document, "nodes/[]", [&](const json& node, const std::string& place) {
    const bool parts =
        node.contains("translation") || node.contains("rotation") || node.contains("scale");
    if (node.contains("matrix") && parts) {
      problems.add("", place, "", "has a matrix and a translation, rotation or scale",
                   "keep one of the two");
    }
  });
}

void check_animations(const json& document, const ProblemList& problems) {
  const std::set<std::string> interpolations = {"STEP", "LINEAR", "CUBICSPLINE"};
  const std::set<std::string> paths = {"translation", "rotation", "scale", "weights"};
  visit_json(document, "animations/[]/samplers/[]/interpolation",
             [&](const json& value, const std::string& place) {
               if (!value.is_string() || !interpolations.contains(value.get<std::string>())) {
                 problems.add("", place, shown(value), "expected STEP, LINEAR or CUBICSPLINE");
               }
             });
  visit_json(document, "animations/[]/channels/[]/target/path",
             [&](const json& value, const std::string& place) {
               if (value.is_string() && !paths.contains(value.get<std::string>())) {
                 problems.add("", place, shown(value), "expected translation, rotation or scale");
               }
             });
  visit_json(document, "animations/[]/samplers/[]", [&](const json& value, const std::string& at) {
    if (value.is_object() && !value.contains("output")) {
      problems.add("", at + ".output", "", "is missing");
    }
  });
}

/// Every node at most once a child, and no node its own ancestor. @pre all indices are in range
void check_trees(const json& document, const ProblemList& problems) {
  const std::size_t count = size_of(document, "nodes");
  if (count > kMostNodes) {
    problems.add("", "nodes", std::to_string(count) + " elements",
                 "expected at most " + std::to_string(kMostNodes));
    return;
  }
  std::vector<std::optional<std::size_t>> parent(count);
  for (std::size_t node = 0; node < count; ++node) {
    visit_json(document["nodes"][node], "children/[]", [&](const json& value, const auto& place) {
      std::optional<std::size_t>& known = parent[value.get<std::size_t>()];
      if (known) {
        problems.add("", "nodes[" + std::to_string(node) + "]." + place, shown(value),
                     "is a child of nodes[" + std::to_string(*known) + "] already",
                     "give every node one parent");
      }
      known = known ? known : node;
    });
  }
  // "All listed nodes must be root nodes", each once (glTF 2.0, 3.5.1): one that is listed again,
  // or below another, would be there twice.
  visit_json(document, "scenes/[]", [&](const json& scene, const std::string& at) {
    std::set<std::size_t> listed;
    visit_json(scene, "nodes/[]", [&](const json& value, const std::string& place) {
      const auto node = value.get<std::size_t>();
      if (!listed.insert(node).second) {
        problems.add("", at + "." + place, shown(value), "is listed twice", "list every node once");
      } else if (parent[node]) {
        problems.add("", at + "." + place, shown(value),
                     "is a child of nodes[" + std::to_string(*parent[node]) +
                         "], and a scene lists only nodes without a parent",
                     "take it out of the scene's nodes, or out of that node's children");
      }
    });
  });
  // A node that is still not at a root after as many steps up as there are nodes goes in a circle.
  std::vector<char> clear(count, 0);
  for (std::size_t start = 0; start < count; ++start) {
    std::size_t node = start;
    std::size_t steps = 0;
    while (clear[node] == 0 && parent[node] && steps <= count) {
      node = *parent[node];
      steps += 1;
    }
    if (steps > count) {
      problems.add("", "nodes[" + std::to_string(start) + "]", "",
                   "is its own ancestor: the nodes form a cycle",
                   "remove it from the children of one of them");
      return;
    }
    for (node = start; clear[node] == 0; node = *parent[node]) {
      clear[node] = 1;
      if (!parent[node]) {
        break;
      }
    }
  }
}

}  // namespace

void check_gltf_structure(const json& document, const ProblemList& problems) {
  if (!document.is_object()) {
    problems.add("", "", "", "expected a JSON object, as every glTF file is one");
    return;
  }
  check_version(document, problems);
  const std::size_t before = problems.problems.size();
  check_kinds(document, problems);
  if (problems.problems.size() != before) {
    return;
  }
  check_references(document, problems);
  check_primitives(document, problems);
  check_transforms(document, problems);
  check_animations(document, problems);
  if (problems.problems.size() == before) {
    check_trees(document, problems);
  }
}

}  // namespace torsion::engine
