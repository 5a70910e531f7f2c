#include "app/live/input_entry.hpp"

#include <algorithm>
#include <cmath>

#include "ecs/model_names.hpp"

namespace torsion::engine {
namespace {

void put_pose(const Pose& pose, double* values) {
  const glm::dvec3& p = pose.position;
  const glm::dquat& q = pose.rotation;
  const std::array<double, 7> all = {p.x, p.y, p.z, q.x, q.y, q.z, q.w};
  std::ranges::copy(all, values);
}

bool is_index_below(double value, std::size_t count) {
  return value >= 0.0 && value < static_cast<double>(count) && value == std::floor(value);
}

}  // namespace

InputEntry pose_entry(std::uint64_t step, std::uint32_t tool, const Pose& pose,
                      const Pose& handle) {
  InputEntry entry{InputKind::kPose, tool, step, {}};
  put_pose(pose, entry.values.data());
  put_pose(handle, entry.values.data() + 7);
  return entry;
}

InputEntry body_entry(std::uint64_t step, std::uint32_t body, const BodyPick& pick) {
  return {InputKind::kBody,
          body,
          step,
          {static_cast<double>(pick.contact), static_cast<double>(pick.body),
           pick.elasticity.youngs_modulus, pick.elasticity.poisson_ratio, pick.elasticity.density,
           pick.friction.static_friction, pick.friction.dynamic_friction}};
}

Pose pose_of(const InputEntry& entry) {
  const auto& v = entry.values;
  return {{v[0], v[1], v[2]}, glm::dquat(v[6], v[3], v[4], v[5])};
}

BodyPick pick_of(const InputEntry& entry) {
  const auto& v = entry.values;
  return {static_cast<ContactModel>(v[0]),
          static_cast<BodyModel>(v[1]),
          {v[2], v[3], v[4]},
          {v[5], v[6]}};
}

bool valid(const InputEntry& entry, std::uint32_t tools, std::uint32_t bodies) {
  const auto& v = entry.values;
  switch (entry.kind) {
    case InputKind::kPose:
      return entry.index < tools;
    case InputKind::kBody:
      // The scene reader's bounds of these values (docs/scenes.md).
      return entry.index < bodies && is_index_below(v[0], kContactModelNames.size()) &&
             is_index_below(v[1], kBodyModelNames.size()) && v[2] > 0.0 && v[3] >= 0.0 &&
             v[3] <= 0.5 && v[4] > 0.0 && v[6] >= 0.0 && v[5] >= v[6] && std::isfinite(v[2]) &&
             std::isfinite(v[4]) && std::isfinite(v[5]);
    case InputKind::kRebuild:
      return true;
  }
  return false;
}

}  // namespace torsion::engine
