// Tools on the edges and corners of a body: where the force points, and that it stays smooth.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kUpright;

constexpr ContactModel kEdgeContacts[] = {ContactModel::kPaper, ContactModel::kMdr,
                                          ContactModel::kPatch, ContactModel::kWinkler};
constexpr double kBlockHalf = 0.03;  // m: half the body's sides, and a cylinder's radius

/// A body about the origin and a tool, without friction.
SceneDescription scene_of(ContactModel contact, PartDescription body, PartDescription tool) {
  SceneDescription scene;
  scene.bodies.push_back(test::make_body({std::move(body)}));
  scene.bodies[0].models.contact = contact;
  scene.bodies[0].models.body = BodyModel::kNone;
  scene.bodies[0].models.region_threshold = 0.02;
  scene.bodies[0].friction = {0.0, 0.0};
  scene.tools.push_back(test::make_tool({std::move(tool)}));
  return scene;
}

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

// ---- A ball that goes from a block's top round its edge

constexpr double kGoingRadius = 0.01;  // m
constexpr int kTurnSteps = 600;

/// The ball's middle from the edge, m: pressed on the top, to the edge, a quarter turn round it,
/// off the side.
std::vector<glm::dvec2> way_round(double depth) {
  const double gap = 2e-5;  // m
  const double near = kGoingRadius - depth;
  std::vector<glm::dvec2> way;
  for (int i = 0; i <= 100; ++i) {
    way.emplace_back(-0.008, kGoingRadius + gap - (depth + gap) * i / 100.0);
  }
  for (int i = 1; i <= 320; ++i) {
    way.emplace_back(-0.008 + 0.008 * i / 320.0, near);
  }
  for (int i = 1; i <= kTurnSteps; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / kTurnSteps;
    way.emplace_back(near * std::sin(angle), near * std::cos(angle));
  }
  for (int i = 1; i <= 100; ++i) {
    way.emplace_back(near + (depth + gap) * i / 100.0, 0.0);
  }
  return way;
}

struct Round {
  double largest = 0.0;       // N
  double largest_step = 0.0;  // N
  double askew = 0.0;         // degrees: of the force from the way out, well round the edge
  double work = 0.0;          // J, into the ball's contact, at the end
  double most_work = 0.0;     // J
};

Round go_round(Hand& hand, const std::vector<glm::dvec2>& way) {
  Round round;
  glm::dvec2 at = way.front();
  glm::dvec2 before(0.0);
  for (const glm::dvec2& to : way) {
    hand.step_to({{{kBlockHalf + to.x, kBlockHalf + to.y, 0.0013}, kUpright}});
    const glm::dvec2 force(hand.wrench().force);
    round.work -= 0.5 * glm::dot(force + before, to - at);
    round.most_work = std::max(round.most_work, round.work);
    round.largest = std::max(round.largest, glm::length(force));
    round.largest_step = std::max(round.largest_step, glm::distance(force, before));
    if (to.x > 0.3 * kGoingRadius && to.y > 0.3 * kGoingRadius) {
      round.askew = std::max(round.askew, degrees_between({to, 0.0}, {force, 0.0}));
    }
    before = force;
    at = to;
  }
  EXPECT_EQ(hand.clock().faults, 0U);
  return round;
}

// With one plane for all of the way the force stayed that of the top, grew to 23 times what pressed
// the ball there, and took hundreds of times as much work as that.
TEST(AroundEdgesTest, ABallThatGoesRoundAnEdgeIsPushedOutEverywhere) {
  constexpr double kDepth = 3e-4;  // m
  const std::vector<glm::dvec2> there = way_round(kDepth);
  const std::vector<glm::dvec2> back(there.rbegin(), there.rend());
  for (const ContactModel contact : kEdgeContacts) {
    for (const bool mesh : {false, true}) {
      Hand pressed(scene_of(contact,
                            test::make_part(ShapeKind::kBox, glm::dvec3(kBlockHalf), {}, mesh),
                            test::make_part(ShapeKind::kSphere, glm::dvec3(kGoingRadius))));
      const Round alone = go_round(pressed, {there.begin(), there.begin() + 101});
      for (const auto& way : {there, back}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(contact) << (mesh ? ", mesh" : "")
                                        << (way == there ? ", there" : ", back"));
        Hand hand(scene_of(contact,
                           test::make_part(ShapeKind::kBox, glm::dvec3(kBlockHalf), {}, mesh),
                           test::make_part(ShapeKind::kSphere, glm::dvec3(kGoingRadius))));
        const Round round = go_round(hand, way);
        // Beside the edge there is less of the body than on its top.
        EXPECT_LT(round.largest, 1.1 * alone.largest);
        // A cell of the 16 across that comes or goes as a whole is 6 % of the area.
        EXPECT_LT(round.largest_step, 0.06 * alone.largest);
        // The depth is small beside the radius: the ball's own normal at the edge. The side's
        // height is four cells, of which half a one is 6 degrees.
        EXPECT_LT(round.askew, 12.0);
        // Its size is that of each model, and not of one potential's gradient; of that the work of
        // pressing is the measure.
        EXPECT_GT(round.work, -0.5 * alone.most_work);
        EXPECT_LT(round.work, 2.0 * alone.most_work);
      }
    }
  }
}

