#pragma once

#include <algorithm>
#include <cmath>

#include "tests/reference/exact/cattaneo_mindlin.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/support/contact_scenes.hpp"

namespace torsion::engine::test {

inline constexpr double kBallRadius = 0.05;                      // m
inline constexpr double kBallShearModulus = 1e6;                 // Pa
inline constexpr double kBallModulus = 4.0 * kBallShearModulus;  // E* at nu = 0.5, Pa
inline constexpr double kBallDepth = 4.12740906e-4;              // m: 10 N at nu = 0.5, a = 4.54 mm
inline constexpr double kBallFriction = 0.75;

/// What varies between the tests of a ball on the paper's cube. Without a body model the body is a
/// half-space.
struct BallScene {
  ContactModel model = ContactModel::kPatch;
  double poisson = 0.5;
  std::uint32_t side =
      16;  // cells along a side of the grid: 12 puts 50 to 90 in contact, 16 110 to 170
  std::uint32_t iterations = 2;
  double static_friction = kBallFriction;
  double dynamic_friction = kBallFriction;
  BodyModel body = BodyModel::kNone;
};

inline SceneDescription make_ball_scene(const BallScene& ball) {
  SceneDescription scene = ball_on_cube();
  BodyDescription& body = scene.bodies[0];
  body.models = {};
  body.models.contact = ball.model;
  body.models.body = ball.body;
  body.elasticity.poisson_ratio = ball.poisson;
  body.elasticity.youngs_modulus = 2.0 * kBallShearModulus * (1.0 + ball.poisson);
  body.friction = {ball.static_friction, ball.dynamic_friction};
  return scene;
}

inline PrepareOptions options_of(const BallScene& ball) {
  PrepareOptions options;
  options.settings.grid_side = ball.side;
  options.settings.iterations = ball.iterations;
  return options;
}

/// A ball over the middle of the cube's top face, driven relative to where it touches.
class PressedBall {
 public:
  explicit PressedBall(const BallScene& ball)
      : ball_(ball), hand(make_ball_scene(ball), options_of(ball)) {
    hand.step_to({{glm::dvec3(0.0, 0.1 + kBallRadius + kStart, 0.0), glm::dquat(1, 0, 0, 0)}});
  }
  /// To this depth, straight down or up.
  void press(double depth, int steps) { go(depth, glm::dvec2(0.0), 0.0, steps); }
  void twist(double turn, int steps) { go(depth_, glm::dvec2(0.0), turn, steps); }
  void slide(const glm::dvec2& way, int steps) { go(depth_, way, 0.0, steps); }
  /// To this depth, further by `way` (world x and z) and by `turn` about the world's y.
  void go(double depth, const glm::dvec2& way, double turn, int steps) {
    hand.move(glm::dvec3(way.x, depth_ - depth, way.y), glm::dvec3(0.0, 1.0, 0.0), turn, steps);
    depth_ = depth;
  }

  /// Of the tool on the body where the hand holds against it.
  [[nodiscard]] double normal_force() const { return hand.wrench().force.y; }
  [[nodiscard]] glm::dvec2 friction() const {
    return {hand.wrench().force.x, hand.wrench().force.z};
  }
  /// About the contact's normal, N m; opposes the twist.
  [[nodiscard]] double couple() const { return hand.wrench().torque.y; }
  [[nodiscard]] double depth() const { return depth_; }

  /// Cells with pressure in the first region.
  [[nodiscard]] int loaded_cells() const {
    const World& world = hand.world();
    const auto cells =
        world.state.cells.rows<CellTraction>(world.state.regions.at<RegionIdentity>(0).cells);
    return static_cast<int>(
        std::ranges::count_if(cells, [](const CellTraction& cell) { return cell.pressure > 0.0; }));
  }

  // The exact contact at the present depth.
  /// With the radius and the force of a sphere, which are not quite a paraboloid's: at a / R = 0.1
  /// to 0.13 Hertz' torque is 0.2 to 0.3 % off, as much as 24 cells a side miss.
  [[nodiscard]] reference::HertzSphere hertz() const {
    const double modulus = 2.0 * kBallShearModulus / (1.0 - ball_.poisson);
    reference::HertzSphere contact = reference::hertz_sphere_at_depth(kBallRadius, modulus, depth_);
    const reference::SneddonSphere sphere =
        reference::sneddon_sphere_at_depth(kBallRadius, modulus, depth_);
    contact.force = sphere.force;
    contact.radius = sphere.radius;
    return contact;
  }
  [[nodiscard]] reference::LubkinContact lubkin() const {
    const reference::HertzSphere sphere = hertz();
    return {reference::PressureShape::kHertz, sphere.force, ball_.dynamic_friction, sphere.radius,
            kBallShearModulus};
  }
  [[nodiscard]] reference::CattaneoMindlin mindlin() const {
    const reference::HertzSphere sphere = hertz();
    return {sphere.force, ball_.dynamic_friction, sphere.radius,
            4.0 * kBallShearModulus / (2.0 - ball_.poisson)};
  }

 private:
  static constexpr double kStart = 1e-6;  // m over the face
  BallScene ball_;
  double depth_ = -kStart;

 public:
  Hand hand;
};

}  // namespace torsion::engine::test
