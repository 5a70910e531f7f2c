// A soft body answers a contact from the step in which that begins.

#include <gtest/gtest.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/support/pinched_column.hpp"

namespace torsion::engine {
namespace {

constexpr double kLandedWidth = 0.03;  // m
constexpr double kFarAway = -1.0;      // m, of the other ball

class FirstContactTest : public testing::TestWithParam<ContactModel> {};

// A column pressed from the side sways by up to ten times what its contact sinks in. A force that
// is found as if it stood still, Hertz' four to thirteen times as large at these depths, throws it
// off; another tool that is near on its other side is hit by that, and throws it back harder.
// mdr takes nine tenths of the body's answer in the first step (contact_load.cpp), so its force is
// at most a ninth too large; some percent more where the support was fitted for the overlap's size.
TEST_P(FirstContactTest, HasTheForceOfAContactThatHasLasted) {
  test::Hand hand(test::pinched_column(kLandedWidth, GetParam(), 0.5));
  const auto stand = [&hand](double depth, int steps) {
    for (int i = 0; i < steps; ++i) {
      hand.step_to(test::pinch_poses(kLandedWidth, depth, kFarAway));
    }
  };
  // On the tool it is faded in.
  const auto found = [&hand] {
    return hand.world().state.regions.at<RegionNormal>(0).force;
  };
  for (const double depth : {2e-5, 1e-4, 5e-4}) {  // m, in the column at rest
    SCOPED_TRACE(depth);
    stand(-1e-4, 20);
    ASSERT_EQ(hand.world().state.regions.size(), 0U);
    stand(depth, 1);
    ASSERT_EQ(hand.world().state.regions.size(), 1U);
    const double first = found();
    stand(depth, 200);
    EXPECT_NEAR(first, found(), 0.15 * found());
  }
  EXPECT_EQ(hand.clock().faults_ever, 0U);
}

INSTANTIATE_TEST_SUITE_P(Models, FirstContactTest,
                         testing::Values(ContactModel::kMdr, ContactModel::kPatch));

}  // namespace
}  // namespace torsion::engine
