#include "systems/body_models/support_field.hpp"

#include <glm/mat2x2.hpp>

#include "systems/frames.hpp"

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

void find_support(const SupportField& field, const RegionFrame& frame, std::uint32_t side,
                  const SupportColumns& columns) {
  std::ranges::fill(columns.x, 0.0);
  std::ranges::fill(columns.y, 0.0);
  std::ranges::fill(columns.z, 0.0);
  if (field.along_x == glm::dvec3(0.0)) {
    return;
  }
  const glm::dvec3 from = frame.origin - field.origin;
  const glm::dvec2 origin(glm::dot(field.along_x, from), glm::dot(field.along_y, from));
  const glm::dmat2 turn(
      glm::dot(field.along_x, frame.tangent_x), glm::dot(field.along_y, frame.tangent_x),
      glm::dot(field.along_x, frame.tangent_y), glm::dot(field.along_y, frame.tangent_y));
  std::array<glm::dvec3, kSupportTerms> in_grid;
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    in_grid[k] = body_to_grid_direction(frame, field.terms[k]);
  }
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      const glm::dvec2 at = origin + turn * cell_center(frame, side, i, j);
      const auto terms = support_terms(support_coordinates(at));
      glm::dvec3 moved(0.0);
      for (std::size_t k = 0; k < kSupportTerms; ++k) {
        moved += terms[k] * in_grid[k];
      }
      columns.x[cell] = moved.x;
      columns.y[cell] = moved.y;
      columns.z[cell] = moved.z;
    }
  }
}

}  // namespace torsion
