#include "torsion/scene.hpp"

#include <algorithm>

#include "device/scripted_motion.hpp"
#include "ecs/assert.hpp"
#include "library/convert.hpp"
#include "library/describe_scene.hpp"
#include "scenes/load_gltf.hpp"

namespace torsion {
namespace {

Part exact_part(Shape shape, const Vector3& size, const Pose& pose) {
  Part part;
  part.shape = shape;
  part.size = size;
  part.pose = pose;
  return part;
}

}  // namespace

Part make_box(const Vector3& size, const Pose& pose) {
  return exact_part(Shape::kBox, size, pose);
}

Part make_sphere(double radius, const Pose& pose) {
  return exact_part(Shape::kSphere, {2.0 * radius, 2.0 * radius, 2.0 * radius}, pose);
}

Part make_ellipsoid(const Vector3& size, const Pose& pose) {
  return exact_part(Shape::kEllipsoid, size, pose);
}

Part make_cylinder(double radius, double height, const Pose& pose) {
  return exact_part(Shape::kCylinder, {2.0 * radius, height, 2.0 * radius}, pose);
}

Part make_capsule(double radius, double height, const Pose& pose) {
  return exact_part(Shape::kCapsule, {2.0 * radius, height, 2.0 * radius}, pose);
}

Part make_mesh(Mesh mesh, const Pose& pose) {
  Part part = exact_part(Shape::kMesh, {}, pose);
  part.mesh = std::move(mesh);
  return part;
}

Body* Scene::body(std::string_view name) noexcept {
  const auto found = std::ranges::find(bodies, name, &Body::name);
  return found == bodies.end() ? nullptr : &*found;
}

Tool* Scene::tool(std::string_view name) noexcept {
  const auto found = std::ranges::find(tools, name, &Tool::name);
  return found == tools.end() ? nullptr : &*found;
}

Result<Scene> load_scene(const std::string& path) {
  engine::LoadedScene loaded = engine::load_gltf(path);
  if (!loaded.scene) {
    return Error{engine::to_text(loaded.problems)};
  }
  return scene_of(*std::move(loaded.scene));
}

Pose animated_pose(const Scene& scene, std::size_t tool, double time) {
  TORSION_ASSERT(tool < scene.tools.size());
  const std::size_t row = scene.tools[tool].file_row;
  if (scene.file == nullptr || row >= scene.file->scene.tools.size()) {
    return {};
  }
  return from_engine(engine::scripted_pose(scene.file->scene.tools[row].script, time));
}

}  // namespace torsion
