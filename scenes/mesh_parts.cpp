#include "scenes/mesh_parts.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <glm/geometric.hpp>

#include "scenes/gltf_accessors.hpp"

namespace torsion::engine {
namespace {

/// Blender upper-cases attribute names and may add a second underscore.
bool is_called_fixed(std::string name) {
  name.erase(0, std::min(name.find_first_not_of('_'), name.size()));
  std::ranges::transform(name, name.begin(), [](unsigned char letter) {
    return static_cast<char>(std::toupper(letter));
  });
  return name == "FIXED" || name == "TORSION_FIXED";
}

std::vector<glm::dvec3> read_vectors(const tinygltf::Model& model, int accessor) {
  const std::vector<double> numbers = read_numbers(model, accessor);
  std::vector<glm::dvec3> vectors(numbers.size() / 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    vectors[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  }
  return vectors;
}

/// The corners of triangle `i` among the corners of a primitive of any triangle mode.
glm::uvec3 corners_of(int mode, std::uint32_t i) {
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    return {i, i + 1 + i % 2, i + 2 - i % 2};
  }
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
    return {i + 1, i + 2, 0};
  }
  return {3 * i, 3 * i + 1, 3 * i + 2};
}

void append_triangles(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                      std::uint32_t vertices, bool mirrored, MeshTriangles& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size()) - vertices;
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) {
    corners = read_indices(model, primitive.indices);
  } else {
    for (std::uint32_t i = 0; i < vertices; ++i) {
      corners.push_back(i);
    }
  }
  const auto count = static_cast<std::uint32_t>(corners.size());
  const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode < 0;
  const std::uint32_t triangles = list ? count / 3 : (count < 3 ? 0 : count - 2);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const glm::uvec3 at = corners_of(primitive.mode, i);
    glm::uvec3 triangle(corners[at.x], corners[at.y], corners[at.z]);
    if (triangle.x == triangle.y || triangle.y == triangle.z || triangle.z == triangle.x) {
      continue;  // strips join their parts by such
    }
    if (mirrored) {
      std::swap(triangle.y, triangle.z);
    }
    mesh.triangles.push_back(triangle + first);
  }
}

/// Appends `more` to `rows`, which stay empty as long as nobody has any.
/// @param first  rows so far of what has one for each
/// @param count  rows that come; as many of `more` as that, or none
template <class Row>
void append_or_fill(std::vector<Row>& rows, std::size_t first, std::size_t count,
                    const std::vector<Row>& more, const Row& otherwise) {
  const bool has_more = !more.empty() && more.size() == count;
  if (rows.empty() && !has_more) {
    return;
  }
  rows.resize(first, otherwise);
  if (has_more) {
    rows.insert(rows.end(), more.begin(), more.end());
  }
  rows.resize(first + count, otherwise);
}

/// Attributes that not every primitive has are dropped or filled up, so that rows stay parallel.
void append_attributes(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                       const glm::dmat4& to_owner, MeshTriangles& mesh) {
  const std::size_t first = mesh.positions.size();
  const glm::dmat3 turn_normals = glm::transpose(glm::inverse(glm::dmat3(to_owner)));
  for (const glm::dvec3& position : read_vectors(model, primitive.attributes.at("POSITION"))) {
    mesh.positions.emplace_back(to_owner * glm::dvec4(position, 1.0));
  }
  const auto normal = primitive.attributes.find("NORMAL");
  if (normal != primitive.attributes.end() && mesh.normals.size() == first) {
    for (const glm::dvec3& direction : read_vectors(model, normal->second)) {
      const glm::dvec3 turned = turn_normals * direction;
      const double length = glm::length(turned);
      mesh.normals.push_back(length > 0.0 && std::isfinite(length) ? turned / length
                                                                   : glm::dvec3(0.0, 1.0, 0.0));
    }
  } else {
    mesh.normals.clear();
  }
  const std::size_t count = mesh.positions.size() - first;
  const std::vector<glm::vec2> texcoords = read_texcoords(model, primitive);
  append_or_fill(mesh.texcoords, first, count, texcoords, glm::vec2(0.0F));
  append_or_fill(mesh.colors, first, count, read_colors(model, primitive), glm::vec3(1.0F));
  for (const auto& [name, accessor] : primitive.attributes) {
    if (is_called_fixed(name) &&
        model.accessors[static_cast<std::size_t>(accessor)].type == TINYGLTF_TYPE_SCALAR) {
      mesh.fixed.resize(first, 0.0);
      const std::vector<double> values = read_numbers(model, accessor);
      mesh.fixed.insert(mesh.fixed.end(), values.begin(), values.end());
    }
  }
  if (!mesh.fixed.empty()) {
    mesh.fixed.resize(mesh.positions.size(), 0.0);
  }
}

