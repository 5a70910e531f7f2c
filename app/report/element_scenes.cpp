#include "app/report/element_scenes.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "app/report/paper_ball.hpp"
#include "app/report/shapes.hpp"

namespace torsion::engine {
namespace {

const double kContact = std::sqrt(kPaperBallRadius * kPaperBallDepth);
constexpr glm::vec4 kBodyColor(0.85F, 0.72F, 0.6F, 1.0F);
constexpr glm::vec4 kToolColor(0.45F, 0.55F, 0.7F, 1.0F);

constexpr glm::dquat kUpright(1.0, 0.0, 0.0, 0.0);

struct Material {
  double youngs_modulus = 3e6;  // Pa
  double poisson_ratio = 0.4999;
  double friction = 0.75;
};

std::string material_text(const Material& material) {
  return fmt::format("E = {:.4g} MPa, \u03bd = {:.4g}, \u03bc = {:.3g}",
                     1e-6 * material.youngs_modulus, material.poisson_ratio, material.friction);
}

std::string length_text(double metres) {
  return metres < 1.0 ? fmt::format("{:.4g} mm", 1e3 * metres) : fmt::format("{:.3g} m", metres);
}

BodyDescription body_of(const Material& material) {
  BodyDescription body;
  body.node = "body";
  body.elasticity.youngs_modulus = material.youngs_modulus;
  body.elasticity.poisson_ratio = material.poisson_ratio;
  body.friction = {material.friction, material.friction};
  return body;
}

/// A block of the width and height whose top is y = 0, held at its bottom.
/// @param across  m: its other width, along z
BodyDescription block(double width, double across, double height, const Material& material,
                      double drawn_width) {
  BodyDescription body = body_of(material);
  body.fixed.kind = FixedKind::kFace;
  body.fixed.point = {0.0, -height, 0.0};
  body.fixed.normal = {0.0, 1.0, 0.0};
  const glm::dvec3 half(0.5 * width, 0.5 * height, 0.5 * across);
  body.parts.push_back(
      exact_part(ShapeKind::kBox, half, {glm::dvec3(0.0, -half.y, 0.0), kUpright}, 1));
  // Of a block that stands for a half-space a piece around the contact is drawn.
  const double share = drawn_width / width;
  const double drawn_height = share < 1.0 ? 0.5 * drawn_width : height;
  SurfaceMesh surface = shape_surface(
      ShapeKind::kBox, {0.5 * drawn_width, 0.5 * drawn_height, 0.5 * drawn_width * across / width},
      61);
  for (glm::dvec3& position : surface.positions) {
    position.y -= 0.5 * drawn_height;
  }
  body.draw = drawn({surface}, false, kBodyColor);
  for (const glm::vec3& position : body.draw.positions) {
    body.draw.fixed.push_back(static_cast<double>(position.y) < -(1.0 - 1e-6) * height);
  }
  return body;
}

ToolDescription tool_of(std::vector<PartDescription> parts) {
  ToolDescription tool;
  tool.node = "tool";
  std::vector<SurfaceMesh> surfaces;
  surfaces.reserve(parts.size());
  for (const PartDescription& part : parts) {
    surfaces.push_back(part.surface);
  }
  tool.draw = drawn(surfaces, true, kToolColor);
  tool.parts = std::move(parts);
  return tool;
}

/// What of a large ball is above a block of that width, so that the block can be seen: a lens.
DrawMesh cap_of_ball(double radius, double width) {
  SurfaceMesh lens = shape_surface(ShapeKind::kSphere, glm::dvec3(radius), 161);
  const double rim = 0.8 * width;
  const double top = -std::sqrt(radius * radius - rim * rim);
  std::erase_if(lens.triangles, [&](const glm::uvec3& triangle) {
    const glm::dvec3& corner = lens.positions[triangle.x];
    return corner.y > 0.0 || std::hypot(corner.x, corner.z) > rim;
  });
  // Its flat upper side: the same triangles, lifted and turned over.
  SurfaceMesh flat = lens;
  for (glm::dvec3& position : flat.positions) {
    position.y = top;
  }
  for (glm::uvec3& triangle : flat.triangles) {
    std::swap(triangle.y, triangle.z);
  }
  return drawn({lens, flat}, true, kToolColor);
}

ElementScene ball_on_block(std::string name, std::string title, double radius, double width,
                           double height, const Material& material, double across = 0.0) {
  ElementScene result;
  result.name = std::move(name);
  result.title = std::move(title);
  result.description = fmt::format(
      "A rigid ball of radius {:.4g} mm on a block of {} width{} and {} height ({}), held at its "
      "bottom.",
      1e3 * radius, length_text(width),
      across > 0.0 ? fmt::format(", {} length", length_text(across)) : "", length_text(height),
      material_text(material));
  result.finite_body = width < 1.0;
  result.scene.bodies.push_back(block(width, across > 0.0 ? across : width, height, material,
                                      result.finite_body ? width : 20.0 * kContact));
  result.scene.tools.push_back(
      tool_of({exact_part(ShapeKind::kSphere, glm::dvec3(radius), {}, 41)}));
  if (radius > width) {
    result.scene.tools[0].draw = cap_of_ball(radius, width);
  }
  result.touching = {glm::dvec3(0.0, radius, 0.0), kUpright};
  return result;
}

const glm::dvec3 kEllipsoid(0.07, 0.05, 0.06);  // m, half axes

/// The body of the shipped scenes mallet_on_ellipsoid and compass_on_ellipsoid, its top at the
/// origin. Its lowest point cannot hold a continuum, so its lowest tenth is held.
BodyDescription ellipsoid() {
  BodyDescription body = body_of(Material{});
  const Pose pose{glm::dvec3(0.0, -kEllipsoid.y, 0.0), kUpright};
  body.parts.push_back(exact_part(ShapeKind::kEllipsoid, kEllipsoid, pose, 41));
  body.draw = drawn({body.parts[0].surface}, true, kBodyColor);
  const double held_below = -0.9 * 2.0 * kEllipsoid.y;  // m
  FixedVolume held;
  const glm::dvec3 half(0.1, 0.05, 0.1);
  held.center = {0.0, held_below - half.y, 0.0};
  held.to_unit = glm::dmat3(1.0 / half.x, 0.0, 0.0, 0.0, 1.0 / half.y, 0.0, 0.0, 0.0, 1.0 / half.z);
  body.fixed.kind = FixedKind::kVolumes;
  body.fixed.volumes = {0, 1};
  // The centroid of the cap that is held, taken as a paraboloid: a third of its height from the
  // cut.
  body.fixed.point = {0.0, held_below - 0.1 * 2.0 * kEllipsoid.y / 3.0, 0.0};
  body.fixed_volumes.push_back(held);
  for (const glm::vec3& position : body.draw.positions) {
    body.draw.fixed.push_back(static_cast<double>(position.y) < held_below);
  }
  return body;
}

constexpr const char* kEllipsoidText =
    "an ellipsoid with half axes of 70, 50 (upright) and 60 mm (E = 3 MPa, \u03bd = 0.4999, \u03bc "
    "= "
    "0.75) whose lowest tenth is held";

ElementScene mallet_on_ellipsoid() {
  constexpr double kRadius = 0.015;      // m
  constexpr double kHalfLength = 0.020;  // m, of the middle line
  ElementScene result;
  result.name = "mallet_on_ellipsoid";
  result.title = "Mallet on an ellipsoid";
  result.description = fmt::format(
      "A lying rod with round ends, radius 15 mm, length 70 mm, on {}: the contact is "
      "long and narrow.",
      kEllipsoidText);
  result.scene.bodies.push_back(ellipsoid());
  // A capsule's axis is y: laid along x.
  const Pose lying{glm::dvec3(0.0),
                   glm::angleAxis(-0.5 * std::numbers::pi, glm::dvec3(0.0, 0.0, 1.0))};
  result.scene.tools.push_back(tool_of(
      {exact_part(ShapeKind::kCapsule, {kRadius, kHalfLength + kRadius, kRadius}, lying, 41)}));
  result.touching = {glm::dvec3(0.0, kRadius, 0.0), kUpright};
  result.flat_top = false;
  return result;
}

/// x component of the ellipsoid's outward normal at the abscissa x of its upper side, z = 0.
double normal_x(double x) {
  const double share = x / kEllipsoid.x;
  const glm::dvec2 normal(x / (kEllipsoid.x * kEllipsoid.x),
                          std::sqrt(1.0 - share * share) / kEllipsoid.y);
  return normal.x / std::hypot(normal.x, normal.y);
}

ElementScene compass_on_ellipsoid() {
  constexpr double kTip = 0.004;  // m
  const double lean = std::numbers::pi / 12.0;
  const double foot = 0.022 - kTip * std::sin(lean);  // m, of the tip's centre from the axis
  // Where the tip touches: the normal there goes through its centre. By bisection.
  double low = 0.0;
  double high = 0.05;
  while (high - low > 1e-16) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) {
      break;
    }
    (middle + kTip * normal_x(middle) < foot ? low : high) = middle;
  }
  const double share = low / kEllipsoid.x;
  const double up = normal_x(low);
  const double height =
      kEllipsoid.y * (std::sqrt(1.0 - share * share) - 1.0) + kTip * std::sqrt(1.0 - up * up);
  ElementScene result;
  result.name = "compass_on_ellipsoid";
  result.title = "Compass on an ellipsoid: two contacts";
  result.description = fmt::format(
      "Two round tips of radius 4 mm, {:.3g} mm apart, turned about the axis between them, on {}.",
      2e3 * foot, kEllipsoidText);
  result.scene.bodies.push_back(ellipsoid());
  std::vector<PartDescription> tips;
  for (const double side : {-1.0, 1.0}) {
    tips.push_back(exact_part(ShapeKind::kSphere, glm::dvec3(kTip),
                              {glm::dvec3(side * foot, 0.0, 0.0), kUpright}, 25));
  }
  result.scene.tools.push_back(tool_of(std::move(tips)));
  result.touching = {glm::dvec3(0.0, height, 0.0), kUpright};
  result.flat_top = false;
  return result;
}

}  // namespace

