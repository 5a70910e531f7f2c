#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/body/skeleton/skeleton.hpp"
#include "systems/model/prepare.hpp"
#include "systems/surface/take_snapshot.hpp"
#include "tests/systems/body_scene.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

/// Of all anchors of the world.
std::vector<AnchorMotion> skeleton_of(const World& world) {
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  capture(world.model, world.state, snapshot);
  skeleton_motions(world.model, world.state, snapshot);
  const auto motion = snapshot.anchors.column<AnchorMotion>();
  return {motion.begin(), motion.end()};
}

/// A bar 0.03 x 0.2 x 0.05 m of rubber, its lower end clamped.
struct Bar {
  static constexpr double kLength = 0.2;
  static constexpr double kWidthX = 0.03;
  static constexpr double kWidthZ = 0.05;
  BodyDescription description =
      exact_body(ShapeKind::kBox, {kWidthX / 2, kLength / 2, kWidthZ / 2}, FixedKind::kFace);
  World world = body_world(description);
  double youngs = description.elasticity.youngs_modulus;
  double shear = description.elasticity.shear_modulus();
  double area = kWidthX * kWidthZ;
  glm::dvec3 tip{0.0, kLength / 2, 0.0};
};

TEST(SkeletonMotionsTest, TransverseTipForceGivesTimoshenkosDeflectionAlongTheBar) {
  Bar bar;
  const double force = 0.3;
  add_region(bar.world, {.point = bar.tip, .force_on_body = {force, 0.0, 0.0}});
  const double moment = bar.kWidthZ * std::pow(bar.kWidthX, 3) / 12.0;  // bends about z
  const double tip_deflection = force * std::pow(bar.kLength, 3) / (3.0 * bar.youngs * moment);
  const auto rest = bar.world.model.anchors.column<AnchorRest>();
  const auto motion = skeleton_of(bar.world);
  ASSERT_GE(rest.size(), 20U);
  for (std::size_t j = 0; j < rest.size(); ++j) {
    const double s = rest[j].position.y + bar.kLength / 2;
    const double deflection =
        force * s * s * (3.0 * bar.kLength - s) / (6.0 * bar.youngs * moment) +
        force * s / (5.0 / 6.0 * bar.shear * bar.area);
    const double turn = force * s * (bar.kLength - 0.5 * s) / (bar.youngs * moment);  // towards +x
    // The polygonal section and the interpolation between beams are good to 1e-3; the rest is the
    // bar's own theory.
    EXPECT_NEAR(motion[j].displacement.x, deflection, 1e-2 * tip_deflection) << "s = " << s;
    EXPECT_NEAR(motion[j].displacement.y, -turn * rest[j].position.x, 1e-2 * tip_deflection);
    EXPECT_NEAR(motion[j].displacement.z, 0.0, 1e-9);
  }
}

TEST(SkeletonMotionsTest, AxialTipForceStretchesAndThinsTheBar) {
  Bar bar;
  const double force = 5.0;
  add_region(bar.world, {.point = bar.tip, .force_on_body = {0.0, -force, 0.0}});
  const double strain = -force / (bar.youngs * bar.area);
  const auto rest = bar.world.model.anchors.column<AnchorRest>();
  const auto motion = skeleton_of(bar.world);
  for (std::size_t j = 0; j < rest.size(); ++j) {
    const double s = rest[j].position.y + bar.kLength / 2;
    EXPECT_NEAR(motion[j].displacement.y, strain * s, 1e-2 * std::abs(strain) * bar.kLength);
    if (s > 0.03) {  // clear of the clamp's end effect, one section radius (0.022 m) long
      EXPECT_NEAR(motion[j].displacement.x, -0.5 * strain * rest[j].position.x,
                  1e-2 * std::abs(strain) * bar.kWidthX);
    }
  }
}

TEST(SkeletonMotionsTest, TipCoupleAcrossTheBarBendsItToACircularArc) {
  Bar bar;
  // A region on the side face at the top: its couple about the x axis bends the bar about x.
  const double couple = 0.02;
  add_region(bar.world, {.point = {bar.kWidthX / 2, 0.0999, 0.0},
                         .normal = {1.0, 0.0, 0.0},
                         .couple_on_body = couple});
  const double moment = bar.kWidthX * std::pow(bar.kWidthZ, 3) / 12.0;  // bends about x
  const auto rest = bar.world.model.anchors.column<AnchorRest>();
  const auto motion = skeleton_of(bar.world);
  const double tip_deflection = couple * bar.kLength * bar.kLength / (2.0 * bar.youngs * moment);
  for (std::size_t j = 0; j < rest.size(); ++j) {
    const double s = rest[j].position.y + bar.kLength / 2;
    // The beam leans by atan(0.015 / 0.2) = 4.3 degrees, so sections are up to 0.3 % larger and the
    // sections near the tip are cut by the end face.
    EXPECT_NEAR(motion[j].displacement.z, couple * s * s / (2.0 * bar.youngs * moment),
                0.04 * tip_deflection);
  }
}

