#include "library/describe_scene.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ecs/model_names.hpp"
#include "library/convert.hpp"
#include "scenes/closed_mesh.hpp"
#include "scenes/conventions.hpp"
#include "scenes/exact_shapes.hpp"
#include "scenes/fixed_regions.hpp"
#include "scenes/mass_properties.hpp"
#include "scenes/mesh_parts.hpp"
#include "scenes/problem.hpp"

namespace torsion {
namespace {

using engine::ProblemList;

/// Notes a number that the scene file's key of that meaning could not have.
void check_number(const std::string& where, const char* field, const char* key, double value,
                  const ProblemList& problems) {
  const auto* const row = std::ranges::find(engine::kSceneKeys, key, &engine::SceneKey::name);
  if (!row->allows(value)) {
    problems.add(where, field, fmt::format("{}", value), "expected " + std::string(row->allowed));
  }
}

bool is_unit(const Quaternion& q) {
  return std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0) < 1e-6;
}

void check_pose(const std::string& where, const Pose& pose, const ProblemList& problems) {
  const bool finite = std::ranges::all_of(pose.position, [](double x) { return std::isfinite(x); });
  if (!finite || !is_unit(pose.orientation)) {
    const Quaternion& q = pose.orientation;
    problems.add(where, "pose",
                 fmt::format("({}, {}, {}) with ({}, {}, {}, {})", pose.position[0],
                             pose.position[1], pose.position[2], q[0], q[1], q[2], q[3]),
                 "expected a finite position and a quaternion w, x, y, z of length 1");
  }
}

struct KnownShape {
  Shape shape;
  engine::ShapeKind kind;
  const char* name;
};
constexpr KnownShape kShapes[] = {{Shape::kBox, engine::ShapeKind::kBox, "box"},
                                  {Shape::kSphere, engine::ShapeKind::kSphere, "sphere"},
                                  {Shape::kEllipsoid, engine::ShapeKind::kEllipsoid, "ellipsoid"},
                                  {Shape::kCylinder, engine::ShapeKind::kCylinder, "cylinder"},
                                  {Shape::kCapsule, engine::ShapeKind::kCapsule, "capsule"},
                                  {Shape::kMesh, engine::ShapeKind::kMesh, "mesh"}};

const KnownShape& known(Shape shape) {
  return *std::ranges::find(kShapes, shape, &KnownShape::shape);
}

void check_size(const std::string& where, const Part& part, const ProblemList& problems) {
  const Vector3& s = part.size;
  const auto near = [](double a, double b) {
    return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
  };
  const bool round = part.shape == Shape::kCylinder || part.shape == Shape::kCapsule;
  std::string expected;
  if (!std::ranges::all_of(s, [](double x) { return std::isfinite(x) && x > 0.0; })) {
    expected = "expected three full extents above 0 (m)";
  } else if (part.shape == Shape::kSphere && !(near(s[0], s[1]) && near(s[1], s[2]))) {
    expected = "expected three equal extents (m) for a sphere";
  } else if (round && !near(s[0], s[2])) {
    expected = "expected equal extents along x and z (m): the axis is y";
  } else if (part.shape == Shape::kCapsule && s[1] < s[0]) {
    expected = "expected an extent along y of at least that along x: it includes the caps";
  }
  if (!expected.empty()) {
    problems.add(where, "size", fmt::format("({}, {}, {})", s[0], s[1], s[2]), expected);
  }
}

/// A mesh in its owner's frame; empty and noted where its rows are wrong.
engine::SurfaceMesh surface_of(const std::string& where, const Part& part,
                               const ProblemList& problems) {
  engine::SurfaceMesh surface;
  const engine::Pose pose = to_engine(part.pose);
  for (const Vector3& vertex : part.mesh.vertices) {
    if (!std::ranges::all_of(vertex, [](double x) { return std::isfinite(x); })) {
      problems.add(where, "mesh.vertices", "", "expected finite numbers (m)");
      return {};
    }
    surface.positions.push_back(pose.position + pose.rotation * to_engine(vertex));
  }
  for (const std::array<std::uint32_t, 3>& t : part.mesh.triangles) {
    if (std::ranges::max(t) >= part.mesh.vertices.size()) {
      problems.add(
          where, "mesh.triangles", fmt::format("({}, {}, {})", t[0], t[1], t[2]),
          fmt::format("expected rows below {}, the number of vertices", part.mesh.vertices.size()));
      return {};
    }
    surface.triangles.emplace_back(t[0], t[1], t[2]);
  }
  return engine::closed_surface(surface, where, problems);
}

void append_part(const std::string& owner, const Part& part,
                 std::vector<engine::PartDescription>& parts, engine::DrawMesh& draw,
                 const ProblemList& problems) {
  const std::string where = fmt::format("{}, part {}", owner, parts.size());
  const std::size_t problems_before = problems.problems.size();
  check_pose(where, part.pose, problems);
  if (part.shape != Shape::kMesh) {
    check_size(where, part, problems);
  }
  engine::PartDescription& made = parts.emplace_back();
  made.node = where;
  if (problems.problems.size() > problems_before) {
    return;
  }
  made.shape.kind = known(part.shape).kind;
  made.shape.pose = to_engine(part.pose);
  made.shape.half_extent = 0.5 * to_engine(part.size);
  made.surface = part.shape == Shape::kMesh ? surface_of(where, part, problems)
                                            : engine::tessellate(made.shape);
  engine::MeshTriangles drawn;
  if (part.shape == Shape::kMesh) {
    drawn.positions = made.surface.positions;
    drawn.triangles = made.surface.triangles;
  } else {
    drawn = engine::drawn_mesh(made.surface);
  }
  engine::append_draw_mesh(drawn, draw);
}

std::vector<engine::FixedNode> fixed_nodes(const std::string& where, const Body& body,
                                           const ProblemList& problems) {
  std::vector<engine::FixedNode> nodes;
  if (body.fixed == Fixed::kPoint) {
    nodes.push_back({engine::Role::kFixedPoint,
                     glm::translate(glm::dmat4(1.0), to_engine(body.fixed_point)), where});
  }
  for (const FixedVolume& volume : body.fixed_volumes) {
    if (body.fixed != Fixed::kVolumes) {
      break;
    }
    check_pose(where + ", fixed volume", volume.pose, problems);
    const engine::Pose pose = to_engine(volume.pose);
    const engine::Role role = volume.kind == FixedVolume::Kind::kBox ? engine::Role::kFixedBox
                                                                     : engine::Role::kFixedSphere;
    nodes.push_back(
        {role,
         glm::scale(glm::translate(glm::dmat4(1.0), pose.position) * glm::mat4_cast(pose.rotation),
                    0.5 * to_engine(volume.size)),
         where});
  }
  return nodes;
}

void set_fixed(const std::string& where, const Body& body, engine::BodyDescription& made,
               const ProblemList& problems) {
  if (body.fixed == Fixed::kVolumes && body.fixed_volumes.empty()) {
    problems.add(where, "fixed_volumes", "", "expected at least one volume that holds the body");
    return;
  }
  if (body.fixed == Fixed::kAsInFile) {
    problems.add(where, "fixed", "kAsInFile", "expected what holds a body that no file describes");
    return;
  }
  made.fixed = {};
  made.fixed_volumes.clear();
  made.draw.fixed.assign(made.draw.positions.size(), false);
  const glm::dvec3 up = to_engine(body.up);
  if (std::abs(glm::dot(up, up) - 1.0) > 1e-6) {
    problems.add(where, "up", fmt::format("({}, {}, {})", up.x, up.y, up.z),
                 "expected a vector of length 1");
    return;
  }
  const char* const how = body.fixed == Fixed::kBottomFace     ? "bottom_face"
                          : body.fixed == Fixed::kBottomCenter ? "bottom_center"
                                                               : "children";
  engine::set_fixed_region(how, fixed_nodes(where, body, problems),
                           glm::conjugate(made.pose.rotation) * up, where, made, problems);
}

template <class Kind, class Named>
void take_model(const std::string& where, const char* field, const std::string& name,
                const Named& named, Kind& model, const ProblemList& problems) {
  const auto found = named(name);
  if (!found) {
    problems.add(where, field, '"' + name + '"', "expected the name of a model or \"auto\"");
    return;
  }
  model = *found;
}

void take_material(const std::string& where, const Body& body, engine::BodyDescription& made,
                   const ProblemList& problems) {
  const Material& material = body.material;
  check_number(where, "youngs_modulus", "torsion_youngs_modulus", material.youngs_modulus,
               problems);
  check_number(where, "poisson_ratio", "torsion_poisson_ratio", material.poisson_ratio, problems);
  check_number(where, "density", "torsion_density", material.density, problems);
  check_number(where, "static_friction", "torsion_static_friction", material.static_friction,
               problems);
  check_number(where, "dynamic_friction", "torsion_dynamic_friction", material.dynamic_friction,
               problems);
  if (material.static_friction < material.dynamic_friction) {
    problems.add(
        where, "static_friction", fmt::format("{}", material.static_friction),
        fmt::format("expected at least dynamic_friction, which is {}", material.dynamic_friction),
        "raise the one or lower the other");
  }
  check_number(where, "tolerance", "torsion_tolerance", body.tolerance, problems);
  if (body.region_threshold != 0.0) {
    check_number(where, "region_threshold", "torsion_region_threshold", body.region_threshold,
                 problems);
  }
  made.elasticity = {material.youngs_modulus, material.poisson_ratio, material.density};
  made.friction = {material.static_friction, material.dynamic_friction};
  take_model(where, "contact_model", body.contact_model, engine::contact_model_named,
             made.models.contact, problems);
  take_model(where, "body_model", body.body_model, engine::body_model_named, made.models.body,
             problems);
  made.models.tolerance = body.tolerance;
  made.models.region_threshold = body.region_threshold;
}

engine::BodyDescription describe_body(const Scene& scene, const Body& body,
                                      const ProblemList& problems) {
  const std::string where = "body \"" + body.name + '"';
  engine::BodyDescription made;
  if (body.parts.empty()) {
    if (scene.file == nullptr || body.file_row >= scene.file->scene.bodies.size()) {
      problems.add(where, "parts", "", "expected at least one part");
      return made;
    }
    made = scene.file->scene.bodies[body.file_row];
  }
  const std::size_t problems_before = problems.problems.size();
  check_pose(where, body.pose, problems);
  const engine::Pose pose = to_engine(body.pose);
  if (!made.script.links.empty() &&
      (pose.position != made.pose.position || pose.rotation != made.pose.rotation)) {
    problems.add(where, "pose", "", "was set, but the file's animation moves the body",
                 "leave it as it is, or take a file without that animation");
  }
  made.pose = pose;
  for (const Part& part : body.parts) {
    append_part(where, part, made.parts, made.draw, problems);
  }
  if (problems.problems.size() == problems_before &&
      (body.fixed != Fixed::kAsInFile || !body.parts.empty())) {
    set_fixed(where, body, made, problems);
  }
  made.node = body.name;
  take_material(where, body, made, problems);
  return made;
}

engine::ToolDescription describe_tool(const Scene& scene, const Tool& tool,
                                      const ProblemList& problems) {
  const std::string where = "tool \"" + tool.name + '"';
  engine::ToolDescription made;
  check_number(where, "mass", "torsion_mass", tool.mass, problems);
  if (tool.parts.empty()) {
    if (scene.file == nullptr || tool.file_row >= scene.file->scene.tools.size()) {
      problems.add(where, "parts", "", "expected at least one part");
      return made;
    }
    made = scene.file->scene.tools[tool.file_row];
    made.mass.inertia *= tool.mass / made.mass.mass;
    made.mass.mass = tool.mass;
  } else {
    made.device = "mouse";  // moved by the program: no animation is expected
    for (const Part& part : tool.parts) {
      append_part(where, part, made.parts, made.draw, problems);
    }
    if (problems.problems.empty()) {
      made.mass = engine::mass_properties(made.parts, tool.mass);
    }
  }
  made.node = tool.name;
  if (tool.mass_center && problems.problems.empty()) {
    engine::move_mass_center(made.mass, to_engine(*tool.mass_center));
  }
  return made;
}

}  // namespace

