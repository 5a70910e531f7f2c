#include "scenes/physics_extension.hpp"

#include <algorithm>
#include <cmath>

namespace torsion::engine {
namespace {

constexpr const char* kName = "KHR_physics_rigid_bodies";

/// `value`'s member, or nothing where either is missing.
const tinygltf::Value* member(const tinygltf::Value* value, const char* key) {
  return value != nullptr && value->IsObject() && value->Has(key) ? &value->Get(key) : nullptr;
}

const tinygltf::Value* extension_of(const tinygltf::ExtensionMap& extensions) {
  const auto found = extensions.find(kName);
  return found == extensions.end() ? nullptr : &found->second;
}

/// A finite number of at least `least`.
std::optional<double> number(const tinygltf::Value* value, double least) {
  if (value == nullptr || !value->IsNumber()) {
    return std::nullopt;
  }
  const double read = value->GetNumberAsDouble();
  return std::isfinite(read) && read >= least ? std::optional(read) : std::nullopt;
}

void read_motion_part(const tinygltf::Value* motion, PhysicsExtension& physics) {
  physics.mass = number(member(motion, "mass"), 1e-12);  // 0 means without bound: as if not there
  const tinygltf::Value* center = member(motion, "centerOfMass");
  if (center != nullptr && center->IsArray() && center->ArrayLen() == 3) {
    glm::dvec3 read(0.0);
    bool good = true;
    const auto& components = center->Get<tinygltf::Value::Array>();
    for (glm::length_t i = 0; i < 3; ++i) {
      const auto component = number(&components[static_cast<std::size_t>(i)], -1e6);
      good = good && component;
      read[i] = component.value_or(0.0);
    }
    physics.mass_center = good ? std::optional(read) : std::nullopt;
  }
}

void read_material(const tinygltf::Model& model, const tinygltf::Value* collider,
                   PhysicsExtension& physics) {
  const tinygltf::Value* row = member(collider, "physicsMaterial");
  const tinygltf::Value* materials = member(extension_of(model.extensions), "physicsMaterials");
  if (row == nullptr || !row->IsInt() || materials == nullptr || !materials->IsArray() ||
      row->Get<int>() < 0 || static_cast<std::size_t>(row->Get<int>()) >= materials->ArrayLen()) {
    return;
  }
  const tinygltf::Value* material =
      &materials->Get<tinygltf::Value::Array>()[static_cast<std::size_t>(row->Get<int>())];
  physics.dynamic_friction = number(member(material, "dynamicFriction"), 0.0);
  physics.static_friction = number(member(material, "staticFriction"), 0.0);
  if (physics.static_friction && physics.dynamic_friction) {
    physics.static_friction = std::max(*physics.static_friction, *physics.dynamic_friction);
  }
}

}  // namespace

PhysicsExtension read_physics_extension(const tinygltf::Model& model, const tinygltf::Node& node) {
  PhysicsExtension physics;
  const tinygltf::Value* extension = extension_of(node.extensions);
  read_motion_part(member(extension, "motion"), physics);
  read_material(model, member(extension, "collider"), physics);
  return physics;
}

}  // namespace torsion::engine
