#include "render/camera.hpp"

#include <cmath>

namespace torsion::engine {

glm::dmat4 view_matrix(const Camera& camera) {
  const glm::dquat to_camera = glm::conjugate(camera.pose.rotation);
  glm::dmat4 view = glm::mat4_cast(to_camera);
  view[3] = glm::dvec4(-(to_camera * camera.pose.position), 1.0);
  return view;
}

glm::dmat4 projection_matrix(const Camera& camera, double aspect) {
  const double scale = 1.0 / std::tan(camera.vertical_field_of_view / 2.0);
  const double n = camera.near_plane;
  const double f = camera.far_plane;
  glm::dmat4 projection(0.0);
  projection[0][0] = scale / aspect;
  projection[1][1] = -scale;
  projection[2][2] = f == 0.0 ? -1.0 : -f / (f - n);
  projection[2][0] = -2.0 * camera.shift;  // clip space is two wide, and w is -z
  projection[2][3] = -1.0;
  projection[3][2] = f == 0.0 ? -n : -f * n / (f - n);
  return projection;
}

}  // namespace torsion::engine