TEST(SkeletonMotionsTest, SeveralRegionsAdd) {
  const RegionOnBody first{.point = {0.0, 0.1, 0.0}, .force_on_body = {0.2, -1.0, 0.1}};
  const RegionOnBody second{
      .point = {0.015, 0.02, 0.0}, .normal = {1.0, 0.0, 0.0}, .force_on_body = {-2.0, 0.3, 0.0}};
  Bar alone_first;
  add_region(alone_first.world, first);
  Bar alone_second;
  add_region(alone_second.world, second);
  Bar both;
  add_region(both.world, first);
  add_region(both.world, second);
  const auto by_first = skeleton_of(alone_first.world);
  const auto by_second = skeleton_of(alone_second.world);
  const auto by_both = skeleton_of(both.world);
  for (std::uint32_t j = 0; j < both.world.model.anchors.size(); ++j) {
    const glm::dvec3 sum = by_first[j].displacement + by_second[j].displacement;
    EXPECT_NEAR(glm::length(by_both[j].displacement - sum), 0.0, 1e-15);
  }
}

TEST(SkeletonMotionsTest, ABodyThatNothingTouchesAnyMoreIsAtRest) {
  Bar bar;
  Snapshot snapshot;
  snapshot.reserve(bar.world.model, bar.world.state);
  const auto farthest = [&] {
    capture(bar.world.model, bar.world.state, snapshot);
    skeleton_motions(bar.world.model, bar.world.state, snapshot);
    double most = 0.0;
    for (const AnchorMotion& motion : snapshot.anchors.column<AnchorMotion>()) {
      most = std::max(most, glm::length(motion.displacement));
    }
    return most;
  };
  add_region(bar.world, {.point = bar.tip, .force_on_body = {1.0, -1.0, 0.0}});
  EXPECT_GT(farthest(), 1e-6);
  bar.world.state.regions.clear();
  EXPECT_EQ(farthest(), 0.0);
}

TEST(SkeletonMotionsTest, OtherBodyModelsLeaveTheAnchorsAtRest) {
  Bar bar;
  bar.world.model.bodies.at<BodyModels>(0).body = BodyModel::kNone;
  add_region(bar.world, {.point = bar.tip, .force_on_body = {1.0, -1.0, 0.0}});
  for (const AnchorMotion& motion : skeleton_of(bar.world)) {
    EXPECT_EQ(motion.displacement, glm::dvec3(0.0));
  }
}

TEST(SkeletonMotionsTest, FixedFaceStaysUnderAnObliqueBeam) {
  Bar bar;
  add_region(bar.world, {.point = {0.015, -0.05, 0.01},
                         .normal = {1.0, 0.0, 0.0},
                         .force_on_body = {-3.0, 1.0, 2.0}});
  // An anchor put on the fixed face moves with the root.
  bar.world.model.anchors.at<AnchorRest>(7).position = glm::dvec3(0.012, -0.1, -0.02);
  EXPECT_NEAR(glm::length(skeleton_of(bar.world)[7].displacement), 0.0, 1e-15);
}

TEST(SkeletonMotionsTest, FixedPointStays) {
  const glm::dvec3 half(0.06, 0.04, 0.05);
  World world = body_world(exact_body(ShapeKind::kEllipsoid, half, FixedKind::kPoint));
  world.model.anchors.at<AnchorRest>(7).position = glm::dvec3(0.0, -half.y, 0.0);
  add_region(world, {.point = {0.0, half.y, 0.0}, .force_on_body = {1.0, -5.0, 0.5}});
  EXPECT_NEAR(glm::length(skeleton_of(world)[7].displacement), 0.0, 1e-15);
}

TEST(SkeletonMotionsTest, AnchorsMoveContinuouslyWhileTheContactSlides) {
  const glm::dvec3 half(0.06, 0.04, 0.05);
  World world = body_world(exact_body(ShapeKind::kEllipsoid, half, FixedKind::kPoint));
  std::vector<glm::dvec3> before;
  double largest = 0.0;
  double largest_jump = 0.0;
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 1.0 * i / kSteps;
    const glm::dvec3 point = half * glm::dvec3(std::sin(angle), std::cos(angle), 0.0);
    const glm::dvec3 normal = glm::normalize(point / (half * half));
    world.state.regions.clear();
    add_region(world, {.point = point, .normal = normal, .force_on_body = -2.0 * normal});
    const auto motion = skeleton_of(world);
    for (std::size_t j = 0; j < before.size(); ++j) {
      largest_jump = std::max(largest_jump, glm::length(motion[j].displacement - before[j]));
    }
    before.clear();
    for (const AnchorMotion& anchor : motion) {
      largest = std::max(largest, glm::length(anchor.displacement));
      before.push_back(anchor.displacement);
    }
  }
  // A smooth change over one radian takes about `largest`, in 2000 steps 1/2000 each; a factor of
  // 20 for its steepest place. A jump would be a sizeable share of `largest`.
  EXPECT_LT(largest_jump, 20.0 * largest / kSteps);
  RecordProperty("largest_m", std::to_string(largest));
}

}  // namespace
}  // namespace torsion::engine
