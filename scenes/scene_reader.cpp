#include "scenes/scene_reader.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scenes/closed_mesh.hpp"
#include "scenes/exact_shapes.hpp"
#include "scenes/mesh_parts.hpp"

namespace torsion::engine {
namespace {

/// Keys of a node from its materials, its mesh and itself; the later win.
NodeKeys keys_of(const SceneReader& reader, std::size_t node) {
  NodeKeys keys;
  if (const tinygltf::Mesh* mesh = reader.mesh(node)) {
    for (const tinygltf::Primitive& primitive : mesh->primitives) {
      if (primitive.material >= 0) {
        const auto row = static_cast<std::size_t>(primitive.material);
        const tinygltf::Material& material = reader.model.materials[row];
        keys.add(material.extras, called("material", "materials", row, material.name),
                 reader.problems);
      }
    }
    const auto row = static_cast<std::size_t>(reader.file_node(node).mesh);
    keys.add(mesh->extras, called("mesh", "meshes", row, mesh->name), reader.problems);
  }
  keys.add(reader.file_node(node).extras, reader.name(node), reader.problems);
  return keys;
}

/// Whether something to be felt is at the node itself: its mesh, or a shape of the size that its
/// keys say.
bool is_solid(const SceneReader& reader, std::size_t node) {
  return reader.mesh(node) != nullptr || reader.keys[node].vector("torsion_size");
}

/// The role for whose keys a node is checked.
Role checked_role(const SceneReader& reader, std::size_t node) {
  const SceneNode& listed = reader.nodes[node];
  const bool part =
      listed.role == Role::kNone && listed.owner != SIZE_MAX && is_solid(reader, node);
  return part ? Role::kPart : listed.role;
}

/// The exact shape that fills a box along the node's axes; nothing where it cannot, which is a
/// problem.
/// @param low, high  m: of the box, node
std::optional<PartDescription> exact_part(const SceneReader& reader, std::size_t node,
                                          ShapeKind kind, const glm::dvec3& low,
                                          const glm::dvec3& high, const glm::dmat4& to_owner) {
  const std::string where = reader.name(node);
  const std::optional<NodeTransform> transform = split_transform(to_owner);
  if (!transform) {
    reader.problems.add(where, "torsion_shape", "", "is sheared by the scales of its parents",
                        "apply the scale of the parents, or use \"mesh\"");
    return std::nullopt;
  }
  const auto shape = fit_shape(kind, low, high, *transform, where, reader.problems);
  return shape ? std::optional<PartDescription>(
                     {reader.file_node(node).name, *shape, tessellate(*shape), nullptr})
               : std::nullopt;
}

/// The exact shape that fills a mesh's bounding box.
/// @param triangles  the node's mesh in the owner's frame
std::optional<PartDescription> part_of_box(const SceneReader& reader, std::size_t node,
                                           ShapeKind kind, const MeshTriangles& triangles,
                                           const glm::dmat4& to_owner) {
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  const glm::dmat4 to_mesh = glm::inverse(to_owner);
  for (const glm::dvec3& position : triangles.positions) {
    const glm::dvec3 in_mesh(to_mesh * glm::dvec4(position, 1.0));
    low = glm::min(low, in_mesh);
    high = glm::max(high, in_mesh);
  }
  return exact_part(reader, node, kind, low, high, to_owner);
}

/// Draws an exact shape as it is felt.
void append_shape(const PartDescription& part, const DrawMaterial& material, OwnerShape& owner) {
  constexpr int kRoundTool = 12;  // facets: 48 around
  constexpr int kFlatTool = 2;
  const bool flat = part.shape.kind == ShapeKind::kBox;
  MeshTriangles drawn = drawn_mesh(
      owner.rigid ? tessellate(part.shape, flat ? kFlatTool : kRoundTool) : part.surface);
  drawn.materials = {material};
  drawn.materials.front().textures = {};  // their places on the shape are not known
  drawn.triangle_materials.assign(drawn.triangles.size(), 0);
  append_draw_mesh(drawn, owner.draw);
}

/// A part without a mesh: a shape of the size that the node's keys say.
void add_meshless_part(const SceneReader& reader, std::size_t node, const glm::dmat4& to_owner,
                       OwnerShape& owner) {
  const ShapeKind kind = shape_kind(reader.keys[node].text("torsion_shape").value_or("mesh"));
  if (kind == ShapeKind::kMesh) {
    reader.problems.add(reader.name(node), "torsion_size", "",
                        "is the size of a shape, but there is neither a torsion_shape nor a mesh",
                        "set torsion_shape to box, sphere, ellipsoid, cylinder or capsule");
    return;
  }
  const glm::dvec3 half = 0.5 * *reader.keys[node].vector("torsion_size");
  std::optional<PartDescription> part = exact_part(reader, node, kind, -half, half, to_owner);
  if (part) {
    append_shape(*part, owner.look.plain, owner);
    owner.parts.push_back(std::move(*part));
  }
}

/// A part with a mesh that is felt as an exact shape: it is drawn so too, unless its keys want the
/// mesh, or that says which vertices are fixed.
void add_exact_part(const SceneReader& reader, std::size_t node, ShapeKind kind,
                    const MeshTriangles& triangles, const glm::dmat4& to_owner, OwnerShape& owner) {
  std::optional<PartDescription> part = part_of_box(reader, node, kind, triangles, to_owner);
  if (!part) {
    return;
  }
  const bool as_mesh = reader.keys[node].text("torsion_draw") == "mesh";
  if (as_mesh || !triangles.fixed.empty()) {
    append_draw_mesh(triangles, owner.draw);
  } else {
    append_shape(*part, triangles.materials.front(), owner);
  }
  owner.parts.push_back(std::move(*part));
}

/// One mesh of an owner: what is drawn, and the part that is felt.
void add_part(const SceneReader& reader, std::size_t node, OwnerShape& owner) {
  const std::string where = reader.name(node);
  const glm::dmat4 to_owner = owner.from_world * reader.nodes[node].to_world;
  if (reader.mesh(node) == nullptr) {
    add_meshless_part(reader, node, to_owner, owner);
    return;
  }
  if (reader.keys[node].vector("torsion_size")) {
    reader.problems.add(where, "torsion_size", "", "is for a node without a mesh",
                        "take it out: the mesh's bounding box says the size; or take out the mesh");
  }
  const MeshTriangles triangles =
      read_mesh(reader.model, *reader.mesh(node), to_owner, owner.look, where, reader.problems);
  if (triangles.triangles.empty()) {
    reader.problems.add(where, "mesh", "", "has no triangles");
    return;
  }
  const ShapeKind kind = shape_kind(reader.keys[node].text("torsion_shape").value_or("mesh"));
  if (kind != ShapeKind::kMesh) {
    add_exact_part(reader, node, kind, triangles, to_owner, owner);
    return;
  }
  append_draw_mesh(triangles, owner.draw);
  PartDescription part;
  part.node = reader.file_node(node).name;
  part.shape.kind = ShapeKind::kMesh;
  part.surface = closed_surface({triangles.positions, triangles.triangles}, where, reader.problems);
  owner.parts.push_back(std::move(part));
}

}  // namespace

SceneReader make_reader(const tinygltf::Model& model, const ProblemList& problems) {
  SceneReader reader{model, problems, list_scene_nodes(model), {}, {}, read_images(model)};
  if (!model.scenes.empty()) {
    const std::size_t shown = shown_scene(model);
    const tinygltf::Scene& scene = model.scenes[shown];
    reader.scene_keys.add(scene.extras, called("scene", "scenes", shown, scene.name), problems);
    reader.scene_keys.check_role(Role::kScene, problems);
  }
  for (std::size_t node = 0; node < reader.nodes.size(); ++node) {
    reader.keys.push_back(keys_of(reader, node));
    const Role role = checked_role(reader, node);
    reader.keys[node].check_role(role, problems);
    if (role == Role::kPart) {
      continue;
    }
    const std::size_t owner = reader.nodes[node].parent == SIZE_MAX
                                  ? SIZE_MAX
                                  : reader.nodes[reader.nodes[node].parent].owner;
    const bool elastic_above = owner != SIZE_MAX && reader.nodes[owner].role == Role::kElastic;
    if ((role == Role::kElastic || role == Role::kTool) && owner != SIZE_MAX) {
      problems.add(reader.name(node), "torsion_role", "", "is below " + reader.name(owner),
                   "move it out: an elastic body or a tool holds no other");
    } else if (role != Role::kNone && role != Role::kElastic && role != Role::kTool &&
               !elastic_above) {
      problems.add(reader.name(node), "torsion_role", "", "expected an elastic node above it",
                   "make it a child of the body that it holds");
    }
  }
  return reader;
}

OwnerShape read_owner_shape(const SceneReader& reader, std::size_t owner) {
  OwnerShape shape;
  const std::optional<NodeTransform> transform = split_transform(reader.nodes[owner].to_world);
  if (!transform) {
    reader.problems.add(reader.name(owner), "scale", "",
                        "it is sheared or flattened by its own scale and its parents'",
                        "apply the scales (Blender: Object > Apply > Scale)");
    return shape;
  }
  // Without a material, bodies and tools must be told apart.
  constexpr glm::vec4 kBodyColor(0.80F, 0.42F, 0.22F, 1.0F);
  constexpr glm::vec4 kToolColor(0.25F, 0.38F, 0.55F, 1.0F);
  shape.rigid = reader.nodes[owner].role == Role::kTool;
  shape.look.images = reader.images;
  shape.look.plain.color = shape.rigid ? kToolColor : kBodyColor;
  shape.pose = {transform->translation, transform->rotation};
  shape.from_world = glm::inverse(glm::translate(glm::dmat4(1.0), shape.pose.position) *
                                  glm::mat4_cast(shape.pose.rotation));
  bool any = false;
  for (std::size_t node = owner; node < reader.nodes.size(); ++node) {
    const SceneNode& listed = reader.nodes[node];
    const bool holds = listed.role != Role::kNone && node != owner;
    if (listed.owner == owner && !holds && is_solid(reader, node)) {
      add_part(reader, node, shape);
      any = true;
    }
  }
  if (!any) {
    reader.problems.add(reader.name(owner), "mesh", "", "is missing, here and below",
                        "give the node a mesh, or a torsion_shape with a torsion_size");
  }
  return shape;
}

}  // namespace torsion::engine