/// Faces' normals weighted by area, summed at each vertex.
std::vector<glm::dvec3> averaged_normals(const MeshTriangles& mesh) {
  std::vector<glm::dvec3> normals(mesh.positions.size(), glm::dvec3(0.0));
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 area = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                       mesh.positions[t.z] - mesh.positions[t.x]);
    normals[t.x] += area;
    normals[t.y] += area;
    normals[t.z] += area;
  }
  for (glm::dvec3& normal : normals) {
    const double length = glm::length(normal);
    normal = length > 0.0 ? normal / length : glm::dvec3(0.0, 1.0, 0.0);
  }
  return normals;
}

/// The materials of a mesh after those that are there; the first mesh's replace the default.
void append_materials(const MeshTriangles& mesh, DrawMesh& draw) {
  if (draw.triangles.empty()) {
    draw.materials.clear();
  }
  const auto first = static_cast<std::uint32_t>(draw.materials.size());
  draw.materials.insert(draw.materials.end(), mesh.materials.begin(), mesh.materials.end());
  if (mesh.materials.empty()) {
    draw.materials.emplace_back();
    draw.triangle_materials.resize(draw.triangles.size() + mesh.triangles.size(), first);
  }
  for (const std::uint32_t material : mesh.triangle_materials) {
    draw.triangle_materials.push_back(first + material);
  }
}

}  // namespace

MeshTriangles read_mesh(const tinygltf::Model& model, const tinygltf::Mesh& mesh,
                        const glm::dmat4& to_owner, const MeshLook& look, const std::string& where,
                        const ProblemList& problems) {
  MeshTriangles read;
  const bool mirrored = glm::determinant(glm::dmat3(to_owner)) < 0.0;
  for (std::size_t part = 0; part < mesh.primitives.size(); ++part) {
    const tinygltf::Primitive& primitive = mesh.primitives[part];
    if (primitive.mode >= 0 && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
      problems.add(where, "mode of primitive " + std::to_string(part),
                   std::to_string(primitive.mode),
                   "expected triangles: points and lines have no inside",
                   "delete loose points and edges, then export again");
      continue;
    }
    const std::size_t before = read.positions.size();
    append_attributes(model, primitive, to_owner, read);
    append_triangles(model, primitive, static_cast<std::uint32_t>(read.positions.size() - before),
                     mirrored, read);
    read.triangle_materials.resize(read.triangles.size(),
                                   static_cast<std::uint32_t>(read.materials.size()));
    read.materials.push_back(read_material(model, primitive, look));
  }
  return read;
}

void append_draw_mesh(const MeshTriangles& mesh, DrawMesh& draw) {
  const auto first = static_cast<std::uint32_t>(draw.positions.size());
  append_materials(mesh, draw);
  const bool has_normals = mesh.normals.size() == mesh.positions.size();
  const std::vector<glm::dvec3> normals = has_normals ? mesh.normals : averaged_normals(mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    draw.positions.emplace_back(mesh.positions[i]);
    draw.normals.emplace_back(normals[i]);
    draw.fixed.push_back(!mesh.fixed.empty() && mesh.fixed[i] > 0.5);
  }
  append_or_fill(draw.texcoords, first, mesh.positions.size(), mesh.texcoords, glm::vec2(0.0F));
  append_or_fill(draw.colors, first, mesh.positions.size(), mesh.colors, glm::vec3(1.0F));
  for (const glm::uvec3& triangle : mesh.triangles) {
    draw.triangles.push_back(triangle + first);
  }
}

}  // namespace torsion::engine