// ---- Any tool on any edge

/// A piece of a body's surface: its middle, and its area times its normal, m^2.
struct Piece {
  glm::dvec3 middle;
  glm::dvec3 area;
};

/// A box's faces at +x, +y and +z, near `about`.
std::vector<Piece> box_pieces(const glm::dvec3& about) {
  constexpr double kReach = 0.012;  // m
  constexpr int kSide = 300;
  std::vector<Piece> pieces;
  const double length = 2.0 * kReach / kSide;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 normal(0.0);
    normal[axis] = 1.0;
    for (int i = 0; i < kSide * kSide; ++i) {
      glm::dvec3 middle(0.0);
      middle[axis] = kBlockHalf;
      const int first = (axis + 1) % 3;
      const int second = (axis + 2) % 3;
      middle[first] = about[first] - kReach + (i % kSide + 0.5) * length;
      middle[second] = about[second] - kReach + (i / kSide + 0.5) * length;
      if (middle[first] < kBlockHalf && middle[second] < kBlockHalf) {
        pieces.push_back({middle, length * length * normal});
      }
    }
  }
  return pieces;
}

/// A cylinder's top and its side, near +x.
std::vector<Piece> cylinder_pieces(const glm::dvec3& about) {
  constexpr double kReach = 0.012;  // m
  constexpr int kSide = 300;
  std::vector<Piece> pieces;
  const double length = 2.0 * kReach / kSide;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double angle = (-kReach + (i % kSide + 0.5) * length) / kBlockHalf;
    const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
    const double across = -kReach + (i / kSide + 0.5) * length;
    const double radius = about.x + across;
    if (radius < kBlockHalf) {
      const double wide = length * radius / kBlockHalf;
      pieces.push_back(
          {radius * out + glm::dvec3(0.0, kBlockHalf, 0.0), {0.0, wide * length, 0.0}});
    }
    if (about.y + across < kBlockHalf) {
      pieces.push_back(
          {kBlockHalf * out + glm::dvec3(0.0, about.y + across, 0.0), length * length * out});
    }
  }
  return pieces;
}

/// The body's faces inside the tool: the gradient of the volume of what both have in common.
glm::dvec3 faces_inside(const Hand& hand, const std::vector<Piece>& pieces, const Pose& tool) {
  const Model& model = hand.world().model;
  const Range parts = model.tools.at<OwnedRows>(0).parts;
  glm::dvec3 sum(0.0);
  for (const Piece& piece : pieces) {
    if (signed_distance(model, parts, to_inner(tool, piece.middle)).value < 0.0) {
      sum += piece.area;
    }
  }
  return sum;
}

class Dice {
 public:
  double between(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0.0, 1.0)(engine_);
  }
  glm::dvec3 direction() {
    return glm::normalize(glm::dvec3(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0)));
  }

 private:
  std::mt19937_64 engine_{20260611};
};

PartDescription random_tool(Dice& dice, int kind, bool mesh) {
  const double radius = dice.between(0.006, 0.015);
  switch (kind % 5) {
    case 0:
      return test::make_part(ShapeKind::kSphere, glm::dvec3(radius), {}, mesh);
    case 1:
      return test::make_part(ShapeKind::kCapsule, {0.5 * radius, radius, 0.5 * radius}, {}, mesh);
    case 2:
      return test::make_part(ShapeKind::kEllipsoid, {radius, 0.6 * radius, 0.8 * radius}, {}, mesh);
    case 3:
      return test::make_part(ShapeKind::kBox, {radius, 0.6 * radius, 0.8 * radius}, {}, mesh);
    default:
      return test::make_part(ShapeKind::kCylinder, {0.8 * radius, 0.7 * radius, 0.8 * radius}, {},
                             mesh);
  }
}

