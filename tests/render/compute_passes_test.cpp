// The compute passes against their CPU twins, and both against double precision.

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "render/normal_rings.hpp"
#include "systems/surface/surface_field.hpp"
#include "tests/render/gpu_fixture.hpp"
#include "tests/render/render_scenes.hpp"

namespace torsion::engine {
namespace {

/// The largest position's size in the scenes below, m: what errors are relative to.
constexpr double kSize = 0.08;

/// Two bodies in one set of columns; the first with one region, the second with three whose axes
/// differ, one of them turned more than once around. Numbers of vertices that no work group size
/// divides.
FrameWorld two_twisted_bodies() {
  FrameWorld frame = make_frame_world(
      {
          {sphere_mesh(0.03F, 7), {{-0.1, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}, glm::vec4(1.0F)},
          {box_mesh(glm::vec3(0.04F, 0.03F, 0.05F), 11), {}, glm::vec4(1.0F)},
      },
      {{sphere_mesh(0.01F, 3), {{0.0, 0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}}, glm::vec4(1.0F)}});
  const auto near = [](const glm::vec3& point, float reach) {
    return [=](const glm::vec3& rest) {
      const float away = glm::distance(rest, point) / reach;
      return away < 1.0F ? 1.0F - away : 0.0F;  // exactly 0 beyond its reach
    };
  };
  const glm::vec3 top(0.0F, 0.03F, 0.0F);
  const glm::vec3 side(0.04F, 0.0F, 0.01F);
  const auto share_top = near(top, 0.04F);
  const auto share_side = near(side, 0.05F);
  add_twist(frame, 0, top, glm::vec3(0.0F, 1.0F, 0.0F),
            [&](const glm::vec3& rest) { return 1.0F * share_top(rest); });
  add_twist(frame, 1, top, glm::normalize(glm::vec3(0.1F, 1.0F, 0.2F)),
            [&](const glm::vec3& rest) { return 9.0F * share_top(rest); });
  add_twist(frame, 1, side, glm::normalize(glm::vec3(-1.0F, 0.2F, 0.0F)),
            [&](const glm::vec3& rest) { return -0.8F * share_side(rest); });
  add_twist(frame, 1, -side, glm::vec3(0.0F, 0.0F, 1.0F), [&](const glm::vec3&) { return 3e-4F; });
  for (std::uint32_t i = 0; i < frame.body_vertices.size(); ++i) {
    const glm::vec4& rest = frame.body_vertices.at<VertexRest>(i).position;
    frame.body_vertices.at<VertexDisplacement>(i).displacement =
        glm::vec4(0.1F * rest.y, -0.003F, 0.05F * rest.x, 1000.0F * static_cast<float>(i));
  }
  return frame;
}

/// The definition in double: quaternions instead of Rodrigues' formula, std::sin inside.
glm::dvec3 turned_and_moved(const FrameWorld& frame, std::uint32_t body, std::uint32_t vertex) {
  const Range vertices = frame.bodies.at<DrawRange>(body).vertices;
  const auto& row = frame.bodies.at<FrameBody>(body);
  glm::dvec3 x(frame.body_vertices.at<VertexRest>(vertices.first + vertex).position);
  for (std::uint32_t slot = 0; slot < row.regions_drawn; ++slot) {
    const auto& axis = frame.axes.at<TwistAxis>(row.axes.first + slot);
    const float angle =
        frame.twist.at<TwistAngle>(row.twist.first + slot * vertices.count + vertex).angle;
    const glm::dvec3 point(axis.point);
    x = point +
        glm::angleAxis(static_cast<double>(angle), glm::dvec3(axis.direction)) * (x - point);
  }
  return x + glm::dvec3(
                 frame.body_vertices.at<VertexDisplacement>(vertices.first + vertex).displacement);
}

class ComputePassesTest : public GpuTest {
 protected:
  /// Positions and normals after `frames` pictures.
  void draw(const FrameWorld& frame, const RendererOptions& with, HeatMap heat, int frames = 1) {
    Renderer renderer = open(with, frame);
    const Snapshot snapshot = make_snapshot(frame.tools.size(), 0);
    const Camera camera = camera_at({0.2, 0.2, 0.3}, glm::dvec3(0.0), 0.6);
    DrawOptions options;
    options.heat_map = heat;
    for (int i = 0; i < frames; ++i) {
      must(renderer.draw(frame, snapshot, camera, options, nullptr));
    }
    positions_ = must(renderer.read_positions());
    normals_ = must(renderer.read_normals());
    ASSERT_EQ(positions_.size(), frame.body_vertices.size());
    ASSERT_EQ(normals_.size(), frame.body_vertices.size());
  }

  std::vector<glm::vec4> positions_;
  std::vector<glm::vec4> normals_;
};

/// The positions that the CPU twin gives for all bodies, in the order of the columns.
std::vector<glm::vec4> deformed_on_cpu(const FrameWorld& frame) {
  std::vector<glm::vec4> positions(frame.body_vertices.size());
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    const Range rows = frame.bodies.at<DrawRange>(body).vertices;
    deform_vertices(frame, body, std::span(positions).subspan(rows.first, rows.count));
  }
  return positions;
}

TEST_F(ComputePassesTest, DeformationEqualsItsCpuTwinAndDoublePrecision) {
  const FrameWorld frame = two_twisted_bodies();
  draw(frame, options(), HeatMap::kTwist);
  const std::vector<glm::vec4> twin = deformed_on_cpu(frame);
  double worst_twin = 0.0;
  double worst_double = 0.0;
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    const Range rows = frame.bodies.at<DrawRange>(body).vertices;
    for (std::uint32_t i = 0; i < rows.count; ++i) {
      const glm::dvec3 position(positions_[rows.first + i]);
      worst_twin =
          std::max(worst_twin, glm::distance(position, glm::dvec3(twin[rows.first + i])) / kSize);
      worst_double =
          std::max(worst_double, glm::distance(position, turned_and_moved(frame, body, i)) / kSize);
      // A sum of at most three floats below 10, in the same order.
      EXPECT_NEAR(positions_[rows.first + i].w, twin[rows.first + i].w, 1e-6F);
    }
  }
  // The goal is 1e-5. Per region about ten roundings of 6e-8 and 4e-8 from the series; what is
  // larger than the twin's part comes from another order of the same operations.
  EXPECT_LT(worst_twin, 1e-6);
  EXPECT_LT(worst_double, 3e-6);
}

TEST_F(ComputePassesTest, VerticesThatNoRegionTurnsStayBitForBit) {
  FrameWorld frame = two_twisted_bodies();
  for (VertexDisplacement& row : frame.body_vertices.column<VertexDisplacement>()) {
    row.displacement = glm::vec4(0.0F);
  }
  draw(frame, options(), HeatMap::kNone);
  const Range rows = frame.bodies.at<DrawRange>(0).vertices;
  const Range angles = frame.bodies.at<FrameBody>(0).twist;
  std::uint32_t still = 0;
  for (std::uint32_t i = 0; i < rows.count; ++i) {
    if (frame.twist.at<TwistAngle>(angles.first + i).angle == 0.0F) {
      ++still;
      EXPECT_EQ(glm::vec3(positions_[rows.first + i]),
                glm::vec3(frame.body_vertices.at<VertexRest>(rows.first + i).position));
    }
  }
  EXPECT_GT(still, 20U);
}

TEST_F(ComputePassesTest, PressureComesThroughAsItIs) {
  const FrameWorld frame = two_twisted_bodies();
  draw(frame, options(), HeatMap::kPressure);
  for (std::uint32_t i = 0; i < frame.body_vertices.size(); ++i) {
    EXPECT_EQ(positions_[i].w, 1000.0F * static_cast<float>(i));
  }
}

TEST_F(ComputePassesTest, NormalsEqualTheirCpuTwin) {
  const FrameWorld frame = two_twisted_bodies();
  draw(frame, options(), HeatMap::kTwist);
  const NormalRings rings = make_normal_rings(frame);
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    const Range rows = frame.bodies.at<DrawRange>(body).vertices;
    std::vector<glm::vec4> twin(rows.count);
    vertex_normals(frame, rings, body,
                   std::span<const glm::vec4>(positions_).subspan(rows.first, rows.count), twin);
    for (std::uint32_t i = 0; i < rows.count; ++i) {
      // The same float operations on the same positions; only the last normalisation may round
      // in another way.
      EXPECT_NEAR(glm::distance(normals_[rows.first + i], twin[i]), 0.0F, 1e-6F) << i;
    }
  }
}

