#include "tests/support/pinched_column.hpp"

#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion::engine::test {
namespace {

constexpr double kBall = 0.02;  // m, radius

}  // namespace

SceneDescription pinched_column(double width, ContactModel contact, double friction) {
  constexpr double kHalfHeight = 0.05;  // m
  SceneDescription scene;
  BodyDescription body =
      make_body({make_part(ShapeKind::kBox, {0.5 * width, kHalfHeight, 0.5 * width},
                           {{0.0, kHalfHeight, 0.0}, kUpright})});
  body.elasticity = {1e6, 0.3, 1100.0};
  body.friction = {friction, friction};
  body.fixed.kind = FixedKind::kFace;
  body.fixed.point = glm::dvec3(0.0);
  body.fixed.normal = {0.0, 1.0, 0.0};
  body.models.contact = contact;
  body.models.body = BodyModel::kCompliance;
  scene.bodies = {body};
  for (int tool = 0; tool < 2; ++tool) {
    scene.tools.push_back(make_tool({make_part(ShapeKind::kSphere, glm::dvec3(kBall))}));
  }
  return scene;
}

std::vector<Pose> pinch_poses(double width, double left, double right) {
  constexpr double kLevel = 0.08;  // m
  const double x = 0.5 * width + kBall;
  return {{{left - x, kLevel, 0.0}, kUpright}, {{x - right, kLevel, 0.0}, kUpright}};
}

}  // namespace torsion::engine::test
