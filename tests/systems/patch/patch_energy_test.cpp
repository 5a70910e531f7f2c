#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/half_space/influence.hpp"
#include "systems/patch/energy.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/studies.hpp"
#include "tests/systems/patch/local_inverse_at.hpp"
#include "tests/systems/patch/worked_ball.hpp"

// The holder's work on the contact model `patch`.

namespace torsion::engine {
namespace {

using test::BallScene;
using test::kBallDepth;
using test::kBallRadius;
using test::Place;
using test::random_path;
using test::WorkedBall;

// From where the energy of a path has digits beside that of pressing to a tenth of the depth.
constexpr double kLeast = 1e-3;
constexpr double kMost = 1e-1;

struct PatchEnergyCase {
  double poisson;
  std::uint32_t side;
};

void PrintTo(const PatchEnergyCase& energy, std::ostream* out) {
  *out << energy.poisson << " " << energy.side;
}

class PatchEnergyTest : public testing::TestWithParam<PatchEnergyCase> {
 protected:
  void SetUp() override {
    if (test::is_left_out(GetParam().side == 12 && GetParam().poisson > 0.0)) {
      GTEST_SKIP() << test::kLeftOut;
    }
  }
};

TEST_P(PatchEnergyTest, EveryPathCostsWhatTheRegionHoldsMoreAfterIt) {
  // Many thousand steps, one path after the other with all that the last one left.
  // Where nu < 0.5 pressing alone loads the springs along the surface, and a closed path may well
  // give that back; never more. What a path still owes, later ones pay: with no charge nearly all
  // of them would owe.
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  ball.go(Place{});
  ball.stay(20);
  std::mt19937 random(41);
  const int paths = test::trials_of(20000);
  double least = 1.0;
  int owing = 0;
  for (int path = 0; path < paths; ++path) {
    const double before = ball.held();
    ball.forget();
    ball.go(random_path(random, kLeast, kMost));
    least = std::min(least, (ball.work - (ball.held() - before)) / ball.throughput);
    owing += ball.owed() > 0.0 ? 1 : 0;
  }
  EXPECT_GE(least, -1e-9);
  EXPECT_LT(owing, paths / 2);
}

TEST_P(PatchEnergyTest, WhatIsHeldIsTheWorkOfPressing) {
  // What the last grid holds and what all grids on the way took are each off by as much as a grid's
  // force, half a percent (NormalForceIsHertzsOnceSettled).
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  constexpr int kSteps = 1000;
  for (int step = 1; step <= kSteps; ++step) {
    ball.go(Place{{0.0, kBallDepth * (1.0 - static_cast<double>(step) / kSteps), 0.0}, 0.0});
  }
  ball.stay(20);
  EXPECT_NEAR(ball.held(), ball.work, 0.01 * ball.work);
  // F d times 2/5: with friction, too, the force goes as the depth to the power 3/2 (Spence, J.
  // Elasticity 5 (1975) 297).
  EXPECT_NEAR(ball.work, 0.4 * ball.hand().wrench().force.y * kBallDepth, 0.01 * ball.work);
}

constexpr int kStepsOfPress = 500;  // of press, one way

/// From the air down to somewhat more than its depth, and up again.
/// @param paths  on the ground in between
void press(WorkedBall& ball, std::mt19937& random, int paths) {
  for (int step = -kStepsOfPress; step <= kStepsOfPress; ++step) {
    for (int path = 0; step == 0 && path < paths; ++path) {
      ball.go(random_path(random, kLeast, kMost));
    }
    const double high = std::abs(static_cast<double>(step)) / kStepsOfPress;
    ball.go(Place{{0.0, 1.1 * kBallDepth * high, 0.0}, 0.0});
  }
}

TEST_P(PatchEnergyTest, FromTheAirToTheAirCostsWork) {
  // The same paths with no charge give up to a percent of their throughput.
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  std::mt19937 random(43);
  for (int time = 0; time < 10; ++time) {
    press(ball, random, 200);
    EXPECT_GT(ball.work, 0.0) << time;
    ball.forget();
  }
}

TEST_P(PatchEnergyTest, PressingAndLiftingOffGivesNothing) {
  // Down and up the grids are not laid anew at the same depths, and each holds something else: up
  // to 6e-4 would come of it.
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  std::mt19937 random(43);
  press(ball, random, 0);
  // The step into the air, by the mean of its force and nothing, is half of F d where 2/5 were
  // held, of a throughput of 4/5 of all F D.
  EXPECT_GT(ball.work, -0.125 * std::pow(1.0 / kStepsOfPress, 2.5) * ball.throughput);
  // A grid's force is off by up to half a percent.
  EXPECT_LT(ball.work, 0.005 * ball.throughput);
}

TEST_P(PatchEnergyTest, DeepAndShallowAgainCostsWhatTheRegionHoldsMore) {
  // Grids are laid anew over and over, in sizes from a third to one, and slide in between.
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  ball.go(Place{});
  ball.stay(20);
  std::mt19937 random(47);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr int kStepsOfWay = 1000;
  constexpr double kShallow = 0.1;  // of the depth
  double least = 1.0;
  Place from;
  for (int way = 0; way < 30; ++way) {
    Place to = from;
    if (way % 2 == 0) {
      to.shift.y = 0.5 * (1.0 - kShallow) * (1.0 + uniform(random)) * kBallDepth;
    } else {
      to = {{2.0 * kBallDepth * uniform(random), from.shift.y, 2.0 * kBallDepth * uniform(random)},
            0.1 * uniform(random)};
    }
    const double before = ball.held();
    ball.forget();
    for (int step = 1; step <= kStepsOfWay; ++step) {
      const double share = static_cast<double>(step) / kStepsOfWay;
      const Place left = to - from;
      ball.go(from + Place{share * left.shift, share * left.turn});
    }
    from = to;
    least = std::min(least, (ball.work - (ball.held() - before)) / ball.throughput);
  }
  // The mean of two forces is off by (h / d)^2 / 16 of a power law of 3/2. And of each of three
  // grids or fewer a way, what it changes, half a percent of the force, is output a step late.
  const double step = (1.0 - kShallow) / kStepsOfWay / kShallow;
  EXPECT_GE(least, -step * step / 16.0 - 3.0 * 0.005 / kStepsOfWay);
}

INSTANTIATE_TEST_SUITE_P(Grids, PatchEnergyTest,
                         testing::Values(PatchEnergyCase{0.5, 12}, PatchEnergyCase{0.3, 12},
                                         PatchEnergyCase{0.0, 12}, PatchEnergyCase{0.5, 16},
                                         PatchEnergyCase{0.3, 16}));

TEST(PatchEnergyOfClosedPathsTest, ManyOfSmallStepsFromRestCostWork) {
  // Never below -1e-9 of the path's throughput. From springs at rest, which an incompressible
  // body's are after it was pressed straight down.
  WorkedBall ball({.side = 12});
  std::mt19937 random(29);
  double least = 1.0;
  for (int path = 0; path < test::trials_of(100000, 20); ++path) {
    ball.lift_off();
    ball.go(Place{});
    ball.stay(12);
    ball.forget();
    ball.go(random_path(random, kLeast, kMost));
    least = std::min(least, ball.work / ball.throughput);
  }
  EXPECT_GE(least, -1e-9);
}

TEST(PatchEnergyOfClosedPathsTest, RollingToAndFroCostsWork) {
  // With no drag against rolling 1e-4 of force and way came of it, in steps of every size. Smaller
  // ones than these take less drag than that (docs/models.md).
  for (const std::uint32_t side : {12U, 16U}) {
    for (const double share : {0.05, 0.01}) {
      WorkedBall ball({.side = side});
      ball.go(Place{});
      ball.stay(12);
      const double radius = std::sqrt(kBallRadius * kBallDepth);
      const int steps = static_cast<int>(2.0 / share);
      for (int time = 0; time < 3; ++time) {
        ball.forget();
        ball.roll(share * radius, steps);
        EXPECT_TRUE(time == 0 || ball.work > 0.0) << side << " " << share << " " << time;
      }
    }
  }
}

struct YieldingCase {
  ContactModel model;
  double poisson;
  int feet;
};

void PrintTo(const YieldingCase& yielding, std::ostream* out) {
  *out << (yielding.model == ContactModel::kMdr ? "mdr " : "patch ") << yielding.poisson << " feet "
       << yielding.feet;
}

class EnergyOnABodyThatGivesWayTest : public testing::TestWithParam<YieldingCase> {
 protected:
  /// A ball, or two side by side, over the paper's cube.
  static WorkedBall make_ball() {
    const BallScene ball{.model = GetParam().model,
                         .poisson = GetParam().poisson,
                         .side = 12,
                         .body = BodyModel::kCompliance};
    SceneDescription scene = make_ball_scene(ball);
    if (GetParam().feet == 2) {
      const auto foot = [](double x, double z) {
        return test::make_part(ShapeKind::kSphere, glm::dvec3(kBallRadius),
                               {glm::dvec3(x, 0.0, z), glm::dquat(1.0, 0.0, 0.0, 0.0)});
      };
      scene.tools[0] = test::make_tool({foot(-0.025, 0.0), foot(0.02, 0.01)});
    }
    return {ball, scene};
  }
  void SetUp() override {
    if (test::is_left_out(GetParam().poisson == 0.3 || GetParam().model == ContactModel::kMdr)) {
      GTEST_SKIP() << test::kLeftOut;
    }
  }
  /// Turned less by as much as the feet are farther from the middle than a contact's rim.
  static test::Path path_of(std::mt19937& random) {
    test::Path path = random_path(random, kLeast, kMost);
    for (Place& place : path) {
      place.turn *= GetParam().feet == 2 ? 0.05 : 1.0;
    }
    return path;
  }
};

TEST_P(EnergyOnABodyThatGivesWayTest, ClosedPathsFromTheAirCostWhatIsHeldMore) {
  WorkedBall ball = make_ball();
  std::mt19937 random(29);
  double least = 1.0;
  for (int path = 0; path < 300; ++path) {
    ball.lift_off();
    ball.go(Place{});
    ball.stay(120);  // the body comes to rest more slowly than a half-space
    ball.forget();
    const double before = ball.held();
    ball.go(path_of(random));
    least = std::min(least, (ball.work - (ball.held() - before)) / ball.throughput);
  }
  EXPECT_GE(least, -1e-9);
}

class EnergyOfFeetTest : public EnergyOnABodyThatGivesWayTest {};

TEST_P(EnergyOfFeetTest, FromTheAirToTheAirCostsWork) {
  // What a body holds of one region's load over another's is in no region's account.
  WorkedBall ball = make_ball();
  std::mt19937 random(31);
  for (int time = 0; time < 3; ++time) {
    for (int step = -kStepsOfPress; step <= kStepsOfPress; ++step) {
      for (int path = 0; step == 0 && path < 50; ++path) {
        ball.go(path_of(random));
      }
      const double high = std::abs(static_cast<double>(step)) / kStepsOfPress;
      ball.go(Place{{0.0, 1.1 * kBallDepth * high, 0.0}, 0.0});
    }
    EXPECT_GT(ball.work, 0.0) << time;
    ball.forget();
  }
}

INSTANTIATE_TEST_SUITE_P(Models, EnergyOnABodyThatGivesWayTest,
                         testing::Values(YieldingCase{ContactModel::kMdr, 0.5, 1},
                                         YieldingCase{ContactModel::kPatch, 0.5, 1},
                                         YieldingCase{ContactModel::kPatch, 0.3, 1},
                                         YieldingCase{ContactModel::kPatch, 0.0, 1}));
INSTANTIATE_TEST_SUITE_P(Models, EnergyOfFeetTest,
                         testing::Values(YieldingCase{ContactModel::kPatch, 0.3, 1},
                                         YieldingCase{ContactModel::kMdr, 0.5, 2},
                                         YieldingCase{ContactModel::kPatch, 0.5, 2},
                                         YieldingCase{ContactModel::kPatch, 0.3, 2}));

/// All influences of one grid on each other: along x, along y, and into the body.
Eigen::MatrixXd influences_of(const InfluenceTables& tables) {
  const std::uint32_t side = tables.side;
  const auto cells = static_cast<Eigen::Index>(side * side);
  Eigen::MatrixXd all(3 * cells, 3 * cells);
  for (std::uint32_t from = 0; from < side * side; ++from) {
    for (std::uint32_t to = 0; to < side * side; ++to) {
      const auto at = [&](InfluenceKind kind) {
        return tables.of(kind)[tables.index(from % side, from / side, to % side, to / side)];
      };
      const auto row = static_cast<Eigen::Index>(to);
      const auto column = static_cast<Eigen::Index>(from);
      all(row, column) = at(InfluenceKind::kXX);
      all(row, cells + column) = all(cells + row, column) = at(InfluenceKind::kXY);
      all(cells + row, cells + column) = at(InfluenceKind::kYY);
      all(2 * cells + row, 2 * cells + column) = at(InfluenceKind::kZZ);
      all(2 * cells + row, column) = at(InfluenceKind::kZX);
      all(2 * cells + row, cells + column) = at(InfluenceKind::kZY);
      all(row, 2 * cells + column) = -at(InfluenceKind::kZX);
      all(cells + row, 2 * cells + column) = -at(InfluenceKind::kZY);
    }
  }
  return all;
}

/// The local inverses of the three directions.
Eigen::MatrixXd local_inverses_of(const InfluenceTables& tables) {
  const auto side = static_cast<int>(tables.side);
  const int cells = side * side;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * cells, 3 * cells);
  int block = 0;
  const LocalInverses inverses = local_inverses(tables);
  for (const LocalInverse& inverse : {inverses.x, inverses.y, inverses.z}) {
    for (int from = 0; from < cells; ++from) {
      for (int to = 0; to < cells; ++to) {
        all(block * cells + to, block * cells + from) =
            test::local_inverse_at(inverse, from % side - to % side, from / side - to / side);
      }
    }
    ++block;
  }
  return all;
}

TEST(PatchStiffestTest, IsStifferThanAllInfluences) {
  // What is left to do must never be taken for less than it is: the local inverse, `stiffest`
  // times, less the inverse of the influences is positive definite.
  constexpr std::uint32_t kSide = 12;
  for (const double poisson : {0.5, 0.3, 0.0}) {
    std::vector<double> values(influence_count(kSide));
    fill_influences(poisson, kSide, values);
    for (std::int32_t aspect = -kMostAspect; aspect <= kMostAspect; ++aspect) {
      const InfluenceTables tables = influence_tables(values, kSide, aspect);
      const Eigen::MatrixXd inverse = test::inverse(influences_of(tables));
      const double least = test::generalized_eigenvalues(local_inverses_of(tables), inverse)(0);
      const double stiffest = poisson < 0.5 ? kStiffestCoupled : kStiffest;
      EXPECT_GT(stiffest * least, 1.0) << poisson << " " << aspect;
    }
  }
}

}  // namespace
}  // namespace torsion::engine
