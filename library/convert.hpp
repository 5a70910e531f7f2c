#pragma once

// Between the library's types and the engine's.

#include "ecs/components.hpp"
#include "torsion/types.hpp"

namespace torsion {

inline glm::dvec3 to_engine(const Vector3& v) {
  return {v[0], v[1], v[2]};
}
inline engine::Pose to_engine(const Pose& pose) {
  const Quaternion& q = pose.orientation;
  return {to_engine(pose.position), glm::dquat(q[0], q[1], q[2], q[3])};
}
inline Vector3 from_engine(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}
inline Pose from_engine(const engine::Pose& pose) {
  const glm::dquat& q = pose.rotation;
  return {from_engine(pose.position), {q.w, q.x, q.y, q.z}};
}
inline Wrench from_engine(const engine::Wrench& wrench) {
  return {from_engine(wrench.force), from_engine(wrench.torque)};
}

}  // namespace torsion
