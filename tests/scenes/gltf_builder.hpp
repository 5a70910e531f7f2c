#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "ecs/surface.hpp"
#include "scenes/load_gltf.hpp"

namespace torsion::engine::test {

/// The values as a glTF file holds them.
template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// Writes small glTF files. `document` is open, so that a test can put one fault into a good scene.
class GltfBuilder {
 public:
  GltfBuilder();

  nlohmann::json document;

  /// Appends 32 bit floats to the buffer. Returns the row of the accessor.
  /// @param type  "SCALAR", "VEC3", "VEC4"
  int add_floats(const std::vector<float>& values, const std::string& type);
  /// Appends 32 bit indices to the buffer. Returns the row of the accessor.
  int add_indices(const std::vector<std::uint32_t>& indices);
  /// Appends `bytes`, padded to a multiple of 4. Returns the row of the buffer view.
  int add_view(std::string_view bytes);
  /// Returns the row of the mesh, which has one primitive of indexed triangles without normals.
  int add_mesh(const SurfaceMesh& mesh);
  /// Returns the row of the node; it is a root unless it is put among the children of another.
  int add_node(const nlohmann::json& node);
  /// Moves a node by an animation of its own.
  /// @param path    "translation", "rotation" or "scale"
  /// @param values  3 or 4 numbers for each time, three times as many for CUBICSPLINE
  void add_motion(int node, const std::string& path, const std::vector<float>& times,
                  const std::vector<float>& values, const std::string& interpolation = "LINEAR");

  /// The row of the node of this name. @pre there is one
  [[nodiscard]] nlohmann::json& node(const std::string& name);
  /// Puts `child` below `parent`; it is a root no more.
  void put_below(int child, int parent);

  /// Bytes of the buffer, for faults in them.
  [[nodiscard]] std::string& bytes() { return bytes_; }

  /// The whole as JSON with the buffer in a data URI.
  [[nodiscard]] std::string text() const;
  /// The whole as .glb.
  [[nodiscard]] std::string glb() const;

 private:
  std::string bytes_;
};

/// A box around the origin, 8 vertices, 12 triangles that face outwards.
/// @param half_extent  m
SurfaceMesh box_mesh(const glm::dvec3& half_extent);

/// Reads `text` as the file `name` in a fresh folder that is gone afterwards.
LoadedScene load_text(const std::string& text, const std::string& name = "scene.gltf");

/// A good scene: the elastic node "cube" (edge 0.1 m, bottom at the origin's height) and the tool
/// "block" above it (edge 0.02 m) that sinks by 0.04 m within a second.
GltfBuilder good_scene();

/// A folder of its own for one test, removed at its end.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  TestFolder(TestFolder&&) = delete;
  TestFolder& operator=(TestFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a file; returns its path.
  [[nodiscard]] std::filesystem::path write(const std::string& name, std::string_view bytes) const;

 private:
  std::filesystem::path path_;
};

}  // namespace torsion::engine::test
