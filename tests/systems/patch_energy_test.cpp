#include "systems/contact_models/patch_energy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/contact_models/local_inverse.hpp"
#include "tests/systems/asked_by_inverse.hpp"
#include "tests/systems/worked_ball.hpp"

// The holder's work on the contact model `patch`.

namespace torsion {
namespace {

using test::kBallDepth;
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

class PatchEnergyTest : public testing::TestWithParam<PatchEnergyCase> {};

TEST_P(PatchEnergyTest, EveryPathCostsWhatTheRegionHoldsMoreAfterIt) {
  // A hundred thousand steps and more, one path after the other with all that the last one left.
  // Where nu < 0.5 pressing alone loads the springs along the surface, and a closed path may well
  // give that back; never more. What a path still owes, later ones pay: with no charge nearly all
  // of them would owe.
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  ball.go(Place{});
  ball.stay(20);
  std::mt19937 random(41);
  constexpr int kPaths = 20000;
  double least = 1.0;
  int owing = 0;
  for (int path = 0; path < kPaths; ++path) {
    const double before = ball.held();
    ball.forget();
    ball.go(random_path(random, kLeast, kMost));
    least = std::min(least, (ball.work - (ball.held() - before)) / ball.throughput);
    owing += ball.owed() > 0.0 ? 1 : 0;
  }
  EXPECT_GE(least, -1e-9);
  EXPECT_LT(owing, kPaths / 2);
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

/// From the air down to somewhat more than its depth, and up again.
/// @param paths  on the ground in between
void press(WorkedBall& ball, std::mt19937& random, int paths) {
  constexpr int kSteps = 500;
  for (int step = -kSteps; step <= kSteps; ++step) {
    for (int path = 0; step == 0 && path < paths; ++path) {
      ball.go(random_path(random, kLeast, kMost));
    }
    const double high = std::abs(static_cast<double>(step)) / kSteps;
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

TEST_P(PatchEnergyTest, PressingAndLiftingOffComesOutEven) {
  // Up to a grid's force, half a percent, for down and up the grids are not laid anew at the same
  // depths, and that is not charged.
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  std::mt19937 random(43);
  press(ball, random, 0);
  EXPECT_NEAR(ball.work, 0.0, 0.005 * ball.throughput);
}

INSTANTIATE_TEST_SUITE_P(Grids, PatchEnergyTest,
                         testing::Values(PatchEnergyCase{0.5, 12}, PatchEnergyCase{0.3, 12},
                                         PatchEnergyCase{0.0, 12}, PatchEnergyCase{0.5, 16},
                                         PatchEnergyCase{0.3, 16}));

TEST(PatchEnergyOfClosedPathsTest, AHundredThousandOfSmallStepsFromRestCostWork) {
  // The goal: never below -1e-9 of the path's throughput. From springs at rest, which an
  // incompressible body's are after it was pressed straight down.
  WorkedBall ball({.side = 12});
  std::mt19937 random(29);
  double least = 1.0;
  for (int path = 0; path < 100000; ++path) {
    ball.lift_off();
    ball.go(Place{});
    ball.stay(12);
    ball.forget();
    ball.go(random_path(random, kLeast, kMost));
    least = std::min(least, ball.work / ball.throughput);
  }
  EXPECT_GE(least, -1e-9);
}

/// The least work, over what went to and fro, of closed paths from rest on the paper's cube.
double least_on_cube(ContactModel model) {
  WorkedBall ball({.model = model, .side = 12, .body = BodyModel::kCompliance});
  std::mt19937 random(29);
  double least = 1.0;
  for (int path = 0; path < 300; ++path) {
    ball.lift_off();
    ball.go(Place{});
    ball.stay(120);  // the body comes to rest more slowly than a half-space
    ball.forget();
    ball.go(random_path(random, kLeast, kMost));
    least = std::min(least, ball.work / ball.throughput);
  }
  return least;
}

TEST(EnergyOnABodyThatGivesWayTest, ClosedPathsOnTheCubeCostWork) {
  EXPECT_GE(least_on_cube(ContactModel::kMdr), -1e-9);
  // With patch what the body as a whole holds is not charged: paths may give back what a step's
  // solution leaves to do there, as far as that ends sweeps, 1 % of a step's change of a path of
  // six steps (patch.cpp, kSettledOnBody).
  EXPECT_GE(least_on_cube(ContactModel::kPatch), -0.01 / 6.0);
}

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
            test::asked_at(inverse, from % side - to % side, from / side - to / side);
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
      const Eigen::MatrixXd inverse = influences_of(tables).inverse();
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> shares(
          local_inverses_of(tables), inverse, Eigen::EigenvaluesOnly);
      const double stiffest = poisson < 0.5 ? kStiffestCoupled : kStiffest;
      EXPECT_GT(stiffest * shares.eigenvalues()(0), 1.0) << poisson << " " << aspect;
    }
  }
}

}  // namespace
}  // namespace torsion