std::vector<ElementScene> element_scenes() {
  constexpr double kColumn = 0.05;  // m
  Material nu30;
  nu30.poisson_ratio = 0.3;
  Material nu49;
  nu49.poisson_ratio = 0.49;
  const Material soft{1e4, 0.4999, 5.0};
  std::vector<ElementScene> scenes;
  scenes.push_back(ball_on_block("half_space", "Ball on a half-space, by finite elements",
                                 kPaperBallRadius, 8000.0 * kContact, 4000.0 * kContact,
                                 Material{}));
  scenes.push_back(ball_on_block("ball_on_cube_nu30", "Ball on a cube, \u03bd = 0.3",
                                 kPaperBallRadius, 0.1, 0.1, nu30));
  scenes.push_back(ball_on_block("ball_on_cube_nu49", "Ball on a cube, \u03bd = 0.49",
                                 kPaperBallRadius, 0.1, 0.1, nu49));
  scenes.push_back(ball_on_block("thin_layer", "Ball on a thin layer", kPaperBallRadius,
                                 24.0 * kContact, 2.0 * kContact, Material{}));
  scenes.push_back(ball_on_block("soft_column", "Ball on a soft column: a large contact", 0.2,
                                 kColumn, kColumn, soft));
  const Material slender{1e6, 0.3, 0.5};
  scenes.push_back(
      ball_on_block("slender_column", "Ball on a slender column", 0.008, 0.008, 0.1, slender));
  scenes.push_back(ball_on_block("plate_on_edge", "Ball on the edge of a standing plate", 0.0036,
                                 0.006, 0.06, slender, 0.06));
  scenes.push_back(ball_on_block("large_strain_linear",
                                 "Ball pressed deep into a cube, as linear elasticity has it",
                                 kPaperBallRadius, 0.1, 0.1, nu49));
  ElementScene large = ball_on_block("large_strain", "Ball pressed deep into a cube, large strain",
                                     kPaperBallRadius, 0.1, 0.1, nu49);
  large.description +=
      " The reference is neo-Hookean at large strain: it shows where all models here, which are "
      "linear, end.";
  scenes.push_back(std::move(large));
  scenes.push_back(mallet_on_ellipsoid());
  scenes.push_back(compass_on_ellipsoid());
  return scenes;
}

}  // namespace torsion::engine
