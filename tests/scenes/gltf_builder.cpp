#include "tests/scenes/gltf_builder.hpp"

#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace torsion::engine::test {
namespace {

using nlohmann::json;

std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8U | (j < count ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= count ? kLetters[group >> (18U - 6U * j) & 63U] : '=';
    }
  }
  return text;
}

std::string word(std::uint32_t value) {
  std::string bytes(4, '\0');
  std::memcpy(bytes.data(), &value, 4);
  return bytes;
}

/// Appends to an array of `document`, which it makes where there is none. Returns the row.
int append(json& document, const char* array, const json& element) {
  document[array].push_back(element);
  return static_cast<int>(document[array].size()) - 1;
}

}  // namespace

GltfBuilder::GltfBuilder() {
  document["asset"] = {{"version", "2.0"}};
  document["scene"] = 0;
  document["scenes"] = {{{"nodes", json::array()}}};
}

int GltfBuilder::add_view(std::string_view bytes) {
  const std::size_t offset = bytes_.size();
  bytes_ += bytes;
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  return append(document, "bufferViews",
                {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
}

int GltfBuilder::add_floats(const std::vector<float>& values, const std::string& type) {
  const std::size_t width = type == "SCALAR" ? 1U : static_cast<std::size_t>(type.back() - '0');
  const int view = add_view(bytes_of(values));
  return append(document, "accessors",
                {{"bufferView", view},
                 {"componentType", 5126},
                 {"count", values.size() / width},
                 {"type", type}});
}

int GltfBuilder::add_indices(const std::vector<std::uint32_t>& indices) {
  const int view = add_view(bytes_of(indices));
  return append(document, "accessors",
                {{"bufferView", view},
                 {"componentType", 5125},
                 {"count", indices.size()},
                 {"type", "SCALAR"}});
}

int GltfBuilder::add_mesh(const SurfaceMesh& mesh) {
  std::vector<float> positions;
  for (const glm::dvec3& position : mesh.positions) {
    for (int i = 0; i < 3; ++i) {
      positions.push_back(static_cast<float>(position[i]));
    }
  }
  std::vector<std::uint32_t> indices;
  for (const glm::uvec3& triangle : mesh.triangles) {
    indices.insert(indices.end(), {triangle.x, triangle.y, triangle.z});
  }
  const int position_row = add_floats(positions, "VEC3");
  const int index_row = add_indices(indices);
  const json primitive = {{"attributes", {{"POSITION", position_row}}}, {"indices", index_row}};
  return append(document, "meshes", {{"primitives", json::array({primitive})}});
}

int GltfBuilder::add_node(const json& node) {
  const int row = append(document, "nodes", node);
  document["scenes"][0]["nodes"].push_back(row);
  return row;
}

void GltfBuilder::add_motion(int node, const std::string& path, const std::vector<float>& times,
                             const std::vector<float>& values, const std::string& interpolation) {
  const int input = add_floats(times, "SCALAR");
  const int output = add_floats(values, path == "rotation" ? "VEC4" : "VEC3");
  const json sampler = {{"input", input}, {"output", output}, {"interpolation", interpolation}};
  const json channel = {{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}};
  append(document, "animations",
         {{"samplers", json::array({sampler})}, {"channels", json::array({channel})}});
}

json& GltfBuilder::node(const std::string& name) {
  for (json& node : document["nodes"]) {
    if (node.value("name", "") == name) {
      return node;
    }
  }
  throw std::out_of_range("no node " + name);
}

void GltfBuilder::put_below(int child, int parent) {
  json& roots = document["scenes"][0]["nodes"];
  roots.erase(std::remove(roots.begin(), roots.end(), json(child)), roots.end());
  document["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(child);
}

std::string GltfBuilder::text() const {
  json whole = document;
  if (!bytes_.empty() && !whole.contains("buffers")) {
    whole["buffers"] =
        json::array({{{"byteLength", bytes_.size()},
                      {"uri", "data:application/octet-stream;base64," + base64(bytes_)}}});
  }
  return whole.dump();
}

std::string GltfBuilder::glb() const {
  json whole = document;
  whole["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
  std::string text = whole.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + 8 + bytes_.size();
  return "glTF" + word(2) + word(static_cast<std::uint32_t>(total)) +
         word(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
         word(static_cast<std::uint32_t>(bytes_.size())) + std::string("BIN\0", 4) + bytes_;
}

SurfaceMesh box_mesh(const glm::dvec3& half_extent) {
  SurfaceMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                          (corner & 4) != 0 ? 1.0 : -1.0);
    mesh.positions.push_back(half_extent * sign);
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& face : kFaces) {
    mesh.triangles.emplace_back(face[0], face[1], face[2]);
    mesh.triangles.emplace_back(face[0], face[2], face[3]);
  }
  return mesh;
}

LoadedScene load_text(const std::string& text, const std::string& name) {
  const TestFolder folder;
  return load_gltf(folder.write(name, text));
}

GltfBuilder good_scene() {
  GltfBuilder scene;
  const int cube = scene.add_mesh(box_mesh(glm::dvec3(0.05)));
  scene.add_node({{"name", "cube"},
                  {"mesh", cube},
                  {"translation", {0.0, 0.05, 0.0}},
                  {"extras", {{"torsion_role", "elastic"}}}});
  const int block = scene.add_mesh(box_mesh(glm::dvec3(0.01)));
  const int tool = scene.add_node({{"name", "block"},
                                   {"mesh", block},
                                   {"translation", {0.0, 0.13, 0.0}},
                                   {"extras", {{"torsion_role", "tool"}}}});
  scene.add_motion(tool, "translation", {0.0F, 1.0F}, {0.0F, 0.13F, 0.0F, 0.0F, 0.09F, 0.0F});
  return scene;
}

TestFolder::TestFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "torsion_scenes_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot make " + name);
  }
  path_ = name;
}

TestFolder::~TestFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TestFolder::write(const std::string& name, std::string_view bytes) const {
  std::filesystem::path path = path_ / name;
  std::filesystem::remove(path);  // a file that is cut and written again is flushed to the disk
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

}  // namespace torsion::engine::test
