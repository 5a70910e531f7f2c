// A tool that is held still is felt the same in every step: what cells find of it may not depend on
// where the last step left them.

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kUp;
using test::kUpright;

/// A box and where it is held.
struct BoxPose {
  glm::dvec3 half_extent;  // m
  glm::dquat rotation;
  glm::dvec2 place;  // m: x and z of its centre
  double depth;      // m
};

/// A tool with steep sides and sharp rims over a block whose top is y = 0.
SceneDescription box_on_block(ContactModel contact, const glm::dvec3& half_extent, bool as_mesh) {
  SceneDescription scene;
  scene.bodies.push_back(test::make_body({test::make_part(
      ShapeKind::kBox, {0.05, 0.05, 0.05}, {glm::dvec3(0.0, -0.05, 0.0), kUpright})}));
  scene.bodies[0].elasticity = {2e5, 0.4, 1000.0};
  scene.bodies[0].models = {contact, BodyModel::kNone};
  scene.bodies[0].models.region_threshold = 0.01;
  scene.tools.push_back(
      test::make_tool({test::make_part(ShapeKind::kBox, half_extent, {}, as_mesh)}));
  return scene;
}

/// How far the lowest point of the box is under its centre, m.
double reach_down(const BoxPose& box) {
  return glm::dot(glm::abs(glm::conjugate(box.rotation) * kUp), box.half_extent);
}

/// Largest change of the force over steps in which the tool is held, over the force.
double unrest(ContactModel contact, bool as_mesh, const BoxPose& box) {
  constexpr int kSettle = 200;  // steps: the fade of its beginning is over in 10
  constexpr int kSteps = 50;
  Hand hand(box_on_block(contact, box.half_extent, as_mesh));
  const glm::dvec3 start(box.place.x, reach_down(box) + 1e-4, box.place.y);
  hand.step_to({{start, box.rotation}});
  hand.move({0.0, -box.depth - 1e-4, 0.0}, kUp, 0.0, 60);
  for (int i = 0; i < kSettle; ++i) {
    hand.step_to(hand.poses);
  }
  double least = glm::length(hand.wrench().force);
  double most = least;
  for (int i = 0; i < kSteps; ++i) {
    hand.step_to(hand.poses);
    least = std::min(least, glm::length(hand.wrench().force));
    most = std::max(most, glm::length(hand.wrench().force));
  }
  EXPECT_GT(least, 0.0);
  EXPECT_EQ(hand.clock().faults_ever, 0U);
  return (most - least) / most;
}

struct Held {
  const char* name;
  ContactModel contact;
  bool as_mesh;
  double unrest;  // at most
};

class HeldStillTest : public testing::TestWithParam<Held> {};

// Tilted by a third of a degree and by nine, over the block's middle and with an end beyond its
// edge. A rim then runs through cells at any place in them.
TEST_P(HeldStillTest, APlateIsFeltTheSameInEveryStep) {
  for (const double tilt : {0.006, 0.04, 0.15}) {
    for (const double turn : {0.3, 0.9, 1.4}) {
      for (const double aside : {0.0, 0.043}) {
        SCOPED_TRACE(testing::Message()
                     << "tilt " << tilt << " turn " << turn << " aside " << aside);
        const glm::dquat rotation = glm::angleAxis(turn, kUp) *
                                    glm::angleAxis(tilt, glm::normalize(glm::dvec3(0.6, 0.0, 1.0)));
        for (const double depth : {4.2e-4, 5e-4, 5.15e-4}) {
          if (test::is_left_out(depth == 5e-4)) {
            continue;
          }
          const BoxPose plate{{0.02, 0.004, 0.013}, rotation, {aside, 0.0}, depth};
          EXPECT_LE(unrest(GetParam().contact, GetParam().as_mesh, plate), GetParam().unrest)
              << depth;
        }
      }
    }
  }
}

// Boxes that touch with a corner or an edge: a grid that finds itself outgrown at a sharp corner
// may not be made smaller again by what its larger cells show of that. Found among random poses.
TEST_P(HeldStillTest, ACornerIsFeltTheSameInEveryStep) {
  const BoxPose corners[] = {{{0.00974, 0.01863, 0.00834},
                              glm::dquat(0.978252, 0.026229, 0.202967, -0.033768),
                              {-0.00349, -0.00803},
                              5.3528e-4},
                             {{0.01382, 0.00891, 0.01791},
                              glm::dquat(-0.327331, 0.365391, 0.552144, -0.674152),
                              {0.04117, -0.00453},
                              5.1766e-4},
                             {{0.00906, 0.01097, 0.01853},
                              glm::dquat(0.638268, -0.042436, 0.76841, 0.018955),
                              {0.00271, 0.01314},
                              4.982e-4}};
  for (BoxPose box : corners) {
    box.rotation = glm::normalize(box.rotation);
    EXPECT_LE(unrest(GetParam().contact, GetParam().as_mesh, box), GetParam().unrest)
        << box.half_extent.x;
  }
}

// Exact shapes: the same bits but for rounding; in a distance field a cell comes to rest to 1e-6 of
// its length, which is up to ten times the mean depth here. patch's grid moves with what sticks to
// the tool, and shares of rim cells with the grid; of 324 plates (these at 18 depths) two alternate
// so, by 6e-5 of the force, and one of triangles, by 2.4e-5: less than a hundredth of what a hand
// can feel.
INSTANTIATE_TEST_SUITE_P(Models, HeldStillTest,
                         testing::Values(Held{"paper", ContactModel::kPaper, false, 1e-12},
                                         Held{"paper_mesh", ContactModel::kPaper, true, 1e-5},
                                         Held{"mdr", ContactModel::kMdr, false, 1e-12},
                                         Held{"mdr_mesh", ContactModel::kMdr, true, 1e-5},
                                         Held{"winkler", ContactModel::kWinkler, false, 1e-12},
                                         Held{"winkler_mesh", ContactModel::kWinkler, true, 1e-5},
                                         Held{"patch", ContactModel::kPatch, false, 1e-4},
                                         Held{"patch_mesh", ContactModel::kPatch, true, 1e-4}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace torsion::engine
