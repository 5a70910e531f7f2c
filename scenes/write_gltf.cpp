#include "scenes/write_gltf.hpp"

#include <limits>
#include <span>
#include <sstream>

#include "scenes/gltf_rows.hpp"
#include "scenes/write_materials.hpp"

namespace torsion::engine {
namespace {

/// Appends rows to the one buffer of `model` and makes an accessor of them.
template <class Row>
int add_accessor(tinygltf::Model& model, std::span<const Row> rows, const RowKind& kind) {
  return append_rows(model, 0, std::as_bytes(rows), kind);
}

int add_vectors(tinygltf::Model& model, std::span<const glm::vec3> rows) {
  return add_accessor(model, rows,
                      {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, rows.size(),
                       TINYGLTF_TARGET_ARRAY_BUFFER});
}

void set_bounds(tinygltf::Accessor& accessor, std::span<const glm::vec3> rows) {
  glm::vec3 low(std::numeric_limits<float>::max());
  glm::vec3 high(std::numeric_limits<float>::lowest());
  for (const glm::vec3& row : rows) {
    low = glm::min(low, row);
    high = glm::max(high, row);
  }
  for (int i = 0; i < 3; ++i) {
    accessor.minValues.push_back(static_cast<double>(low[i]));
    accessor.maxValues.push_back(static_cast<double>(high[i]));
  }
}

/// A primitive for each run of triangles of one material; they share the vertices.
void add_primitives(tinygltf::Model& model, MaterialWriter& materials, const WrittenMesh& mesh,
                    const tinygltf::Primitive& vertices, tinygltf::Mesh& written) {
  const std::span<const glm::uvec3> triangles(mesh.triangles);
  for (const MaterialRun& run :
       material_runs(mesh.triangle_materials, static_cast<std::uint32_t>(mesh.triangles.size()))) {
    const auto [first, count] = run.triangles;
    tinygltf::Primitive& primitive = written.primitives.emplace_back(vertices);
    primitive.material = materials.add(
        mesh.materials[run.material],
        run.material == 0 ? mesh.name : mesh.name + " " + std::to_string(run.material));
    primitive.indices =
        add_accessor<glm::uvec3>(model, triangles.subspan(first, count),
                                 {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                  std::size_t{3} * count, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER});
  }
}

void add_mesh(tinygltf::Model& model, MaterialWriter& materials, const WrittenMesh& mesh) {
  tinygltf::Primitive vertices;
  vertices.mode = TINYGLTF_MODE_TRIANGLES;
  const int positions = add_vectors(model, mesh.positions);
  set_bounds(model.accessors[static_cast<std::size_t>(positions)], mesh.positions);
  vertices.attributes["POSITION"] = positions;
  vertices.attributes["NORMAL"] = add_vectors(model, mesh.normals);
  if (!mesh.texcoords.empty()) {
    vertices.attributes["TEXCOORD_0"] =
        add_accessor<glm::vec2>(model, mesh.texcoords,
                                {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2,
                                 mesh.texcoords.size(), TINYGLTF_TARGET_ARRAY_BUFFER});
  }
  if (!mesh.colors.empty()) {
    vertices.attributes["COLOR_0"] = add_vectors(model, mesh.colors);
  }
  if (!mesh.rest_positions.empty()) {
    vertices.attributes["_REST_POSITION"] = add_vectors(model, mesh.rest_positions);
  }
  if (!mesh.twist_angles.empty()) {
    vertices.attributes["_TWIST_ANGLE"] =
        add_accessor<float>(model, mesh.twist_angles,
                            {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR,
                             mesh.twist_angles.size(), TINYGLTF_TARGET_ARRAY_BUFFER});
  }
  tinygltf::Mesh written;
  written.name = mesh.name;
  add_primitives(model, materials, mesh, vertices, written);
  model.meshes.push_back(written);
  tinygltf::Node node;
  node.name = mesh.name;
  node.mesh = static_cast<int>(model.meshes.size()) - 1;
  const glm::dvec3& p = mesh.pose.position;
  const glm::dquat& q = mesh.pose.rotation;
  node.translation = {p.x, p.y, p.z};
  node.rotation = {q.x, q.y, q.z, q.w};
  model.nodes.push_back(node);
  model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
}

/// Vertices of the last mesh at each time, and the keys of their weights.
void add_targets(tinygltf::Model& model, const AnimatedMesh& mesh, int times,
                 tinygltf::Animation& animation) {
  tinygltf::Mesh& written = model.meshes.back();
  const std::size_t count = mesh.targets.size();
  for (const MorphTarget& target : mesh.targets) {
    const int positions = add_vectors(model, target.positions);
    set_bounds(model.accessors[static_cast<std::size_t>(positions)], target.positions);
    const int normals = add_vectors(model, target.normals);
    for (tinygltf::Primitive& primitive : written.primitives) {
      primitive.targets.push_back({{"POSITION", positions}, {"NORMAL", normals}});
    }
  }
  written.weights.assign(count, 0.0);
  std::vector<float> weights(count * count, 0.0F);
  for (std::size_t i = 0; i < count; ++i) {
    weights[i * count + i] = 1.0F;
  }
  add_channel(
      animation, static_cast<int>(model.nodes.size()) - 1, "weights", times,
      add_accessor<float>(model, weights,
                          {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, weights.size()}));
}

tinygltf::Model empty_model() {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "Torsion";
  model.scenes.emplace_back();
  model.defaultScene = 0;
  model.buffers.emplace_back();
  return model;
}

Result<std::string> bytes_of(tinygltf::Model model, bool binary) {
  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, stream, true, binary) || !stream) {
    return Error{"the scene cannot be written as glTF"};
  }
  return stream.str();
}

}  // namespace

Result<std::string> gltf_bytes(const std::vector<WrittenMesh>& meshes, bool binary) {
  tinygltf::Model model = empty_model();
  MaterialWriter materials(model);
  for (const WrittenMesh& mesh : meshes) {
    add_mesh(model, materials, mesh);
  }
  return bytes_of(std::move(model), binary);
}

Result<std::string> animated_gltf_bytes(const std::vector<AnimatedMesh>& meshes,
                                        const std::vector<float>& times, bool binary) {
  tinygltf::Model model = empty_model();
  MaterialWriter materials(model);
  tinygltf::Animation animation;
  animation.name = "run";
  const int keys = append_times(model, 0, times);
  for (const AnimatedMesh& mesh : meshes) {
    add_mesh(model, materials, mesh.rest);
    if (!mesh.poses.empty()) {
      add_pose_channels(model, animation, 0, static_cast<int>(model.nodes.size()) - 1, keys,
                        mesh.poses);
    }
    if (!mesh.targets.empty()) {
      add_targets(model, mesh, keys, animation);
    }
  }
  model.animations.push_back(std::move(animation));
  return bytes_of(std::move(model), binary);
}

}  // namespace torsion::engine
