#include "systems/contact/support/support_field.hpp"

namespace torsion {

glm::dvec3 displacement_at(const SupportField& field, const glm::dvec3& point) {
  const glm::dvec3 from = point - field.origin;
  const auto terms = support_terms(support_coordinates(
      glm::dvec2(glm::dot(field.along_x, from), glm::dot(field.along_y, from))));
  glm::dvec3 moved(0.0);
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    moved += terms[k] * field.terms[k];
  }
  return moved;
}

}  // namespace torsion
