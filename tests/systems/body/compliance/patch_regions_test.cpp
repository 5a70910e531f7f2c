// Several regions of contact model patch on one body: which comes first does not matter, and where
// they do not know of each other each is as if it were alone.

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"
#include "tests/support/studies.hpp"
#include "tests/systems/body/compliance/soft_bodies.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kSmallBallRadius;
using test::kUp;
using test::kUpright;

constexpr double kBlockDepth = 8e-4;   // m
constexpr double kBlockHeight = 0.06;  // m: the body's

/// A block on its fixed lower face, wider than high.
SceneDescription block(const glm::dvec2& half, BodyModel body_model, double poisson) {
  SceneDescription scene;
  const glm::dvec3 sides(half.x, 0.5 * kBlockHeight, half.y);
  BodyDescription body = test::make_body(
      {test::make_part(ShapeKind::kBox, sides, {glm::dvec3(0.0, sides.y, 0.0), kUpright})});
  body.fixed.kind = FixedKind::kFace;
  body.fixed.point = glm::dvec3(0.0);
  body.fixed.normal = kUp;
  body.elasticity = {3e5, poisson};
  body.friction = {0.8, 0.8};
  body.models.contact = ContactModel::kPatch;
  body.models.body = body_model;
  scene.bodies.push_back(std::move(body));
  return scene;
}

PartDescription ball_at(double x, double z) {
  return test::make_part(ShapeKind::kSphere, glm::dvec3(kSmallBallRadius),
                         {glm::dvec3(x, 0.0, z), kUpright});
}

/// Where the hands are at step k: pressing, then slides and turns of partial slip, then rest.
Pose pose_at(int k) {
  const double pressed = std::min(1.0, k / 100.0);
  const double moved = std::clamp((k - 100) / 100.0, 0.0, 1.0);
  const double turned = std::clamp((k - 200) / 100.0, 0.0, 1.0);
  return {
      {2e-4 * moved, kBlockHeight + kSmallBallRadius + 1e-6 - kBlockDepth * pressed, -1e-4 * moved},
      glm::angleAxis(0.01 * turned, kUp)};
}
constexpr int kMoving = 300;
constexpr int kRest = 60;

/// Larger difference of force and torque, N; a torque over the distance of a foot from the middle.
double apart(const Wrench& one, const Wrench& other, double lever) {
  return std::max(glm::distance(one.force, other.force),
                  glm::distance(one.torque, other.torque) / lever);
}

struct GroundCase {
  const char* name;
  BodyModel body;
  double poisson;
};

void PrintTo(const GroundCase& ground, std::ostream* out) {
  *out << ground.name;
}

class PatchRegionsTest : public testing::TestWithParam<GroundCase> {};

/// Of one tool, whose largest change in a step bounds what a step's iterations leave over.
struct Swapped {
  double worst = 0.0;  // N: difference of the two orders
  double step = 0.0;   // N: most that a step changes a wrench by
};

/// @param poses  of the tools at step k
template <class Poses>
Swapped compare(Hand& one, Hand& other, const std::vector<std::uint32_t>& rows,
                const Poses& poses) {
  constexpr double kLever = 0.022;  // m
  Swapped result;
  for (int k = 0; k <= kMoving + kRest; ++k) {
    const std::vector<Pose> here = poses(std::min(k, kMoving));
    std::vector<Pose> there(here.size());
    std::vector<Wrench> before;
    for (std::uint32_t tool = 0; tool < rows.size(); ++tool) {
      there[rows[tool]] = here[tool];
      before.push_back(one.wrench(tool));
    }
    one.step_to(here);
    other.step_to(there);
    for (std::uint32_t tool = 0; tool < rows.size(); ++tool) {
      result.worst =
          std::max(result.worst, apart(one.wrench(tool), other.wrench(rows[tool]), kLever));
      result.step = std::max(result.step, apart(one.wrench(tool), before[tool], kLever));
    }
  }
  EXPECT_EQ(one.world().state.regions.size(), 2U);
  EXPECT_EQ(one.clock().faults_ever | other.clock().faults_ever, 0U);
  return result;
}

