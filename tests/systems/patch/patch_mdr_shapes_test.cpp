#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/math/frames.hpp"
#include "tests/reference/exact/flat_punch.hpp"
#include "tests/reference/exact/hertz_ellipse.hpp"
#include "tests/support/directions.hpp"
#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine {
namespace {

using test::BallScene;
using test::Hand;
using test::kBallDepth;
using test::kBallFriction;
using test::kBallModulus;
using test::kBallShearModulus;
using test::kUp;
using test::make_part;
using test::options_of;
using test::PressedBall;

struct ShapeCase {
  const char* name;
  BallScene scene;
  // bounds, relative or over the largest load
  double ellipse;
  double ellipse_couple;
  double punch;
  double punch_couple;
  double mesh;
  double feet;
};

void PrintTo(const ShapeCase& model, std::ostream* out) {
  *out << model.name;
}

// ellipse: the issue asks for 1 % of patch and 3 % of mdr. punch: the pressure is largest at the
// rim, and the cells there are in or out, which moves the radius by up to a half a cell, half of
// that on average: a / 18, a / 24 and a / 36 of patch; mdr takes the radius from the overlap's
// area, which 16 cells tell to a sixth of one. The couple goes with the square of the radius. mesh:
// the facets, see there.
const ShapeCase kShapeCases[] = {
    {"mdr", {.model = ContactModel::kMdr}, 0.003, 0.012, 0.025, 0.05, 0.02, 1e-3},
    {"patch12", {.side = 12}, 0.008, 0.01, 0.06, 0.13, 0.02, 0.03},
    {"patch16", {.side = 16}, 0.008, 0.01, 0.04, 0.07, 0.02, 0.03},
    {"patch24", {.side = 24, .iterations = 8}, 0.004, 0.01, 0.025, 0.05, 0.02, 0.01},
};

class ShapeTest : public testing::TestWithParam<ShapeCase> {};

/// A tool of this one part over the cube's top face, its lowest point `half_height` under its
/// frame, pressed `depth` deep and let settle.
Hand pressed_and_settled(const BallScene& ball, const PartDescription& part, double half_height,
                         double depth, double turn = 0.0) {
  SceneDescription scene = make_ball_scene(ball);
  scene.tools[0] = test::make_tool({part});
  Hand hand(scene, options_of(ball));
  hand.step_to({{glm::dvec3(0.0, 0.1 + half_height + 1e-6, 0.0), glm::angleAxis(turn, kUp)}});
  hand.move({0.0, -1e-6 - depth, 0.0}, kUp, 0.0, 200);
  hand.move(glm::dvec3(0.0), kUp, 0.0, 20);
  return hand;
}

/// Semi-axes of the ellipse with Hertz' pressure that has the second moments of the cells'
/// pressures: a^2 / 5 along an axis of length a.
struct Axes {
  double major;
  double minor;
};

Axes axes_of(const Hand& hand) {
  const World& world = hand.world();
  const RegionFrame& frame = world.state.regions.at<RegionFrame>(0);
  const std::uint32_t side = world.model.settings.grid_side;
  const auto cells =
      world.state.cells.rows<CellTraction>(world.state.regions.at<RegionIdentity>(0).cells);
  double sum = 0.0;
  glm::dvec2 first(0.0);
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const double pressure = cells[j * side + i].pressure;
      const glm::dvec2 place = cell_center(frame, side, i, j);
      sum += pressure;
      first += pressure * place;
      xx += pressure * place.x * place.x;
      xy += pressure * place.x * place.y;
      yy += pressure * place.y * place.y;
    }
  }
  first /= sum;
  xx = xx / sum - first.x * first.x;
  xy = xy / sum - first.x * first.y;
  yy = yy / sum - first.y * first.y;
  const double spread = std::hypot(xx - yy, 2.0 * xy);
  return {std::sqrt(2.5 * (xx + yy + spread)), std::sqrt(2.5 * (xx + yy - spread))};
}