TEST_F(ComputePassesTest, StagingGivesTheSameBits) {
  const FrameWorld frame = two_twisted_bodies();
  draw(frame, options(), HeatMap::kTwist, 3);
  const std::vector<glm::vec4> positions = positions_;
  const std::vector<glm::vec4> normals = normals_;
  RendererOptions staged = options();
  staged.force_staging = true;
  draw(frame, staged, HeatMap::kTwist, 3);
  EXPECT_EQ(positions, positions_);
  EXPECT_EQ(normals, normals_);
}

TEST_F(ComputePassesTest, StorageGivesTheSameBitsAsTexels) {
  const FrameWorld frame = two_twisted_bodies();
  draw(frame, options(), HeatMap::kTwist, 3);
  const std::vector<glm::vec4> positions = positions_;
  const std::vector<glm::vec4> normals = normals_;
  // Texels for all rows but one: views of what fits must still be valid, and nothing may read them.
  RendererOptions small = options();
  small.most_texels = frame.body_vertices.size() - 1;
  draw(frame, small, HeatMap::kTwist, 3);
  EXPECT_EQ(positions, positions_);
  EXPECT_EQ(normals, normals_);
}

TEST_F(ComputePassesTest, LaterFramesReadLaterColumns) {
  FrameWorld frame = two_twisted_bodies();
  for (const bool staging : {false, true}) {
    RendererOptions with = options();
    with.force_staging = staging;
    Renderer renderer = open(with, frame);
    const Snapshot snapshot = make_snapshot(1, 0);
    const Camera camera = camera_at({0.2, 0.2, 0.3}, glm::dvec3(0.0), 0.6);
    for (int i = 0; i < 5; ++i) {  // each slot more than twice
      for (VertexDisplacement& row : frame.body_vertices.column<VertexDisplacement>()) {
        row.displacement = glm::vec4(0.001F * static_cast<float>(i + 1), 0.0F, 0.0F, 0.0F);
      }
      must(renderer.draw(frame, snapshot, camera, {}, nullptr));
      // The columns were copied: what is written now is seen by no frame.
      frame.body_vertices.at<VertexDisplacement>(0).displacement = glm::vec4(9.0F);
      const std::vector<glm::vec4> positions = must(renderer.read_positions());
      frame.body_vertices.at<VertexDisplacement>(0).displacement =
          frame.body_vertices.at<VertexDisplacement>(1).displacement;
      const std::vector<glm::vec4> twin = deformed_on_cpu(frame);
      EXPECT_LT(glm::distance(glm::vec3(positions[0]), glm::vec3(twin[0])), 1e-6F);
      EXPECT_LT(glm::distance(glm::vec3(positions.back()), glm::vec3(twin.back())), 1e-6F);
    }
  }
}

}  // namespace
}  // namespace torsion::engine
