#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/systems/surface/drawn_body.hpp"

namespace torsion::engine {
namespace {

TEST(DeformVerticesTest, MatchesRotationsInDoublePrecision) {
  Drawn drawn = cube();
  FrameBody& data = drawn.frame.bodies.at<FrameBody>(0);
  data.regions_drawn = 3;
  const auto axes = drawn.frame.axes.rows<TwistAxis>(data.axes);
  for (std::uint32_t slot = 0; slot < 3; ++slot) {
    const double i = slot;
    axes[slot].point = glm::vec4(0.01 * i, 0.02, -0.03, 0.0);
    axes[slot].direction =
        glm::vec4(glm::normalize(glm::vec3(1.0F, 0.5F - static_cast<float>(i), 0.3F)), 0.0F);
  }
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    for (std::uint32_t slot = 0; slot < 3; ++slot) {
      drawn.frame.twist.at<TwistAngle>(slot * drawn.vertices() + v).angle =
          static_cast<float>(std::sin(0.1 * v + slot) * 8.0);
    }
    drawn.frame.body_vertices.at<VertexDisplacement>(v).displacement =
        glm::vec4(0.001F, -0.002F, 0.003F, 5.0F);
  }
  drawn.positions.resize(drawn.vertices());
  deform_vertices(drawn.frame, 0, drawn.positions);
  for (std::uint32_t v = 0; v < drawn.vertices(); ++v) {
    glm::dvec3 x = drawn.rest(v);
    for (std::uint32_t slot = 0; slot < 3; ++slot) {
      const glm::dvec3 point(axes[slot].point);
      x = point +
          glm::angleAxis(drawn.twist(slot, v), glm::dvec3(axes[slot].direction)) * (x - point);
    }
    x += glm::dvec3(0.001F, -0.002F, 0.003F);
    // Three turns of points within 0.2 m: each rounds a few times to 6e-8 of that.
    EXPECT_NEAR(glm::distance(drawn.moved(v), x), 0.0, 3e-7);
  }
}

}  // namespace
}  // namespace torsion::engine
