// How far off contact model mdr is where a contact rolls, for it knows no fresh material: what
// `auto` says of it (choose_models.cpp), against contact model patch, which is within 1 % there
// (patch_steady_rolling_test.cpp).

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "systems/model/choose_models.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::kBallDepth;
using test::kBallRadius;
using test::PressedBall;

struct Roll {
  double slide = 0.0;  // before it, of what makes all slip
  double turn = 0.0;   // likewise
  double creepage = 0.0;
  double spin = 0.0;  // 1/m
};

/// Friction along and across and the couple, at every tenth of a contact radius, over the largest.
std::vector<glm::dvec3> roll(ContactModel model, const Roll& path) {
  const BallScene scene{.model = model, .side = 20};
  PressedBall ball(scene);
  ball.press(kBallDepth, 200);
  ball.press(kBallDepth, 20);
  const double radius = ball.hertz().radius;
  const double limit = reference::full_slip_force(ball.mindlin());
  const double largest = reference::saturated_torque(ball.lubkin());
  const double slide = path.slide * reference::full_slip_displacement(ball.mindlin());
  const double turn = path.turn * largest / reference::torsional_stiffness(ball.lubkin());
  ball.go(kBallDepth, {0.6 * slide, 0.8 * slide}, turn, 100);
  const double way = 0.1 * radius;
  const glm::dvec3 turns(0.0, path.spin * way, -way * (1.0 - path.creepage) / kBallRadius);
  std::vector<glm::dvec3> loads;
  for (int k = 0; k < 20; ++k) {
    ball.hand.move({way, 0.0, 0.0}, glm::normalize(turns), glm::length(turns), 10);
    loads.emplace_back(ball.friction().x / limit, ball.friction().y / limit,
                       ball.couple() / largest);
  }
  return loads;
}

TEST(MdrRollingTest, IsAsFarOffAsAutoSays) {
  double farthest = 0.0;  // over what is said
  for (const Roll& path : {Roll{.slide = 0.5, .turn = 0.5}, Roll{.slide = 0.9}, Roll{.turn = 2.0},
                           Roll{.creepage = 0.02}, Roll{.creepage = 0.05}, Roll{.spin = 2.0},
                           Roll{.spin = 8.0}, Roll{.spin = 20.0}}) {
    const std::vector<glm::dvec3> found = roll(ContactModel::kMdr, path);
    const std::vector<glm::dvec3> right = roll(ContactModel::kPatch, path);
    for (std::size_t k = 0; k < found.size(); ++k) {
      ExpectedContact contact;
      contact.known = contact.any = true;
      contact.radius = 1.0;
      contact.body_depth = 1e9;
      contact.rolled = 0.1 * static_cast<double>(k + 1);
      const double said = mdr_error(contact, 0.5);
      const glm::dvec3 off = glm::abs(found[k] - right[k]);
      const double largest = std::max({off.x, off.y, off.z});
      EXPECT_LT(largest, said) << "slide " << path.slide << ", turn " << path.turn << ", creepage "
                               << path.creepage << ", spin " << path.spin << ", " << contact.rolled
                               << " radii";
      farthest = std::max(farthest, largest / said);
    }
  }
  // Nor is it said to be far worse than it is.
  EXPECT_GT(farthest, 0.5);
}

}  // namespace
}  // namespace torsion::engine
