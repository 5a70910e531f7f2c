#include "render/auto_camera.hpp"

#include <gtest/gtest.h>

#include "tests/render/render_scenes.hpp"

namespace torsion::engine {
namespace {

TEST(AutoCameraTest, EveryVertexIsInThePicture) {
  const FrameWorld frame =
      make_frame_world({{box_mesh({0.5F, 0.1F, 0.2F}, 2), {glm::dvec3(3.0, 0.0, 0.0), {}}, {}}},
                       {{sphere_mesh(0.3F, 4), {glm::dvec3(3.2, 0.5, 0.1), {}}, {}}});
  for (const double aspect : {16.0 / 9.0, 1.0, 0.5}) {
    const Camera camera = auto_camera(frame, aspect);
    const glm::dmat4 to_clip = projection_matrix(camera, aspect) * view_matrix(camera);
    for (const VertexRest& vertex : frame.body_vertices.column<VertexRest>()) {
      const glm::dvec3 world = glm::dvec3(glm::vec3(vertex.position)) + glm::dvec3(3.0, 0.0, 0.0);
      const glm::dvec4 clip = to_clip * glm::dvec4(world, 1.0);
      EXPECT_LT(std::abs(clip.x), clip.w);
      EXPECT_LT(std::abs(clip.y), clip.w);
      EXPECT_GT(clip.z, 0.0);
      EXPECT_LT(clip.z, clip.w);
    }
  }
}

TEST(AutoCameraTest, TheToolsWayAndItsArrowsAreInThePictureUnlessTheyAreFar) {
  const FrameWorld frame =
      make_frame_world({{box_mesh({0.5F, 0.1F, 0.2F}, 2), {}, {}}},
                       {{sphere_mesh(0.1F, 4), {glm::dvec3(0.0, 0.2, 0.0), {}}, {}}});
  const auto at = [](double x, double y) {
    return std::vector<Pose>{{{x, y, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}};
  };
  std::vector<std::vector<Pose>> poses = {at(0.0, 0.2), at(1.2, 0.2), at(-1.0, 0.3)};
  constexpr double kAspect = 1.5;
  const auto seen = [&](const Camera& camera, const glm::dvec3& point) {
    const glm::dvec4 clip =
        projection_matrix(camera, kAspect) * view_matrix(camera) * glm::dvec4(point, 1.0);
    return std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w;
  };
  const Camera camera = auto_camera(frame, kAspect, poses);
  for (const std::vector<Pose>& moment : poses) {
    const glm::dvec3& center = moment[0].position;
    for (const glm::dvec3& beside :
         {glm::dvec3(0.1, 0.0, 0.0), glm::dvec3(-0.1, 0.0, 0.0), glm::dvec3(0.0, 0.6, 0.0)}) {
      EXPECT_TRUE(seen(camera, center + beside));
    }
  }
  EXPECT_FALSE(seen(auto_camera(frame, kAspect), glm::dvec3(1.3, 0.2, 0.0)));
  // It comes from ten metres away: that is not shown.
  poses.push_back(at(0.0, 10.0));
  EXPECT_EQ(auto_camera(frame, kAspect, poses).pose.position, camera.pose.position);
}

TEST(AutoCameraTest, LooksDownOnTheScene) {
  const FrameWorld frame = make_frame_world({{box_mesh(glm::vec3(1.0F), 1), {}, {}}}, {});
  const Camera camera = auto_camera(frame, 1.5);
  EXPECT_GT(camera.pose.position.y, 1.0);
  const glm::dvec3 up = camera.pose.rotation * glm::dvec3(0.0, 1.0, 0.0);
  EXPECT_GT(up.y, 0.5);
}

TEST(AutoCameraTest, AnEmptySceneGivesACamera) {
  const Camera camera = auto_camera(make_frame_world({}, {}), 1.5);
  EXPECT_GT(camera.far_plane, camera.near_plane);
}

}  // namespace
}  // namespace torsion::engine
