#include "app/report/sphere_on_half_space.hpp"

#include <utility>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "app/report/paper_ball.hpp"
#include "app/report/shapes.hpp"

namespace torsion::engine {
namespace {

constexpr double kHalfSize = 2.0;  // m: 440 contact radii, so that the block is a half-space
constexpr int kPressPoints = 8;

}  // namespace

reference::HertzSphere sphere_contact(double modulus, double depth) {
  const reference::SneddonSphere exact =
      reference::sneddon_sphere_at_depth(kPaperBallRadius, modulus, depth);
  reference::HertzSphere contact =
      reference::hertz_sphere_at_depth(kPaperBallRadius, modulus, depth);
  contact.force = exact.force;
  contact.radius = exact.radius;
  return contact;
}

SphereOnHalfSpace sphere_on_half_space(bool quick) {
  SphereOnHalfSpace sphere;
  sphere.hertz = sphere_contact(sphere.elasticity.contact_modulus(), kPaperBallDepth);
  sphere.steps = quick ? 10 : 40;
  return sphere;
}

SceneDescription scene_of(const SphereOnHalfSpace& sphere) {
  SceneDescription scene;
  BodyDescription body;
  body.node = "half_space";
  body.elasticity = sphere.elasticity;
  body.friction = sphere.friction;
  body.fixed.kind = FixedKind::kFace;
  body.fixed.point = {0.0, -2.0 * kHalfSize, 0.0};
  body.fixed.normal = {0.0, 1.0, 0.0};
  body.parts.push_back(exact_part(ShapeKind::kBox, glm::dvec3(kHalfSize),
                                  {glm::dvec3(0.0, -kHalfSize, 0.0), {1.0, 0.0, 0.0, 0.0}}, 1));
  // Drawn is a piece around the contact.
  const double piece = 10.0 * sphere.hertz.radius;
  SurfaceMesh surface = shape_surface(ShapeKind::kBox, {piece, 0.4 * piece, piece}, 61);
  for (glm::dvec3& position : surface.positions) {
    position.y -= 0.4 * piece;
  }
  body.draw = drawn({surface}, false, {0.85F, 0.72F, 0.6F, 1.0F});
  scene.bodies.push_back(std::move(body));
  ToolDescription tool;
  tool.node = "ball";
  tool.parts.push_back(exact_part(ShapeKind::kSphere, glm::dvec3(kPaperBallRadius)));
  tool.draw = drawn({shape_surface(ShapeKind::kSphere, glm::dvec3(kPaperBallRadius), 41)}, true,
                    {0.45F, 0.55F, 0.7F, 1.0F});
  scene.tools.push_back(std::move(tool));
  return scene;
}

Pose pose_at(double depth, double turn, double shift) {
  return {glm::dvec3(shift, kPaperBallRadius - depth, 0.0),
          glm::angleAxis(turn, glm::dvec3(0.0, 1.0, 0.0))};
}

std::vector<PathPoint> press(const SphereOnHalfSpace& sphere, bool force_is_normal) {
  std::vector<PathPoint> path{
      {pose_at(-kStartClearance, 0.0, 0.0), 1, Leg::kApproach, 0.0, kNoReference, kNoReference}};
  for (int i = 1; i <= kPressPoints; ++i) {
    PathPoint point;
    const double depth = kPaperBallDepth * i / kPressPoints;
    point.tool = pose_at(depth, 0.0, 0.0);
    point.steps = sphere.steps;
    if (force_is_normal) {
      point.force = sphere_contact(sphere.elasticity.contact_modulus(), depth).force;
    }
    path.push_back(point);
  }
  return path;
}

std::string sphere_text(const SphereOnHalfSpace& sphere) {
  return fmt::format(
      "A rigid ball of radius {:.0f} mm on a block with sides of {:.0f} m (E = {:.3g} MPa, "
      "\u03bd = {:.2g}, \u03bc = {:.2g}) that stands for a half-space. It is pressed {:.4g} mm "
      "deep: "
      "F = {:.3g} N, contact radius a = {:.3g} mm.",
      1e3 * kPaperBallRadius, 2.0 * kHalfSize, 1e-6 * sphere.elasticity.youngs_modulus,
      sphere.elasticity.poisson_ratio, sphere.friction.dynamic_friction, 1e3 * kPaperBallDepth,
      sphere.hertz.force, 1e3 * sphere.hertz.radius);
}

}  // namespace torsion::engine
