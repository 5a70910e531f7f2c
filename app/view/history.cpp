#include "app/view/history.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace torsion::engine {

Wrench in_contact_axes(const Wrench& world, const glm::dvec3& normal, const glm::dvec3& tangent_x) {
  if (normal == glm::dvec3(0.0)) {
    return world;
  }
  const glm::dvec3 tangent_y = glm::cross(normal, tangent_x);
  const auto turned = [&](const glm::dvec3& v) {
    return glm::dvec3(glm::dot(v, tangent_x), glm::dot(v, tangent_y), glm::dot(v, normal));
  };
  return {turned(world.force), turned(world.torque)};
}

void History::add(const LiveRow& row, double device_hz) {
  if (size_ > 0 && row.trace.time < (*this)[size_ - 1].time) {
    clear();  // the session began anew
  }
  longest_step_ = std::max(longest_step_, row.trace.step_us);
  latest_ = std::max(latest_, row.late_us);
  const bool switched = size_ > 0 && (*this)[size_ - 1].generation != row.generation;
  if (size_ > 0 && !switched && row.trace.time < (*this)[size_ - 1].time + 0.999 * kPeriod) {
    return;
  }
  points_[(first_ + size_) % kPoints] = {
      row.trace.time,
      row.trace.wrench,
      in_contact_axes(row.trace.wrench, row.normal, row.tangent_x),
      row.turn,
      row.couple,
      row.radius,
      row.contact,
      row.trace.load.normal_sum,
      glm::length(row.trace.load.friction.force),
      glm::length(row.trace.load.normal.torque + row.trace.load.friction.torque),
      glm::length(row.trace.load.couple),
      longest_step_,
      latest_,
      device_hz,
      row.generation};
  if (size_ < kPoints) {
    ++size_;
  } else {
    first_ = (first_ + 1) % kPoints;
  }
  longest_step_ = 0.0;
  latest_ = 0.0;
}

void History::clear() {
  first_ = 0;
  size_ = 0;
}

}  // namespace torsion::engine
