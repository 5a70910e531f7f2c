#include "systems/body/compliance/layer_motion.hpp"

#include <array>

#include <glm/geometric.hpp>

#include "systems/half_space/layer_coupling.hpp"

namespace torsion {
namespace {

std::array<DiscForces, 6> unit_wrenches(const ContactEllipse& contact, double DiscPoint::*shares) {
  std::array<DiscForces, 6> forces;
  for (std::size_t c = 0; c < 6; ++c) {
    glm::dvec3 force(0.0);
    glm::dvec3 couple(0.0);
    (c < 3 ? force : couple)[static_cast<int>(c % 3)] = 1.0;
    forces[c] = spread_wrench(contact, shares, force, couple);
  }
  return forces;
}

}  // namespace

Matrix6 layer_motion(const Model& model, std::uint32_t body, const ContactEllipse& contact,
                     double thickness) {
  const std::array<DiscForces, 6> loads = unit_wrenches(contact, &DiscPoint::ball_share);
  const std::array<DiscForces, 6> means = unit_wrenches(contact, &DiscPoint::disc_share);
  Matrix6 motion = Matrix6::Zero();
  for (std::size_t to = 0; to < kDiscPoints; ++to) {
    std::array<glm::dvec3, 6> moved{};
    for (std::size_t from = 0; from < kDiscPoints; ++from) {
      const glm::dvec2 away = disc_points()[to].place - disc_points()[from].place;
      const glm::dmat3 response =
          layer_coupling(model, body, contact.normal,
                         contact.axis_1 * away.x + contact.axis_2 * away.y, thickness);
      for (std::size_t c = 0; c < 6; ++c) {
        moved[c] += response * loads[c][from];
      }
    }
    for (std::size_t row = 0; row < 6; ++row) {
      for (std::size_t c = 0; c < 6; ++c) {
        motion(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(c)) +=
            glm::dot(means[row][to], moved[c]);
      }
    }
  }
  return motion;
}

}  // namespace torsion
