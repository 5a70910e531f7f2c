// A tool that is held still is felt the same in every step: what cells find of it may not depend on
// where the last step left them.

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion {
namespace {

using test::Hand;
using test::kUp;
using test::kUpright;

constexpr double kDepth = 5e-4;  // m

/// A tool with steep sides and sharp rims over a block whose top is y = 0.
SceneDescription plate_on_block(ContactModel contact, bool as_mesh) {
  SceneDescription scene;
  scene.bodies.push_back(test::make_body({test::make_part(
      ShapeKind::kBox, {0.05, 0.05, 0.05}, {glm::dvec3(0.0, -0.05, 0.0), kUpright})}));
  scene.bodies[0].elasticity = {2e5, 0.4, 1000.0};
  scene.bodies[0].models = {contact, BodyModel::kNone};
  scene.bodies[0].models.region_threshold = 0.01;
  scene.tools.push_back(
      test::make_tool({test::make_part(ShapeKind::kBox, {0.02, 0.004, 0.013}, {}, as_mesh)}));
  return scene;
}

/// The lowest point of the tool over its frame's origin, m, of a box of these half extents.
double lowest_of(const glm::dquat& rotation) {
  const glm::dvec3 down = glm::conjugate(rotation) * kUp;
  return 0.02 * std::abs(down.x) + 0.004 * std::abs(down.y) + 0.013 * std::abs(down.z);
}

/// Largest change of the force over steps in which the tool is held, over the force.
double unrest(ContactModel contact, bool as_mesh, const glm::dquat& rotation, double aside) {
  constexpr int kSettle = 200;  // steps: the fade of its beginning is over in 10
  constexpr int kSteps = 50;
  const double touching = lowest_of(rotation);
  Hand hand(plate_on_block(contact, as_mesh));
  hand.step_to({{glm::dvec3(aside, touching + 1e-4, 0.0), rotation}});
  hand.move({0.0, -kDepth - 1e-4, 0.0}, kUp, 0.0, 60);
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
        EXPECT_LE(unrest(GetParam().contact, GetParam().as_mesh, rotation, aside),
                  GetParam().unrest);
      }
    }
  }
}

// Exact shapes: the same bits but for rounding; in a distance field a cell comes to rest to 1e-6 of
// its length, which is up to ten times the mean depth here. patch ends its iterations where a
// change is small.
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
}  // namespace torsion