TEST_P(ShapeTest, EllipsoidsPressAndSpinAsHertzsEllipse) {
  // Axes 1.7 : 1 and 3.6 : 1, along the grid and across it.
  for (const glm::dvec3& half : {glm::dvec3(0.06, 0.03, 0.04), glm::dvec3(0.08, 0.03, 0.03)}) {
    const double depth = 3e-4;
    const reference::HertzEllipse exact = reference::hertz_ellipse_at_depth(
        half.x * half.x / half.y, half.z * half.z / half.y, kBallModulus, depth);
    for (const double turn : {0.0, 0.6}) {
      Hand hand = pressed_and_settled(GetParam().scene, make_part(ShapeKind::kEllipsoid, half),
                                      half.y, depth, turn);
      EXPECT_NEAR(hand.wrench().force.y / exact.force, 1.0, GetParam().ellipse) << turn;
      if (GetParam().scene.model == ContactModel::kPatch && turn == 0.0) {
        // mdr spreads a round pressure over the cells, for those who draw it. A cell is a seventh
        // of the minor axis or less; the pressure there goes to zero. 1.1 % at 12 cells.
        const Axes axes = axes_of(hand);
        EXPECT_NEAR(axes.major / exact.major, 1.0, 0.015);
        EXPECT_NEAR(axes.minor / exact.minor, 1.0, 0.015);
      }
      hand.move(glm::dvec3(0.0), kUp, 0.25, 300);
      const double couple = reference::saturated_torque_ellipse(kBallFriction, exact.force,
                                                                exact.major, exact.parameter);
      EXPECT_NEAR(-hand.wrench().torque.y / couple, 1.0, GetParam().ellipse_couple) << turn;
    }
  }
}

TEST(EllipseTest, MdrTurnsLongContactsAsCellsDo) {
  // Axes 1.7 : 1 and 3.6 : 1: mdr's slip curve of an ellipse is a fit, cells know nothing of it.
  // 1.2 % of the fit and 1 % of 24 cells across, which are 7 across the minor axis.
  const BallScene springs{.model = ContactModel::kMdr};
  const BallScene cells{.side = 24, .iterations = 20};
  for (const glm::dvec3& half : {glm::dvec3(0.06, 0.03, 0.04), glm::dvec3(0.08, 0.03, 0.03)}) {
    const double depth = 3e-4;
    const PartDescription part = make_part(ShapeKind::kEllipsoid, half);
    Hand fitted = pressed_and_settled(springs, part, half.y, depth);
    Hand solved = pressed_and_settled(cells, part, half.y, depth);
    const reference::HertzEllipse exact = reference::hertz_ellipse_at_depth(
        half.x * half.x / half.y, half.z * half.z / half.y, kBallModulus, depth);
    const double largest = reference::saturated_torque_ellipse(kBallFriction, exact.force,
                                                               exact.major, exact.parameter);
    for (int step = 0; step < 240; ++step) {
      const double turn = step < 80 ? 1e-3 : -1e-3;
      fitted.move(glm::dvec3(0.0), kUp, turn, 1);
      solved.move(glm::dvec3(0.0), kUp, turn, 1);
      EXPECT_NEAR(fitted.wrench().torque.y, solved.wrench().torque.y, 0.03 * largest)
          << half.x << " " << step;
    }
  }
}

TEST_P(ShapeTest, AFlatPunchPressesSticksAndSpinsAsBoussinesqs) {
  const double radius = 0.01;
  const double depth = 2e-4;
  Hand hand = pressed_and_settled(
      GetParam().scene, make_part(ShapeKind::kCylinder, {radius, 0.02, radius}, {}, false, 24),
      0.02, depth);
  const double force = reference::flat_punch_force({radius, kBallModulus, depth});
  EXPECT_NEAR(hand.wrench().force.y / force, 1.0, GetParam().punch);
  const reference::LubkinContact exact{reference::PressureShape::kFlatPunch, force, kBallFriction,
                                       radius, kBallShearModulus};
  const double largest = reference::saturated_torque(exact);
  const double top = 3.0 * largest / reference::torsional_stiffness(exact);
  for (int step = 1; step <= 150; ++step) {
    hand.move(glm::dvec3(0.0), kUp, top / 150.0, 1);
    EXPECT_NEAR(-hand.wrench().torque.y, reference::torque(exact, top * step / 150.0),
                GetParam().punch_couple * largest);
  }
  EXPECT_NEAR(-hand.wrench().torque.y / largest, 1.0, GetParam().punch_couple);
}

/// Presses, twists and slides a ball of facets beside the exact one; bound over the largest loads.
/// @param fineness  squares along an edge of the cube that the ball's surface is cut as
void expect_facets_feel_smooth(const BallScene& ball, std::uint32_t fineness, double bound) {
  SceneDescription meshed = make_ball_scene(ball);
  meshed.tools[0] = test::make_tool(
      {make_part(ShapeKind::kSphere, glm::dvec3(test::kBallRadius), {}, true, fineness)});
  PressedBall exact(ball);
  Hand mesh(meshed, options_of(ball));
  mesh.step_to(exact.hand.poses);
  exact.press(kBallDepth, 300);
  mesh.move(exact.hand.poses[0].position - mesh.poses[0].position, kUp, 0.0, 300);
  EXPECT_NEAR(mesh.wrench().force.y / exact.normal_force(), 1.0, bound);
  const double limit = reference::full_slip_force(exact.mindlin());
  const double largest = reference::saturated_torque(exact.lubkin());
  for (int step = 0; step < 300; ++step) {
    const double slide = step < 150 ? 0.0 : 1e-5;
    exact.go(kBallDepth, {slide, 0.0}, 0.002, 1);
    mesh.move({slide, 0.0, 0.0}, kUp, 0.002, 1);
    EXPECT_NEAR(mesh.wrench().force.x, exact.friction().x, bound * limit) << step;
    EXPECT_NEAR(mesh.wrench().torque.y, exact.couple(), bound * largest) << step;
  }
}