/// How far from the edge the tool just touches, m. By bisection.
double touching(const Hand& hand, const std::vector<Piece>& pieces, const glm::dvec3& edge,
                const glm::dvec3& out, const glm::dquat& rotation) {
  double inside = 0.0;
  double outside = 0.04;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (inside + outside);
    const bool touches =
        faces_inside(hand, pieces, {edge + middle * out, rotation}) != glm::dvec3(0.0);
    (touches ? inside : outside) = middle;
  }
  return outside;
}

struct Found {
  double force = 0.0;  // N
  double faces = 0.0;  // m^2: of the sum of the body's faces in the tool
  double askew = 0.0;  // degrees: of the force, from that sum
  double moves = 0.0;  // degrees: at most, while all is held still
};

/// Presses a tool that lies in any way against a place on an edge, or a corner, and holds it.
Found press_on_edge(Dice& dice, int trial) {
  const bool round_body = trial % 3 == 2;
  const bool corner = !round_body && trial % 3 == 1;
  const glm::dvec3 edge(kBlockHalf, kBlockHalf, corner ? kBlockHalf : round_body ? 0.0 : 0.004);
  const double angle = dice.between(0.05, 1.52);
  const glm::dvec3 out =
      corner ? glm::normalize(glm::dvec3(dice.between(0.1, 1.0), dice.between(0.1, 1.0),
                                         dice.between(0.1, 1.0)))
             : glm::dvec3(std::sin(angle), std::cos(angle), 0.0);
  const glm::dquat rotation = glm::angleAxis(dice.between(0.0, 3.0), dice.direction());
  const double depth = dice.between(3e-4, 8e-4);
  const auto kind = round_body ? ShapeKind::kCylinder : ShapeKind::kBox;
  Hand hand(scene_of(kEdgeContacts[trial % 4],
                     test::make_part(kind, glm::dvec3(kBlockHalf), {}, trial / 4 % 2 == 1, 40),
                     random_tool(dice, trial / 8, trial / 16 % 2 == 1)));
  const std::vector<Piece> pieces = round_body ? cylinder_pieces(edge) : box_pieces(edge);
  const double clear = touching(hand, pieces, edge, out, rotation) + 1e-4;
  hand.step_to({{edge + clear * out, rotation}});
  hand.move(-(depth + 1e-4) * out, test::kUp, 0.0, 100);
  hand.move(glm::dvec3(0.0), test::kUp, 0.0, 80);
  Found found;
  const glm::dvec3 force = hand.wrench().force;
  const glm::dvec3 faces = faces_inside(hand, pieces, hand.poses[0]);
  found.force = glm::length(force);
  found.faces = glm::length(faces);
  found.askew = degrees_between(force, faces);
  for (int step = 0; step < 10; ++step) {
    hand.move(glm::dvec3(0.0), test::kUp, 0.0, 1);
    found.moves = std::max(found.moves, degrees_between(force, hand.wrench().force));
  }
  return found;
}

TEST(AroundEdgesTest, OnEdgesAndCornersTheForceIsAlongTheGradientOfTheOverlap) {
  const int trials = test::trials_of(96, 4);
  Dice dice;
  std::vector<double> askew;
  for (int trial = 0; trial < trials; ++trial) {
    const Found found = press_on_edge(dice, trial);
    EXPECT_GT(found.force, 0.0) << trial;  // without either there is no angle between them
    EXPECT_GT(found.faces, 0.0) << trial;
    // An overlap on an edge is some 8 cells wide, and its side some 4 high: half a cell more of a
    // face is 4 to 7 degrees, on a corner in two directions.
    EXPECT_LT(found.askew, 12.0) << trial;
    EXPECT_LT(found.moves, 1.5) << trial;
    askew.push_back(found.askew);
  }
  std::ranges::nth_element(askew, askew.begin() + trials / 2);
  EXPECT_LT(askew[askew.size() / 2], 3.0);
}

}  // namespace
}  // namespace torsion::engine
