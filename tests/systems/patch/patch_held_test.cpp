#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "systems/patch/grid.hpp"
#include "systems/patch/solver.hpp"
#include "tests/reference/exact/flat_punch.hpp"
#include "tests/reference/exact/hertz_ellipse.hpp"
#include "tests/support/directions.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::Hand;
using test::kBallShearModulus;
using test::kUp;
using test::make_ball_scene;
using test::make_part;
using test::options_of;

/// Worst difference of the depressions that the first region's cells hold from those that its
/// pressures cause, over the largest depth.
double worst_difference(const Hand& hand) {
  const World& world = hand.world();
  const RegionIdentity& region = world.state.regions.at<RegionIdentity>(0);
  const RegionFrame& frame = world.state.regions.at<RegionFrame>(0);
  const Elasticity& elasticity = world.model.bodies.at<Elasticity>(region.body);
  const std::uint32_t side = world.model.settings.grid_side;
  const auto influences = world.model.influences.rows<Influence>(
      world.model.bodies.at<OwnedRows>(region.body).influences);
  const auto tractions = world.state.cells.rows<CellTraction>(region.cells);
  const auto held = world.state.patch_cells.rows<PatchDepression>(region.cells);
  std::vector<std::vector<double>> columns(11, std::vector<double>(tractions.size(), 0.0));
  for (std::size_t cell = 0; cell < tractions.size(); ++cell) {
    columns[4][cell] = tractions[cell].pressure;
    columns[5][cell] = -tractions[cell].traction.x;
    columns[6][cell] = -tractions[cell].traction.y;
  }
  PatchProblem problem;
  problem.influences = influence_tables({&influences.front().value, influences.size()}, side,
                                        table_aspect(frame.half_size));
  problem.compliance = 2.0 * frame.half_size.x / (side * elasticity.shear_modulus());
  problem.coupled = elasticity.poisson_ratio < 0.5;
  PatchWork work;
  work.reserve(side);
  displace_patch(problem,
                 {columns[0], columns[1], columns[2], columns[3], columns[4], columns[5],
                  columns[6], columns[7], columns[8], columns[9], columns[10]},
                 work);
  double worst = 0.0;
  for (std::size_t cell = 0; cell < tractions.size(); ++cell) {
    worst = std::max(worst, std::abs(columns[7][cell] - held[cell].value));
  }
  return worst / world.state.regions.at<Overlap>(0).largest_depth;
}

/// A tool of one part over the cube's top face, pressed `depth` deep.
Hand pressed(const BallScene& ball, const PartDescription& part, double half_height, double depth,
             double turn) {
  SceneDescription scene = make_ball_scene(ball);
  scene.tools[0] = test::make_tool({part});
  Hand hand(scene, options_of(ball));
  hand.step_to({{glm::dvec3(0.0, 0.1 + half_height + 1e-6, 0.0), glm::angleAxis(turn, kUp)}});
  hand.move({0.0, -1e-6 - depth, 0.0}, kUp, 0.0, 200);
  return hand;
}

TEST(PatchHeldTest, DisplacementsStayThoseOfTheTractionsWhileTheGridFollows) {
  // What the cells hold is carried from step to step with the tractions and extrapolated with them;
  // over some hundred steps and many moves of the grid only rounding may come in between.
  for (const double poisson : {0.3, 0.5}) {
    Hand hand = pressed({.poisson = poisson}, make_part(ShapeKind::kSphere, glm::dvec3(0.05)), 0.05,
                        test::kBallDepth, 0.0);
    for (int step = 0; step < 300; ++step) {
      hand.move({3e-5, step % 60 < 30 ? 2e-6 : -2e-6, 1e-5}, kUp, 1e-3, 1);
      ASSERT_LE(worst_difference(hand), 1e-9) << step;
    }
  }
}

TEST(PatchHeldTest, ASlidingPunchKeepsItsForce) {
  // The pressure is largest at the rim, where cells come and go as the punch wanders over them:
  // half a cell more or less of the radius, a / 24, and the rows that have just been let in or out.
  const double depth = 2e-4;
  Hand hand = pressed({}, make_part(ShapeKind::kCylinder, {0.01, 0.02, 0.01}, {}, false, 24), 0.02,
                      depth, 0.0);
  const double force = reference::flat_punch_force({0.01, 4.0 * kBallShearModulus, depth});
  for (int step = 0; step < 400; ++step) {
    hand.move({1e-5, 0.0, 0.0}, kUp, 0.0, 1);
    EXPECT_NEAR(hand.wrench().force.y / force, 1.0, 0.06) << step;
    ASSERT_LE(worst_difference(hand), 1e-9) << step;
  }
}

TEST(PatchHeldTest, ASlenderEllipseAcrossTheGridKeepsItsForceAndCouple) {
  // Axes 8 : 1 at 34 degrees to the grid: two to three cells across.
  const glm::dvec3 half(0.10, 0.02, 0.02);
  for (const std::uint32_t side : {12U, 16U}) {
    Hand hand = pressed({.side = side}, make_part(ShapeKind::kEllipsoid, half), half.y, 3e-4, 0.6);
    hand.move(glm::dvec3(0.0), kUp, 0.0, 20);
    const reference::HertzEllipse exact = reference::hertz_ellipse_at_depth(
        half.x * half.x / half.y, half.z * half.z / half.y, 4.0 * kBallShearModulus, 3e-4);
    EXPECT_NEAR(hand.wrench().force.y / exact.force, 1.0, 0.02) << side;
    hand.move(glm::dvec3(0.0), kUp, 0.25, 300);
    const double couple = reference::saturated_torque_ellipse(test::kBallFriction, exact.force,
                                                              exact.major, exact.parameter);
    EXPECT_NEAR(-hand.wrench().torque.y / couple, 1.0, 0.03) << side;
  }
}

}  // namespace
}  // namespace torsion::engine
