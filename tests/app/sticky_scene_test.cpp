// The shipped scene whose friction falls where it slips, against boundary elements with the same
// law: tests/reference/boundary_elements/falling_friction.cpp.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/session.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine::test {
namespace {

struct CurvePoint {
  double turn = 0.0;  // where a = 1, G = 1 and mu_d p0 = 1
  double couple = 0.0;
};

std::vector<CurvePoint> falling_curve(double fall) {
  std::ifstream file(source_folder() + "/tests/reference/boundary_elements/falling_friction.csv");
  std::vector<CurvePoint> curve{{}};
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream stream(line);
    char comma = ',';
    double of = 0.0;
    CurvePoint point;
    stream >> of >> comma >> point.turn >> comma >> point.couple;
    if (of == fall) {
      curve.push_back(point);
    }
  }
  return curve;
}

double couple_at(const std::vector<CurvePoint>& curve, double turn) {
  const auto after = std::ranges::lower_bound(curve, turn, {}, &CurvePoint::turn);
  if (after == curve.begin() || after == curve.end()) {
    return after == curve.end() ? curve.back().couple : 0.0;
  }
  const auto before = after - 1;
  const double share = (turn - before->turn) / (after->turn - before->turn);
  return before->couple + share * (after->couple - before->couple);
}

// Until the twist turns back. The ball is pressed a fifth of its radius wide, where a sphere's
// couple is 0.6 % off a paraboloid's (1 + 2 / 45 (a / R)^2 of the largest, and 0.3 % of its
// stiffness); cells and steps as in falling_friction_test.cpp.
TEST(StickySceneTest, ItsFirstTwistIsNearBoundaryElements) {
  PrepareOptions options;
  options.contact_model = ContactModel::kPatch;
  options.body_model = BodyModel::kNone;
  Result<Session> opened =
      open_session(source_folder() + "/scenes/ball_on_cube_sticky.gltf", options, true);
  ASSERT_TRUE(opened) << opened.error().text;
  Session& session = opened.value();
  const World& world = session.simulation.world;
  const Elasticity elasticity = world.model.bodies.at<Elasticity>(0);
  const Friction friction = world.model.bodies.at<Friction>(0);
  ASSERT_NEAR(friction.static_friction / friction.dynamic_friction, 1.25, 1e-12);
  const std::vector<CurvePoint> curve = falling_curve(1.25);
  ASSERT_EQ(curve.size(), 101U);
  double largest = 0.0;
  double worst = 0.0;
  double turned = 0.0;
  int compared = 0;
  for (std::uint64_t step = 0; step < steps_in(session, session.scene.duration); ++step) {
    step_scripted(session);
    if (world.state.regions.size() != 1) {
      continue;
    }
    const double turn = std::abs(world.state.regions.at<RegionMotion>(0).turn);
    if (turn < turned) {
      break;
    }
    turned = turn;
    if (turn < 1e-3) {
      continue;
    }
    const double depth = world.state.regions.at<Overlap>(0).largest_depth;
    const reference::SneddonSphere sphere =
        reference::sneddon_sphere_at_depth(0.03, elasticity.contact_modulus(), depth);
    const double pressure = 1.5 * sphere.force / (std::numbers::pi * sphere.radius * sphere.radius);
    const double limit = friction.dynamic_friction * pressure;
    const double unit = limit * std::pow(sphere.radius, 3);
    const double expected = couple_at(curve, turn * elasticity.shear_modulus() / limit);
    const double couple = std::abs(world.state.regions.at<RegionFriction>(0).couple) / unit;
    largest = std::max(largest, expected);
    worst = std::max(worst, std::abs(couple - expected));
    ++compared;
  }
  EXPECT_GT(compared, 100);
  EXPECT_LT(worst, 0.02 * largest);
}

}  // namespace
}  // namespace torsion::engine::test
