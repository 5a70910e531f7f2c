#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/mdr/mdr_springs.hpp"

namespace torsion::engine {
namespace {

using test::MdrSprings;

/// Small steps, large ones and rest, in natural units, in any mixture of sliding and spinning.
struct RandomMotion {
  std::mt19937 random;
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};

  double size() { return std::pow(10.0, -1.5 + 2.0 * uniform(random)); }
  glm::dvec2 slide(const MdrSprings& of) {
    return of.natural_slide() * size() * glm::dvec2(uniform(random), uniform(random));
  }
  double spin(const MdrSprings& of) { return of.natural_turn() * size() * uniform(random); }
};

TEST(MdrPropertiesTest, NoMotionLeavesTheExactLimitCurve) {
  // Every layer's limit is a polygon inside the exact curve, and the layers' sum of a convex set
  // stays in it, so only rounding may lead out.
  for (const double poisson : {0.0, 0.5}) {
    MdrSprings springs(poisson);
    RandomMotion motion{std::mt19937(3), {}};
    double largest = 0.0;
    for (int step = 0; step < 100000; ++step) {
      if (step % 5 == 0) {
        springs.press(test::kDepth * (1.0 + 0.9 * motion.uniform(motion.random)));
      }
      springs.move(motion.slide(springs), motion.spin(springs));
      largest = std::max(largest, springs.load());
    }
    EXPECT_LE(largest, 1.0 + 1e-9);
    EXPECT_GE(largest, 0.99);  // it has been there
  }
}

TEST(MdrPropertiesTest, SteadySlidingWithSpinEndsOnTheExactLimitSurface) {
  // By normality the motion's direction picks the place on the curve; on a polygon that is a
  // corner, up to half a segment (1.6 / 64 / 2 = 1.2 % of the largest loads) away. Each layer ends
  // where the exact curve's normal is the motion's, for its stiffnesses no longer matter.
  for (const double ratio : {0.0, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 20.0}) {
    for (const double angle : {0.0, 1.0, 4.0}) {
      MdrSprings springs(0.5);
      const double spin = 0.02;  // rad a step
      const glm::dvec2 slide =
          ratio * spin * springs.contact.radius * glm::dvec2(std::cos(angle), std::sin(angle));
      for (int step = 0; step < 1000; ++step) {
        springs.move(slide, spin);
      }
      const reference::SlidingSpinning exact = reference::hertz_limit_surface(ratio);
      const double force =
          -glm::dot(springs.last.force, glm::dvec2(std::cos(angle), std::sin(angle)));
      EXPECT_NEAR(force / springs.limit_force(), exact.force, 0.012) << ratio;
      EXPECT_NEAR(-springs.last.couple / springs.limit_couple(),
                  exact.moment / reference::pure_spin_moment(), 0.012)
          << ratio;
      EXPECT_NEAR(springs.load(), 1.0, 2.1e-4) << ratio;
    }
  }
}

/// Work of the hand against the friction in one step, by the mean of the forces before and after.
double work(const MdrForces& before, const MdrForces& after, const glm::dvec2& slide, double spin) {
  return -0.5 *
         (glm::dot(before.force + after.force, slide) + (before.couple + after.couple) * spin);
}

/// Random closed paths of small steps from springs at rest: the hand's work so far is never
/// negative.
/// @param breathing  largest relative change of the depth in a step
void expect_work_on_closed_paths(int paths, int steps, double breathing) {
  RandomMotion motion{std::mt19937(11), {}};
  for (int path = 0; path < paths; ++path) {
    MdrSprings springs(0.5);
    glm::dvec2 place(0.0);
    double turn = 0.0;
    double depth = test::kDepth;
    double sum = 0.0;
    double throughput = 0.0;
    const double scale = 0.1 * motion.size();
    for (int step = 1; step <= steps; ++step) {
      glm::dvec2 slide = scale * motion.slide(springs);
      double spin = scale * motion.spin(springs);
      if (step == steps) {
        slide = -place;
        spin = -turn;
      }
      if (breathing > 0.0) {
        depth *= 1.0 + breathing * motion.uniform(motion.random);
        springs.press(depth);
      }
      const MdrForces before = springs.last;
      springs.move(slide, spin);
      const double done = work(before, springs.last, slide, spin);
      sum += done;
      throughput += std::abs(done);
      place += slide;
      turn += spin;
      ASSERT_GE(sum, -1e-12 * throughput) << path << " " << step;
    }
  }
}

TEST(MdrPropertiesTest, ClosedPathsAtConstantDepthCostWork) {
  // The work done is what is stored plus what is lost, and both are >= 0 for every layer: with f1
  // the farthest point of the limit set along the slip s, (f0 + f1) s / 2 >= 0. Left: rounding.
  expect_work_on_closed_paths(10000, 30, 0.0);
}

TEST(MdrPropertiesTest, ClosedPathsCostWorkWhileTheDepthChanges) {
  // Springs at rest come and deflected ones go; carrying deflections over takes from what is
  // stored.
  expect_work_on_closed_paths(3000, 100, 0.05);
}

/// What the springs hold, by their stiffnesses: 8 G a / (2 - nu) and 16 / 3 G a^3 in all, J.
double stored_energy(const MdrSprings& springs) {
  const MdrPlaces places = springs.places();
  const double a = springs.contact.radius;
  const double slide = 8.0 * test::kShearModulus * a / (2.0 - springs.contact.poisson_ratio);
  const double turn = 16.0 / 3.0 * test::kShearModulus * a * a * a;
  double energy = 0.0;
  for (std::size_t k = 0; k < kMdrLayers; ++k) {
    const MdrLayer& layer = springs.layers[k];
    energy += 0.5 * slide * places.shift.stiffness[k] * glm::dot(layer.shift, layer.shift) +
              0.5 * turn * places.turn.stiffness[k] * layer.turn * layer.turn;
  }
  return energy;
}

TEST(MdrPropertiesTest, NoChangeOfSizeOrPressureAddsToWhatIsStored) {
  // A projection is not longer than what is projected. Sizes from a thousandth of a per cent up to
  // a factor of two, contacts that go flat and back: only rounding may be gained.
  MdrSprings springs(0.5);
  RandomMotion motion{std::mt19937(17), {}};
  double lost = 0.0;
  for (int step = 0; step < 20000; ++step) {
    springs.move(motion.slide(springs), motion.spin(springs));
    const double before = stored_energy(springs);
    const MdrPlaces places = springs.places();
    const double radius = springs.contact.radius;
    springs.contact.radius *= std::exp(std::pow(10.0, -2.5 + 2.5 * motion.uniform(motion.random)) *
                                       0.7 * motion.uniform(motion.random));
    springs.contact.radius = std::clamp(springs.contact.radius, 1e-3, 1e-2);
    if (step % 3 == 0) {
      springs.contact.flat_share = std::abs(motion.uniform(motion.random));
    }
    resize_layers({places, radius}, {springs.places(), springs.contact.radius}, springs.layers);
    const double after = stored_energy(springs);
    ASSERT_LE(after, before * (1.0 + 1e-12)) << step;
    lost += before - after;
  }
  EXPECT_GT(lost, 0.0);
}

TEST(MdrPropertiesTest, GrowingKeepsTheForceThatIsHeld) {
  // What is projected keeps its mean: a contact that grows holds neither more nor less.
  MdrSprings springs(0.3);
  springs.move({0.4 * springs.natural_slide(), 0.1 * springs.natural_slide()},
               0.5 * springs.natural_turn());
  const MdrForces held = springs.last;
  double depth = test::kDepth;
  for (int step = 0; step < 300; ++step) {
    depth *= 1.003;
    springs.press(depth);
  }
  EXPECT_LE(glm::distance(springs.last.force, held.force), 1e-12 * glm::length(held.force));
  EXPECT_NEAR(springs.last.couple / held.couple, 1.0, 1e-12);
}

TEST(MdrPropertiesTest, NoStepTakesMoreThanItStores) {
  // Work of the hand = change of what is stored + what is lost, and that is >= 0 in every step.
  MdrSprings springs(0.3);
  RandomMotion motion{std::mt19937(23), {}};
  for (int step = 0; step < 100000; ++step) {
    const glm::dvec2 slide = motion.slide(springs);
    const double spin = motion.spin(springs);
    const double before = stored_energy(springs);
    const MdrForces from = springs.last;
    springs.move(slide, spin);
    const double done = work(from, springs.last, slide, spin);
    ASSERT_GE(done - (stored_energy(springs) - before), -1e-12 * (before + std::abs(done))) << step;
  }
}

/// Couple and forces after a path of slide, spin and depth in so many equal steps.
MdrForces along_a_path(int steps) {
  MdrSprings springs(0.5);
  const double slide = 2.0 * springs.natural_slide();
  const double turn = 3.0 * springs.natural_turn();
  glm::dvec2 place(0.0);
  double angle = 0.0;
  for (int step = 1; step <= steps; ++step) {
    const double t = 6.0 * step / steps;
    const glm::dvec2 next(slide * (1.0 - std::cos(t)), 0.5 * slide * std::sin(2.0 * t));
    const double next_angle = turn * std::sin(1.3 * t);
    springs.press(test::kDepth * (1.0 + 0.2 * std::sin(2.0 * t)));
    springs.move(next - place, next_angle - angle);
    place = next;
    angle = next_angle;
  }
  return springs.last;
}

TEST(MdrPropertiesTest, TheSamePathInMoreStepsEndsAlike) {
  // Chords of a curved path: the difference goes with the step's length, about 1 / steps of the
  // largest loads.
  const MdrSprings unit(0.5);
  const MdrForces fine = along_a_path(10000);
  for (const int steps : {100, 200, 400, 800}) {
    const MdrForces coarse = along_a_path(steps);
    EXPECT_LE(glm::distance(coarse.force, fine.force), unit.limit_force() / steps);
    EXPECT_LE(std::abs(coarse.couple - fine.couple), unit.limit_couple() / steps);
  }
}

TEST(MdrPropertiesTest, AStraightPathDoesNotKnowItsSteps) {
  // Twist alone at constant depth: every spring goes elastically to its limit and stays there.
  std::array<double, 2> couples{};
  for (std::size_t run = 0; run < 2; ++run) {
    MdrSprings springs(0.5);
    const int steps = run == 0 ? 100 : 10000;
    for (int step = 0; step < steps; ++step) {
      springs.move({}, 1.5 * springs.natural_turn() / steps);
    }
    for (int step = 0; step < steps; ++step) {
      springs.move({}, -0.7 * springs.natural_turn() / steps);
    }
    couples[run] = springs.last.couple / springs.limit_couple();
  }
  EXPECT_NEAR(couples[0], couples[1], 1e-10);
}

TEST(MdrPropertiesTest, TheSamePathAgainGivesTheSameBits) {
  const MdrForces once = along_a_path(800);
  const MdrForces again = along_a_path(800);
  EXPECT_EQ(again.force, once.force);
  EXPECT_EQ(again.couple, once.couple);
}

TEST(MdrPropertiesTest, WithoutFrictionNothingIsHeld) {
  MdrSprings springs(0.5);
  springs.move({1e-4, 0.0}, 0.02);
  EXPECT_LT(springs.last.couple, 0.0);
  springs.contact.friction = 0.0;
  springs.move({1e-4, 0.0}, 0.02);
  EXPECT_EQ(springs.last.force, glm::dvec2(0.0));
  EXPECT_EQ(springs.last.couple, 0.0);
  springs.contact.friction = test::kFriction;
  springs.move({}, 0.0);  // and nothing comes back
  EXPECT_EQ(springs.last.couple, 0.0);
}

}  // namespace
}  // namespace torsion::engine
