#include "scenes/gltf_content.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/gltf_accessors.hpp"
#include "scenes/gltf_extents.hpp"

namespace torsion::engine {
namespace {

constexpr const char* kQuantization = "KHR_mesh_quantization";

constexpr double kFarthest = 1e4;  // m: beyond it something is in other units

const tinygltf::Accessor& accessor_at(const tinygltf::Model& model, int accessor) {
  return model.accessors[static_cast<std::size_t>(accessor)];
}

void check_sparse_order(const tinygltf::Model& model, const ProblemList& problems) {
  for (std::size_t row = 0; row < model.accessors.size(); ++row) {
    const tinygltf::Accessor& accessor = model.accessors[row];
    if (!accessor.sparse.isSparse) {
      continue;
    }
    const std::string place = "accessors[" + std::to_string(row) + "].sparse.indices";
    const auto indices = read_sparse_indices(model, static_cast<int>(row));
    if (indices.back() >= accessor.count) {
      problems.add("", place, std::to_string(indices.back()),
                   "expected at most " + std::to_string(accessor.count - 1));
    }
    if (std::ranges::adjacent_find(indices, std::greater_equal<>{}) != indices.end()) {
      problems.add("", place, "", "must rise from one to the next");
    }
  }
}

/// Which number of `numbers` is not finite or farther than `most` from 0, or numbers.size().
std::size_t first_bad(const std::vector<double>& numbers, double most) {
  const auto bad = [most](double number) {
    return !(std::abs(number) <= most);
  };
  return static_cast<std::size_t>(std::ranges::find_if(numbers, bad) - numbers.begin());
}

struct PrimitiveCheck {
  const tinygltf::Model& model;
  const tinygltf::Primitive& primitive;
  std::string where;
  const ProblemList& problems;
};

/// Positions and normals are floats, unless the file says that it has the extension for shorter
/// numbers (glTF 2.0, 3.7.2.1; KHR_mesh_quantization).
void check_component(const PrimitiveCheck& check, const std::string& name,
                     const tinygltf::Accessor& accessor) {
  const auto& used = check.model.extensionsUsed;
  const auto& required = check.model.extensionsRequired;
  const bool quantized = std::ranges::find(used, kQuantization) != used.end() ||
                         std::ranges::find(required, kQuantization) != required.end();
  const int type = accessor.componentType;
  const bool is_short =
      type == TINYGLTF_COMPONENT_TYPE_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
      type == TINYGLTF_COMPONENT_TYPE_SHORT || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  if (type != TINYGLTF_COMPONENT_TYPE_FLOAT && !(quantized && is_short)) {
    check.problems.add(check.where, name, "component type " + std::to_string(type),
                       "expected 5126 (float)",
                       "export floats, or list KHR_mesh_quantization in extensionsRequired if the "
                       "file has it");
  }
}

void check_positions(const PrimitiveCheck& check) {
  const int row = check.primitive.attributes.at("POSITION");
  const tinygltf::Accessor& accessor = accessor_at(check.model, row);
  if (accessor.type != TINYGLTF_TYPE_VEC3) {
    check.problems.add(check.where, "POSITION", "", "expected VEC3");
    return;
  }
  check_component(check, "POSITION", accessor);
  const std::vector<double> numbers = read_numbers(check.model, row);
  const std::size_t bad = first_bad(numbers, kFarthest);
  if (bad < numbers.size()) {
    check.problems.add(check.where, "POSITION of vertex " + std::to_string(bad / 3),
                       std::to_string(numbers[bad]), "expected finite metres within 10 km",
                       "set the unit of the exporter to metres, and look for broken vertices");
  }
  for (const auto& [name, attribute] : check.primitive.attributes) {
    const tinygltf::Accessor& other = accessor_at(check.model, attribute);
    if (other.count != accessor.count) {
      check.problems.add(check.where, name, std::to_string(other.count) + " elements",
                         "expected " + std::to_string(accessor.count) + ", as POSITION has");
    }
    if (name == "NORMAL" && other.type != TINYGLTF_TYPE_VEC3) {
      check.problems.add(check.where, name, "", "expected VEC3");
    } else if (name == "NORMAL") {
      check_component(check, name, other);
    }
  }
}

void check_primitive_indices(const PrimitiveCheck& check) {
  const std::size_t vertices =
      accessor_at(check.model, check.primitive.attributes.at("POSITION")).count;
  std::size_t corners = vertices;
  if (check.primitive.indices >= 0) {
    const tinygltf::Accessor& accessor = accessor_at(check.model, check.primitive.indices);
    const bool whole = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                       accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                       accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!whole || accessor.type != TINYGLTF_TYPE_SCALAR || accessor.normalized) {
      check.problems.add(check.where, "indices", "", "expected unsigned scalars");
      return;
    }
    corners = accessor.count;
    const auto indices = read_indices(check.model, check.primitive.indices);
    const std::uint32_t largest = std::ranges::max(indices);
    if (largest >= vertices) {
      check.problems.add(
          check.where, "an index", std::to_string(largest),
          "expected at most " + std::to_string(vertices - 1) + ", the last of its vertices");
    }
  }
  if (check.primitive.mode == TINYGLTF_MODE_TRIANGLES && corners % 3 != 0) {
    check.problems.add(check.where, "number of corners", std::to_string(corners),
                       "expected a multiple of 3");
  }
}

void check_meshes(const tinygltf::Model& model, const ProblemList& problems) {
  std::size_t vertices = 0;
  for (std::size_t row = 0; row < model.meshes.size(); ++row) {
    const tinygltf::Mesh& mesh = model.meshes[row];
    const std::string name =
        mesh.name.empty() ? "meshes[" + std::to_string(row) + "]" : "mesh \"" + mesh.name + '"';
    for (std::size_t part = 0; part < mesh.primitives.size(); ++part) {
      const PrimitiveCheck check{model, mesh.primitives[part],
                                 name + ", primitive " + std::to_string(part), problems};
      check_positions(check);
      check_primitive_indices(check);
      vertices += accessor_at(model, mesh.primitives[part].attributes.at("POSITION")).count;
    }
  }
  if (vertices > kMostElements) {
    problems.add("", "all meshes", std::to_string(vertices) + " vertices",
                 "expected at most " + std::to_string(kMostElements));
  }
}

/// Values of one key: CUBICSPLINE has an in-tangent, a value and an out-tangent.
std::size_t values_of_key(const tinygltf::AnimationSampler& sampler) {
  return sampler.interpolation == "CUBICSPLINE" ? 3 : 1;
}

void check_sampler(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler,
                   int type, const std::string& where, const ProblemList& problems) {
  const tinygltf::Accessor& input = accessor_at(model, sampler.input);
  const tinygltf::Accessor& output = accessor_at(model, sampler.output);
  if (input.type != TINYGLTF_TYPE_SCALAR || input.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
    problems.add(where, "input", "", "expected times as float scalars");
    return;
  }
  const std::vector<double> times = read_numbers(model, sampler.input);
  const bool rising = std::ranges::adjacent_find(times, std::greater_equal<>{}) == times.end();
  if (first_bad(times, 1e6) < times.size() || times.front() < 0.0 || !rising) {
    problems.add(where, "input", "", "expected times in seconds that rise from key to key");
  }
  if (output.type != type) {
    problems.add(where, "output", "",
                 type == TINYGLTF_TYPE_VEC4 ? "expected VEC4 for a rotation" : "expected VEC3");
    return;
  }
  const std::size_t expected = input.count * values_of_key(sampler);
  if (output.count != expected) {
    problems.add(where, "output", std::to_string(output.count) + " values",
                 "expected " + std::to_string(expected) + " for " + std::to_string(input.count) +
                     " keys of " + sampler.interpolation);
  }
  const std::vector<double> values = read_numbers(model, sampler.output);
  if (first_bad(values, 1e9) < values.size()) {
    problems.add(where, "output", "", "expected finite numbers");
  }
}

void check_animation_data(const tinygltf::Model& model, const ProblemList& problems) {
  for (std::size_t row = 0; row < model.animations.size(); ++row) {
    const tinygltf::Animation& animation = model.animations[row];
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
      const tinygltf::AnimationChannel& channel = animation.channels[i];
      if (channel.target_path == "weights") {
        continue;
      }
      const std::string where =
          "animations[" + std::to_string(row) + "].channels[" + std::to_string(i) + "]";
      const int type = channel.target_path == "rotation" ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3;
      check_sampler(model, animation.samplers[static_cast<std::size_t>(channel.sampler)], type,
                    where, problems);
    }
  }
}

}  // namespace

void check_gltf_content(const tinygltf::Model& model, const ProblemList& problems) {
  const std::size_t before = problems.problems.size();
  check_sparse_order(model, problems);
  if (problems.problems.size() != before) {
    return;
  }
  check_meshes(model, problems);
  check_animation_data(model, problems);
}

}  // namespace torsion::engine
