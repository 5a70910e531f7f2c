// A tool that does not touch a soft body until another one pushes the body against it.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/pinched_column.hpp"

namespace torsion::engine {
namespace {

constexpr double kWidth = 0.03;  // m

SceneDescription column(ContactModel contact) {
  return test::pinched_column(kWidth, contact, 0.0);
}

/// @param gap  m: from the column at rest to the right ball
std::vector<Pose> poses_at(double push, double gap) {
  return test::pinch_poses(kWidth, push, -gap);
}

struct Forces {
  double left = 0.0;   // N, along -x
  double right = 0.0;  // N, along x
};

Forces forces_of(const test::Hand& hand) {
  return {-hand.wrench(0).force.x, hand.wrench(1).force.x};
}

constexpr double kPush = 5e-3;  // m
constexpr double kGap = 2e-3;   // m
constexpr int kSteps = 300;

class WaitingToolTest : public testing::TestWithParam<ContactModel> {};

// What the column's side has gone by when the force begins is what the left ball has gone by, less
// its depth. The column bends as it goes, by 1.5 times its way over the height, so that the balls
// touch it up to 2 mm from each other in height, where it has gone by up to 4 % more or less.
TEST_P(WaitingToolTest, FeelsTheBodyWhenAnotherToolHasPushedItThere) {
  test::Hand alone(column(GetParam()));
  test::Hand both(column(GetParam()));
  double begins = 0.0;  // m, of the push
  double before = 0.0;
  double largest_change = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double push = kPush * i / kSteps;
    alone.step_to(poses_at(push, 1.0));
    both.step_to(poses_at(push, kGap));
    const Forces felt = forces_of(both);
    if (felt.right == 0.0) {
      EXPECT_EQ(felt.left, forces_of(alone).left) << "step " << i;
    } else if (begins == 0.0) {
      const double sunk = alone.world().state.regions.at<Overlap>(0).largest_depth;
      EXPECT_NEAR(push - sunk, kGap, 0.05 * kGap) << "step " << i;
      begins = push;
    }
    EXPECT_GE(felt.right, 0.0) << "step " << i;
    largest_change = std::max(largest_change, std::abs(felt.right - before));
    before = felt.right;
  }
  ASSERT_GT(begins, 0.0);
  // The force goes with the depth to the power of 1.5, so its steepest is half as much again as its
  // mean; a support that is fitted anew changes it by some percent.
  const double mean_change = before * kPush / (kPush - begins) / kSteps;
  EXPECT_LT(largest_change, 1.5 * mean_change + 0.04 * before);
  EXPECT_EQ(both.clock().faults_ever, 0U);
}

// Without friction all ways end in the same state. The other way: the right ball first comes so far
// that it is inside of the column at rest, where it was always found, and goes back while the
// column follows it.
TEST_P(WaitingToolTest, EndsAsIfItHadBeenThereBefore) {
  test::Hand waits(column(GetParam()));
  test::Hand comes(column(GetParam()));
  test::Hand follows(column(GetParam()));
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    waits.step_to(poses_at(kPush * share, kGap));
    comes.step_to(poses_at(kPush * share, 3.0 * kGap));
    follows.step_to(poses_at(0.1 * kPush * share, -0.1 * kPush * share));
  }
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    waits.step_to(poses_at(kPush, kGap));
    comes.step_to(poses_at(kPush, kGap * (3.0 - 2.0 * share)));
    follows.step_to(
        poses_at(kPush * (0.1 + 0.9 * share), -0.1 * kPush + (0.1 * kPush + kGap) * share));
  }
  for (int i = 0; i < 100; ++i) {
    for (test::Hand* const hand : {&waits, &comes, &follows}) {
      hand->step_to(poses_at(kPush, kGap));
    }
  }
  // What is left between them: supports that were fitted for other places of the same contact.
  const Forces expected = forces_of(follows);
  EXPECT_GT(expected.right, 5.0);
  for (const test::Hand* const hand : {&waits, &comes}) {
    EXPECT_NEAR(forces_of(*hand).left, expected.left, 0.02 * expected.left);
    EXPECT_NEAR(forces_of(*hand).right, expected.right, 0.02 * expected.right);
    EXPECT_EQ(hand->clock().faults_ever, 0U);
  }
}

// Where the column was at rest there is nothing any more.
TEST_P(WaitingToolTest, FeelsNothingWhereTheBodyHasBeenPushedAway) {
  constexpr double kPushedAt = 0.06;  // m, height
  constexpr double kFeltAt = 0.095;   // m
  test::Hand alone(column(GetParam()));
  test::Hand both(column(GetParam()));
  const auto at = [](double inside, double height) {
    Pose pose = test::pinch_poses(kWidth, inside, 0.0)[0];
    pose.position.y = height;
    return pose;
  };
  for (int i = 0; i <= kSteps; ++i) {
    const double push = std::min(1.0, 2.0 * i / kSteps) * kPush;
    const double other = std::max(0.0, 2.0 * i / kSteps - 1.0) * 2e-3 - 1e-3;  // to 1 mm inside
    alone.step_to({at(push, kPushedAt), at(-1.0, kFeltAt)});
    both.step_to({at(push, kPushedAt), at(other, kFeltAt)});
    ASSERT_EQ(both.wrench(1).force.x, 0.0) << "step " << i;
    ASSERT_EQ(both.wrench(0).force.x, alone.wrench(0).force.x) << "step " << i;
  }
}

TEST_P(WaitingToolTest, AStepTakesNothingFromTheHeap) {
  test::Hand hand(column(GetParam()));
  std::uint64_t taken = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const std::vector<Pose> poses = poses_at(kPush * i / kSteps, kGap);
    const test::AllocationGuard guard;
    hand.step_to(poses);
    taken += guard.allocations();
  }
  EXPECT_GT(forces_of(hand).right, 0.0);
  EXPECT_EQ(taken, 0U);
}

INSTANTIATE_TEST_SUITE_P(Models, WaitingToolTest,
                         testing::Values(ContactModel::kPaper, ContactModel::kWinkler,
                                         ContactModel::kMdr, ContactModel::kPatch));

}  // namespace
}  // namespace torsion::engine
