#include "systems/contact/strain.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace torsion::engine {

double traction_over_modulus(const Model& model, const State& state, std::uint32_t region) {
  const double area = state.regions.at<Contact>(region).area;
  if (!(area > 0.0)) {
    return 0.0;
  }
  const double force = std::hypot(state.regions.at<RegionNormal>(region).force,
                                  glm::length(state.regions.at<RegionFriction>(region).force));
  const std::uint32_t body = state.regions.at<RegionIdentity>(region).body;
  return force / area / model.bodies.at<Elasticity>(body).contact_modulus();
}

double support_tilt(const State& state, std::uint32_t region) {
  return glm::length(glm::cross(state.regions.at<RegionFrame>(region).normal,
                                state.regions.at<RegionSupport>(region).rotation));
}

}  // namespace torsion::engine
