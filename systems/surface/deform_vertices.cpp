#include "systems/surface/surface_field.hpp"
#include "systems/surface/turn_vertex.hpp"

namespace torsion {

void deform_vertices(const FrameWorld& frame, std::uint32_t body, std::span<glm::vec4> positions) {
  const FrameBody& data = frame.bodies.at<FrameBody>(body);
  const Range vertices = frame.bodies.at<DrawRange>(body).vertices;
  TORSION_ASSERT(positions.size() == vertices.count);
  const auto rest = frame.body_vertices.rows<VertexRest>(vertices);
  const auto displacement = frame.body_vertices.rows<VertexDisplacement>(vertices);
  const auto twist = frame.twist.rows<TwistAngle>(data.twist);
  const auto axes = frame.axes.rows<TwistAxis>(data.axes);
  for (std::uint32_t vertex = 0; vertex < vertices.count; ++vertex) {
    glm::vec3 position(rest[vertex].position);
    float turned = 0.0F;  // rad, as the heat map shows it
    for (std::uint32_t slot = 0; slot < data.regions_drawn; ++slot) {
      const float angle = twist[slot * vertices.count + vertex].angle;
      if (angle != 0.0F) {
        position = turn_vertex(position, axes[slot], angle);
        turned += angle;
      }
    }
    positions[vertex] = glm::vec4(position + glm::vec3(displacement[vertex].displacement), turned);
  }
}

}  // namespace torsion