// Sweeps end when they change less than 1 % of what the step did (with compliance; 3 % without),
// in either order.
constexpr double kLeftOver = 2.0 * 0.01;

TEST_P(PatchRegionsTest, TheOrderOfPartsDoesNotMatter) {
  if (test::is_left_out(GetParam().poisson == 0.3)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  SceneDescription scene = block({0.06, 0.05}, GetParam().body, GetParam().poisson);
  scene.tools.push_back(test::make_tool({ball_at(-0.021, 0.004), ball_at(0.024, 0.0)}));
  Hand one(scene);
  std::swap(scene.tools[0].parts[0], scene.tools[0].parts[1]);
  Hand other(scene);
  const Swapped found =
      compare(one, other, {0}, [](int k) { return std::vector<Pose>{pose_at(k)}; });
  EXPECT_LE(found.worst, kLeftOver * found.step);
}

TEST_P(PatchRegionsTest, TheOrderOfToolsDoesNotMatter) {
  SceneDescription scene = block({0.06, 0.05}, GetParam().body, GetParam().poisson);
  scene.tools.push_back(test::make_tool({ball_at(-0.021, 0.004)}));
  scene.tools.push_back(test::make_tool({ball_at(0.024, 0.0)}));
  Hand one(scene);
  std::swap(scene.tools[0], scene.tools[1]);
  Hand other(scene);
  // They touch in the same step, so that nothing but their order comes first. The second one pauses
  // in every fifth step of its slide: cells at their limit stick then or slip, as rounding has it,
  // and the iterations of the step after that leave up to 5 % (7 depths of the first touch).
  constexpr double kLeftOfPauses = 2.5 * kLeftOver;
  const Swapped found = compare(one, other, {1, 0}, [](int k) {
    return std::vector<Pose>{pose_at(k), pose_at(k <= 100 ? k : 100 + (k - 100) * 4 / 5)};
  });
  EXPECT_LE(found.worst, kLeftOfPauses * found.step);
}

// Four heights of the body between them, on a fixed face: nothing of one is left at the other. That
// a region begins beside another leaves it fewer iterations in that step, after which its grid may
// take another size: two grids of 16 cells, half a per cent off each at worst, in the force and in
// mu of it.
TEST_P(PatchRegionsTest, TwoFarFeetCarryWhatTwoSingleFeetDo) {
  if (test::is_left_out(GetParam().poisson == 0.5)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  constexpr double kFoot = 0.12;  // m from the middle
  std::vector<Hand> hands;
  for (const std::vector<double>& feet : {std::vector<double>{-kFoot, kFoot}, {-kFoot}, {kFoot}}) {
    SceneDescription scene = block({0.2, 0.06}, GetParam().body, GetParam().poisson);
    std::vector<PartDescription> parts;
    for (const double x : feet) {
      parts.push_back(ball_at(x, 0.0));
    }
    scene.tools.push_back(test::make_tool(parts));
    hands.emplace_back(scene);
  }
  double worst = 0.0;
  for (int k = 0; k <= kMoving + kRest; ++k) {
    for (Hand& hand : hands) {
      hand.step_to({pose_at(std::min(k, kMoving))});
    }
    const Wrench singles{hands[1].wrench().force + hands[2].wrench().force,
                         hands[1].wrench().torque + hands[2].wrench().torque};
    worst = std::max(worst, apart(hands[0].wrench(), singles, kFoot));
  }
  EXPECT_LE(worst, 0.005 * hands[0].wrench().force.y);
  EXPECT_EQ(hands[0].world().state.regions.size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(Grounds, PatchRegionsTest,
                         testing::Values(GroundCase{"HalfSpaceRubber", BodyModel::kNone, 0.5},
                                         GroundCase{"HalfSpaceCompressible", BodyModel::kNone, 0.3},
                                         GroundCase{"Rubber", BodyModel::kCompliance, 0.5},
                                         GroundCase{"Compressible", BodyModel::kCompliance, 0.3}),
                         [](const auto& at) { return std::string(at.param.name); });

}  // namespace
}  // namespace torsion::engine
