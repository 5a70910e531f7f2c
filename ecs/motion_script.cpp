#include "ecs/motion_script.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

/// Between which keys a time lies, and how far from the one to the other.
struct Place {
  std::size_t key = 0;    // the earlier one
  double share = 0.0;     // 0 to 1
  double interval = 0.0;  // s; 0 where the time is not between two keys
};

Place place_at(const std::vector<double>& times, double time) {
  if (!(time > times.front())) {
    return {0, 0.0, 0.0};
  }
  if (time >= times.back()) {
    return {times.size() - 1, 0.0, 0.0};
  }
  const auto after = std::ranges::upper_bound(times, time);
  const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
  const double interval = times[key + 1] - times[key];
  return {key, (time - times[key]) / interval, interval};
}

/// The value at a key: CUBICSPLINE keeps it between its tangents.
const glm::dvec4& value_of(const KeyedChannel& channel, std::size_t key) {
  return channel.interpolation == Interpolation::kCubicSpline ? channel.values[3 * key + 1]
                                                              : channel.values[key];
}

/// glTF 2.0, appendix C.5: Hermite's cubic with tangents in units per second.
glm::dvec4 cubic(const KeyedChannel& channel, const Place& place) {
  const double t = place.share;
  const double t2 = t * t;
  const double t3 = t2 * t;
  const glm::dvec4& from = channel.values[3 * place.key + 1];
  const glm::dvec4& out_tangent = channel.values[3 * place.key + 2];
  const glm::dvec4& in_tangent = channel.values[3 * place.key + 3];
  const glm::dvec4& to = channel.values[3 * place.key + 4];
  return (2.0 * t3 - 3.0 * t2 + 1.0) * from + place.interval * (t3 - 2.0 * t2 + t) * out_tangent +
         (-2.0 * t3 + 3.0 * t2) * to + place.interval * (t3 - t2) * in_tangent;
}

glm::dquat quaternion(const glm::dvec4& xyzw) {
  return glm::normalize(glm::dquat(xyzw.w, xyzw.x, xyzw.y, xyzw.z));
}

}  // namespace

glm::dvec3 translation_at(const KeyedChannel& channel, double time) {
  const Place place = place_at(channel.times, time);
  if (place.interval == 0.0 || channel.interpolation == Interpolation::kStep) {
    return glm::dvec3(value_of(channel, place.key));
  }
  if (channel.interpolation == Interpolation::kCubicSpline) {
    return glm::dvec3(cubic(channel, place));
  }
  return glm::dvec3(
      glm::mix(channel.values[place.key], channel.values[place.key + 1], place.share));
}

glm::dquat rotation_at(const KeyedChannel& channel, double time) {
  const Place place = place_at(channel.times, time);
  if (place.interval == 0.0 || channel.interpolation == Interpolation::kStep) {
    return quaternion(value_of(channel, place.key));
  }
  if (channel.interpolation == Interpolation::kCubicSpline) {
    return quaternion(cubic(channel, place));
  }
  return glm::normalize(glm::slerp(quaternion(channel.values[place.key]),
                                   quaternion(channel.values[place.key + 1]), place.share));
}

Pose scripted_pose(const MotionScript& script, double time) {
  Pose pose;
  glm::dvec3 scale(1.0);
  for (const MotionLink& link : script.links) {
    const glm::dvec3 translation = link.animated_translation.empty()
                                       ? link.translation
                                       : translation_at(link.animated_translation, time);
    const glm::dquat rotation =
        link.animated_rotation.empty() ? link.rotation : rotation_at(link.animated_rotation, time);
    // Scales of turned links would shear: the reader lets only scales through that do not.
    pose.position += pose.rotation * (scale * translation);
    pose.rotation = glm::normalize(pose.rotation * rotation);
    scale *= link.scale;
  }
  return pose;
}

}  // namespace torsion::engine