TEST_P(ShapeTest, ABallOfFineFacetsFeelsLikeTheExactBall) {
  // Edges of 0.9 mm, a fifth of the contact's radius: facets lie up to (edge^2 + edge^2) / (8 R) =
  // 4 micrometres inside the sphere, two thirds of that on average: 0.6 % of the depth. Force goes
  // with depth^1.5, torque with its square.
  expect_facets_feel_smooth(GetParam().scene, 56, GetParam().mesh);
}

TEST(MdrMeshTest, EdgesOfAQuarterOfTheRadiusFeelSmooth) {
  // The goal. Over a triangle a face lies the sum of its squared edges over 24 R inside the
  // sphere. Squares of a quarter of the radius, with diagonals of a third: 1 % of the depth, 2.1 %
  // of the torque; where no edge is longer than a quarter half of that, and where the facets lie
  // under the contact does.
  expect_facets_feel_smooth({.model = ContactModel::kMdr}, 44, 0.021);
  expect_facets_feel_smooth({.model = ContactModel::kMdr}, 64, 0.015);
}

/// A tool of balls at these places along x over a wide slab whose top face is y = 0.1 m.
SceneDescription feet_scene(const BallScene& ball, const std::vector<double>& feet) {
  SceneDescription scene = make_ball_scene(ball);
  const BodyDescription slab =
      test::make_body({make_part(ShapeKind::kBox, {0.4, 0.05, 0.4},
                                 {glm::dvec3(0.0, 0.05, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)})});
  scene.bodies[0].parts = slab.parts;
  scene.bodies[0].fixed = slab.fixed;
  std::vector<PartDescription> parts;
  for (const double x : feet) {
    parts.push_back(make_part(ShapeKind::kSphere, glm::dvec3(test::kBallRadius),
                              {glm::dvec3(x, 0.0, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}));
  }
  scene.tools[0] = test::make_tool(parts);
  return scene;
}

TEST_P(ShapeTest, TwoFarFeetCarryWhatTwoSingleFeetDo) {
  // 0.2 m apart, without a body model: two half-spaces that do not know of each other. The feet go
  // around the axis between them, so each slides and spins; torques about the axis add up.
  // Where a grid happens to lie gives patch another staircase along the rim: twice its error.
  const std::vector<std::vector<double>> feet{{-0.1, 0.1}, {-0.1}, {0.1}};
  std::vector<Hand> hands;
  for (const std::vector<double>& places : feet) {
    hands.emplace_back(feet_scene(GetParam().scene, places), options_of(GetParam().scene));
  }
  for (Hand& hand : hands) {
    hand.step_to({{glm::dvec3(0.0, 0.1 + test::kBallRadius + 1e-6, 0.0), glm::dquat(1, 0, 0, 0)}});
    hand.move({0.0, -1e-6 - kBallDepth, 0.0}, kUp, 0.0, 200);
  }
  ASSERT_EQ(hands[0].world().state.regions.size(), 2U);
  // Slides of 0 to 0.5 mm: from partial slip to full.
  for (int step = 0; step < 100; ++step) {
    for (Hand& hand : hands) {
      hand.move({1e-6, 0.0, 0.0}, kUp, 5e-5, 1);
    }
    const Wrench& both = hands[0].wrench();
    const double normal = hands[1].wrench().force.y + hands[2].wrench().force.y;
    const double bound = GetParam().feet * normal;
    EXPECT_NEAR(both.force.y, normal, bound);
    EXPECT_NEAR(both.force.x, hands[1].wrench().force.x + hands[2].wrench().force.x, bound);
    EXPECT_NEAR(both.force.z, hands[1].wrench().force.z + hands[2].wrench().force.z, bound);
    EXPECT_NEAR(both.torque.y, hands[1].wrench().torque.y + hands[2].wrench().torque.y,
                0.1 * bound);
  }
  EXPECT_LT(hands[0].wrench().torque.y, -0.5);  // two feet at 0.75 * 10 N and 0.1 m
}

INSTANTIATE_TEST_SUITE_P(Models, ShapeTest, testing::ValuesIn(kShapeCases),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace torsion::engine
