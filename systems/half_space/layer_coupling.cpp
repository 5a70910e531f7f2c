#include "systems/half_space/layer_coupling.hpp"

#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "systems/half_space/influence.hpp"
#include "systems/half_space/layer_kernel.hpp"

namespace torsion {

bool has_layer_kernel(const Model& model, std::uint32_t body) {
  const std::size_t tables = model.bodies.at<BodyModels>(body).contact == ContactModel::kPatch
                                 ? influence_count(model.settings.grid_side)
                                 : 0;
  return model.bodies.at<OwnedRows>(body).influences.count == tables + kLayerKernelSize;
}

glm::dmat3 layer_coupling(const Model& model, std::uint32_t body, const glm::dvec3& normal,
                          const glm::dvec3& offset, double thickness) {
  const auto rows = model.influences.rows<Influence>(model.bodies.at<OwnedRows>(body).influences);
  const std::span<const double> values(&rows.front().value, rows.size());
  const Elasticity& elasticity = model.bodies.at<Elasticity>(body);
  const glm::dvec3 other =
      std::abs(normal.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 first = glm::normalize(glm::cross(normal, other));
  const glm::dvec3 second = glm::cross(normal, first);
  const glm::dvec2 along(glm::dot(first, offset), glm::dot(second, offset));
  const LayerResponse at =
      layer_response(values.last(kLayerKernelSize), elasticity.poisson_ratio, along / thickness);
  // Of the kernel z points into the layer; u_x by pressure is minus u_z by traction along x.
  const glm::dmat3 local(at.xx, at.xy, -at.zx, at.xy, at.yy, -at.zy, at.zx, at.zy, at.zz);
  const glm::dmat3 axes(first, second, normal);
  return axes * local * glm::transpose(axes) / (elasticity.shear_modulus() * thickness);
}

}  // namespace torsion
