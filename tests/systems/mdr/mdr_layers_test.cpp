#include <cmath>
#include <numbers>
#include <span>

#include <gtest/gtest.h>

#include "tests/reference/exact/masing.hpp"
#include "tests/systems/body/compliance/fixed_springs.hpp"
#include "tests/systems/mdr/mdr_springs.hpp"

namespace torsion::engine {
namespace {

using test::MdrSprings;

// Of the largest load. 32 springs slip one after the other: the sum is a polygon along the exact
// curve, with its corners close where the curve bends most: a piece of a thirty-second of the load
// sags by (1 / 32)^2 / 2 = 5e-4. On the way back from full slip Masing's rule doubles every
// difference, and every turning point of a loop within a loop adds to it.
constexpr double kLoading = 6e-4;
constexpr double kUnloading = 1.2e-3;
constexpr double kLoopsInLoops = 4e-3;

/// Turning points that open loops, close them, pass them and cross zero, in natural units.
constexpr double kTurns[] = {0.3, 0.8, 0.2, 0.5,  0.35, 0.5, -0.3, -1.2, 0.0, -0.2,
                             0.4, -2., 2.0, 1.75, 2.4,  -3., 4.0,  3.9,  -4., 0.1};

/// Goes through kTurns in `unit`s and compares every step with Masing's rule for `loading`.
/// `move(change)` returns the resistance.
template <class Loading, class Move>
void follow_hysteresis(const Loading& loading, const Move& move, double unit, double tolerance) {
  reference::MasingHistory history;
  double at = 0.0;
  for (const double turn : kTurns) {
    const double from = at;
    for (int step = 1; step <= 20; ++step) {
      const double next = from + (turn * unit - from) * step / 20.0;
      const double found = move(next - at);
      at = next;
      EXPECT_NEAR(found, reference::move_to(history, loading, next), tolerance) << next / unit;
    }
  }
}

TEST(MdrLayersTest, FirstTwistAndFirstPushFollowTheExactCurves) {
  for (const double poisson : {0.0, 0.3, 0.4999, 0.5}) {
    MdrSprings twisted(poisson);
    MdrSprings pushed(poisson);
    const reference::LubkinContact lubkin = twisted.lubkin();
    const reference::CattaneoMindlin mindlin = pushed.mindlin();
    const double turn = 0.01 * twisted.natural_turn();
    const double slide = 0.01 * pushed.natural_slide();
    for (int step = 1; step <= 600; ++step) {
      twisted.move({}, turn);
      pushed.move({slide, 0.0}, 0.0);
      EXPECT_NEAR(-twisted.last.couple, reference::torque(lubkin, step * turn),
                  kLoading * twisted.limit_couple())
          << poisson << " " << step;
      EXPECT_NEAR(-pushed.last.force.x, reference::tangential_force(mindlin, step * slide),
                  kLoading * pushed.limit_force())
          << poisson << " " << step;
    }
  }
}

TEST(MdrLayersTest, UnloadingFromFullSlipFollowsMasingsRule) {
  MdrSprings twisted(0.5);
  MdrSprings pushed(0.5);
  const double turn = 6.0 * twisted.natural_turn();
  const double slide = 3.0 * pushed.natural_slide();
  twisted.move({}, turn);
  pushed.move({slide, 0.0}, 0.0);
  for (int step = 1; step <= 400; ++step) {
    const double share = 1.0 - 2.0 * step / 400.0;
    twisted.move({}, -turn / 200.0);
    pushed.move({-slide / 200.0, 0.0}, 0.0);
    EXPECT_NEAR(-twisted.last.couple,
                reference::torque_after_turn(twisted.lubkin(), turn, share * turn),
                kUnloading * twisted.limit_couple());
    const reference::CattaneoMindlin mindlin = pushed.mindlin();
    EXPECT_NEAR(-pushed.last.force.x,
                reference::full_slip_force(mindlin) -
                    2.0 * reference::tangential_force(mindlin, 0.5 * (1.0 - share) * slide),
                kUnloading * pushed.limit_force());
  }
}

TEST(MdrLayersTest, TwistAtConstantForceFollowsLubkinsHysteresis) {
  for (const double poisson : {0.0, 0.3, 0.4999, 0.5}) {
    MdrSprings springs(poisson);
    const reference::LubkinContact exact = springs.lubkin();
    follow_hysteresis([&](double twist) { return reference::torque(exact, twist); },
                      [&](double change) {
                        springs.move({}, change);
                        return -springs.last.couple;
                      },
                      springs.natural_turn(), kLoopsInLoops * springs.limit_couple());
  }
}

TEST(MdrLayersTest, TwistUnderAFlatPunchFollowsItsHysteresis) {
  MdrSprings springs(0.5);
  springs.contact.flat_share = 1.0;
  const reference::LubkinContact exact = springs.lubkin(reference::PressureShape::kFlatPunch);
  follow_hysteresis([&](double twist) { return reference::torque(exact, twist); },
                    [&](double change) {
                      springs.move({}, change);
                      return -springs.last.couple;
                    },
                    springs.natural_turn(), kLoopsInLoops * reference::saturated_torque(exact));
}

TEST(MdrLayersTest, SlideAtConstantForceFollowsCattaneoAndMindlin) {
  for (const double poisson : {0.0, 0.3, 0.5}) {
    for (const double angle : {0.0, 2.2}) {
      MdrSprings springs(poisson);
      const glm::dvec2 way(std::cos(angle), std::sin(angle));
      const reference::CattaneoMindlin exact = springs.mindlin();
      follow_hysteresis([&](double slide) { return reference::tangential_force(exact, slide); },
                        [&](double change) {
                          springs.move(change * way, 0.0);
                          EXPECT_NEAR(glm::dot(springs.last.force, glm::dvec2(-way.y, way.x)), 0.0,
                                      1e-12 * springs.limit_force());
                          return -glm::dot(springs.last.force, way);
                        },
                        springs.natural_slide(), kLoopsInLoops * springs.limit_force());
    }
  }
}

TEST(MdrLayersTest, FlatPunchSlidesAllAtOnce) {
  // Under a flat punch every tangential spring has the same limit, so the force is linear up to
  // full slip.
  MdrSprings springs(0.3);
  springs.contact.flat_share = 1.0;
  const double unit = springs.natural_slide();
  for (int step = 1; step <= 20; ++step) {
    springs.move({0.1 * unit, 0.0}, 0.0);
    EXPECT_NEAR(-springs.last.force.x / springs.limit_force(), std::min(0.1 * step, 1.0), 1e-9);
  }
}

struct Leg {
  double depth = 0.0;  // of test::kDepth
  double turn = 0.0;   // in natural turns at kDepth
  double slide = 0.0;  // in natural slides at kDepth
};

/// Worst errors over the limits at the largest depth.
struct Worst {
  double couple = 0.0;
  double force = 0.0;
};

Worst follow_legs(std::span<const Leg> legs, int steps) {
  MdrSprings springs(0.5, legs.front().depth * test::kDepth);
  const MdrSprings unit(0.5);
  double largest = 0.0;
  for (const Leg& leg : legs) {
    largest = std::max(largest, leg.depth);
  }
  const MdrSprings deepest(0.5, largest * test::kDepth);
  test::FixedSprings exact(deepest.contact.radius);
  Worst worst;
  Leg at = legs.front();
  for (const Leg& leg : legs) {
    const Leg from = at;
    for (int step = 1; step <= steps; ++step) {
      const double share = static_cast<double>(step) / steps;
      const Leg next{std::lerp(from.depth, leg.depth, share), std::lerp(from.turn, leg.turn, share),
                     std::lerp(from.slide, leg.slide, share)};
      const double turn = (next.turn - at.turn) * unit.natural_turn();
      const double slide = (next.slide - at.slide) * unit.natural_slide();
      if (next.depth != at.depth) {
        springs.press(next.depth * test::kDepth);
      }
      springs.move({slide, 0.0}, turn);
      exact.move(springs.lubkin(), springs.mindlin(), slide, turn);
      at = next;
      worst.couple = std::max(
          worst.couple, std::abs(springs.last.couple + exact.torque) / deepest.limit_couple());
      worst.force = std::max(worst.force,
                             std::abs(springs.last.force.x + exact.force) / deepest.limit_force());
    }
  }
  return worst;
}

void expect_within(const Worst& worst, double bound) {
  EXPECT_LE(worst.couple, bound);
  EXPECT_LE(worst.force, bound);
}

// Deflections are carried as straight lines on 16 pieces of up to 0.12 a. Where they bend, at the
// edge of the stick area, a line is off by an eighth of the piece times the bend, here a natural
// unit over a quarter of the radius: 0.4 %. The same from 10 steps on as from 100.
constexpr double kGrowing = 4e-3;
// Where the contact only shrinks, what is left is what it was: the error of constant force.
constexpr double kShrinking = kUnloading;

TEST(MdrLayersTest, AGrowingContactKeepsWhatItHoldsAndAddsSpringsAtRest) {
  const Leg twisted[] = {{1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 3, 0}};
  const Leg pushed[] = {{1, 0, 0}, {1, 0, 1}, {2, 0, 1}, {2, 0, 3}};
  const Leg while_twisted[] = {{0.2, 0, 0}, {1, 1, 0}};
  const Leg while_pushed[] = {{0.2, 0, 0}, {1, 0, 1}};
  for (const int steps : {10, 100}) {
    expect_within(follow_legs(twisted, steps), kGrowing);
    expect_within(follow_legs(pushed, steps), kGrowing);
    expect_within(follow_legs(while_twisted, steps), kGrowing);
    expect_within(follow_legs(while_pushed, steps), kGrowing);
  }
}

TEST(MdrLayersTest, AShrinkingContactLosesItsRimAndSlipsAtLowerLimits) {
  const Leg twisted[] = {{1, 0, 0}, {1, 1, 0}, {0.4, 1, 0}, {0.4, 0, 0}, {0.4, 1, 0}};
  const Leg pushed[] = {{1, 0, 0}, {1, 0, 1}, {0.4, 0, 1}, {0.4, 0, 0}, {0.4, 0, 1}};
  for (const int steps : {10, 100}) {
    expect_within(follow_legs(twisted, steps), kShrinking);
    expect_within(follow_legs(pushed, steps), kShrinking);
  }
}

TEST(MdrLayersTest, ABreathingContactForgetsNoMoreThanItShould) {
  const Leg twisted[] = {{1, 0, 0},   {1, .5, 0}, {.5, .5, 0}, {1, .5, 0},
                         {.5, .5, 0}, {1, .5, 0}, {1, 1, 0}};
  const Leg pushed[] = {{1, 0, 0},   {1, 0, .5}, {.5, 0, .5}, {1, 0, .5},
                        {.5, 0, .5}, {1, 0, .5}, {1, 0, 1}};
  expect_within(follow_legs(twisted, 100), kGrowing);
  expect_within(follow_legs(pushed, 100), kGrowing);
}

}  // namespace
}  // namespace torsion::engine
