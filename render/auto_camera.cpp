#include "render/auto_camera.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vector_relational.hpp>

#include "render/arrows.hpp"
#include "render/box.hpp"

namespace torsion::engine {
namespace {

constexpr double kFieldOfView = 0.5;  // rad
const glm::dvec3 kFrom(0.5, 0.62, 0.85);

template <class Owners, class Vertices>
void include(const Owners& owners, const Vertices& vertices, Box& box) {
  for (std::uint32_t row = 0; row < owners.size(); ++row) {
    const Pose& pose = owners.template at<Pose>(row);
    const DrawRange& range = owners.template at<DrawRange>(row);
    for (const VertexRest& vertex : vertices.template rows<VertexRest>(range.vertices)) {
      box.add(pose.rotation * glm::dvec3(glm::vec3(vertex.position)) + pose.position);
    }
  }
}

/// The corners of a tool's box on its way, and the ends of arrows over its middle. A tool that
/// comes from afar is not to make the contact small: what is farther from the bodies than their own
/// size is left out.
void include_way(const FrameWorld& frame, const Box& bodies,
                 std::span<const std::vector<Pose>> poses, Box& box) {
  const double side = bodies.largest_side();
  const glm::dvec3 lowest = bodies.lowest - side;
  const glm::dvec3 highest = bodies.highest + side;
  const auto add = [&](const glm::dvec3& point) {
    if (glm::all(glm::greaterThanEqual(point, lowest)) &&
        glm::all(glm::lessThanEqual(point, highest))) {
      box.add(point);
    }
  };
  for (std::uint32_t tool = 0; tool < frame.tools.size(); ++tool) {
    Box own;
    for (const VertexRest& vertex :
         frame.tool_vertices.rows<VertexRest>(frame.tools.at<DrawRange>(tool).vertices)) {
      own.add(glm::dvec3(glm::vec3(vertex.position)));
    }
    for (const std::vector<Pose>& moment : poses) {
      const Pose& pose = moment[tool];
      for (int corner = 0; !own.empty() && corner < 8; ++corner) {
        const glm::dvec3 share(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        add(pose.position + pose.rotation * (own.lowest + share * own.size()));
      }
      add(pose.position + pose.rotation * own.center() + glm::dvec3(0.0, kFullArrow * side, 0.0));
    }
  }
}

}  // namespace

Camera camera_of(const CameraDescription& description) {
  return {description.pose, description.vertical_field_of_view, description.near_plane,
          description.far_plane};
}

Camera auto_camera(const FrameWorld& frame, double aspect,
                   std::span<const std::vector<Pose>> poses) {
  Box box;
  include(frame.bodies, frame.body_vertices, box);
  if (!box.empty()) {
    include_way(frame, Box(box), poses, box);
  }
  include(frame.tools, frame.tool_vertices, box);
  Camera camera;
  if (box.empty()) {
    return camera;
  }
  const glm::dvec3 center = box.center();
  const double radius = 0.5 * glm::length(box.size());
  const double half_angle =
      std::min(0.5 * kFieldOfView, std::atan(std::tan(0.5 * kFieldOfView) * aspect));
  const double distance = 1.02 * radius / std::sin(half_angle);
  const glm::dvec3 back = glm::normalize(kFrom);
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), back));
  camera.pose.position = center + distance * back;
  camera.pose.rotation =
      glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
  camera.vertical_field_of_view = kFieldOfView;
  camera.near_plane = 0.05 * distance;
  camera.far_plane = 20.0 * distance;
  return camera;
}

}  // namespace torsion::engine