Result<engine::SceneDescription> describe(const Scene& scene) {
  engine::SceneDescription made;
  std::vector<engine::Problem> found;
  const ProblemList problems{scene.file != nullptr ? scene.file->scene.path : "scene", found};
  if (scene.file != nullptr) {
    made.path = scene.file->scene.path;
    made.cameras = scene.file->scene.cameras;
    made.duration = scene.file->scene.duration;
  }
  for (const Body& body : scene.bodies) {
    made.bodies.push_back(describe_body(scene, body, problems));
  }
  for (const Tool& tool : scene.tools) {
    made.tools.push_back(describe_tool(scene, tool, problems));
  }
  if (scene.bodies.empty() || scene.tools.empty()) {
    problems.add("", scene.bodies.empty() ? "bodies" : "tools", "", "expected at least one");
  }
  if (!found.empty()) {
    return Error{engine::to_text(found)};
  }
  return made;
}

Scene scene_of(engine::SceneDescription description) {
  Scene scene;
  auto file = std::make_shared<SceneFile>();
  file->scene = std::move(description);
  for (const engine::BodyDescription& from : file->scene.bodies) {
    Body& body = scene.bodies.emplace_back();
    body.name = from.node;
    body.file_row = scene.bodies.size() - 1;
    body.pose = from_engine(from.pose);
    body.fixed = Fixed::kAsInFile;
    body.material = {from.elasticity.youngs_modulus, from.elasticity.poisson_ratio,
                     from.elasticity.density, from.friction.static_friction,
                     from.friction.dynamic_friction};
    body.contact_model = engine::name_of(from.models.contact);
    body.body_model = engine::name_of(from.models.body);
    body.tolerance = from.models.tolerance;
    body.region_threshold = from.models.region_threshold;
  }
  for (const engine::ToolDescription& from : file->scene.tools) {
    Tool& tool = scene.tools.emplace_back();
    tool.name = from.node;
    tool.file_row = scene.tools.size() - 1;
    tool.mass = from.mass.mass;
    tool.mass_center = from_engine(from.mass.center);
  }
  scene.path = file->scene.path;
  scene.duration = file->scene.duration;
  scene.file = std::move(file);
  return scene;
}

}  // namespace torsion
