#include "systems/contact_models/patch_energy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/contact_models/local_inverse.hpp"
#include "tests/systems/pressed_ball.hpp"

// The holder's work on the contact model `patch`. It is reckoned here from outside, by the tool's
// wrench and the poses, in the mean of the wrenches before and after each step.

namespace torsion {
namespace {

using test::BallScene;
using test::Hand;
using test::kBallDepth;
using test::kBallRadius;
using test::make_ball_scene;
using test::options_of;

/// Where the ball is, over the place where it was pressed.
struct Place {
  glm::dvec3 shift{0.0};  // m
  double turn = 0.0;      // rad, about the world's y
};

Place operator+(const Place& a, const Place& b) {
  return {a.shift + b.shift, a.turn + b.turn};
}

Place operator-(const Place& a, const Place& b) {
  return {a.shift - b.shift, a.turn - b.turn};
}

constexpr std::size_t kWay = 3;  // steps away; as many lead back in another order
using Path = std::array<Place, 2 * kWay>;

/// Three steps away and the same three back in another order, each down or up, or aside and round.
/// @param rises  largest step down or up, of the depth
/// @param least  smallest largest step aside, of the depth; a hundred times as much is the largest
Path random_path(std::mt19937& random, double rises, double least) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double depth = rises * kBallDepth;
  const double size = least * std::pow(10.0, 1.0 + uniform(random));
  std::array<Place, kWay> steps;
  for (Place& step : steps) {
    const double x = size * kBallDepth * uniform(random);
    const double z = size * kBallDepth * uniform(random);
    const double turn = 0.1 * size * uniform(random);
    step = uniform(random) < 0.0 ? Place{{0.0, depth * uniform(random), 0.0}, 0.0}
                                 : Place{{x, 0.0, z}, turn};
  }
  Path path;
  Place at;
  for (std::size_t k = 0; k < kWay; ++k) {
    at = at + steps[k];
    path[k] = at;
  }
  std::shuffle(steps.begin(), steps.end(), random);
  for (std::size_t k = 0; k + 1 < kWay; ++k) {
    at = at - steps[k];
    path[kWay + k] = at;
  }
  path.back() = {};
  return path;
}

/// A ball over the cube whose holder's work is added up.
class WorkedBall {
 public:
  explicit WorkedBall(const BallScene& scene) : hand_(make_ball_scene(scene), options(scene)) {
    go({glm::dvec3(0.0, 2.0 * kBallDepth, 0.0), 0.0});
    forget();
  }

  void go(const Place& place) {
    const glm::dvec3 from = hand_.poses[0].position;
    const Wrench wrench = hand_.wrench();
    hand_.step_to({{kHome + place.shift, glm::angleAxis(place.turn, glm::dvec3(0.0, 1.0, 0.0))}});
    const Wrench& after = hand_.wrench();
    // What was gone, not what was asked for: a step has few digits of the place.
    const glm::dvec3 gone = -0.5 * (wrench.force + after.force) * (hand_.poses[0].position - from);
    const double turned = -0.5 * (wrench.torque.y + after.torque.y) * (place.turn - turn_);
    turn_ = place.turn;
    work += gone.x + gone.y + gone.z + turned;
    throughput += std::abs(gone.x) + std::abs(gone.y) + std::abs(gone.z) + std::abs(turned);
  }
  void stay(int steps) {
    for (int step = 0; step < steps; ++step) {
      go({hand_.poses[0].position - kHome, turn_});
    }
  }
  void forget() {
    work = 0.0;
    throughput = 0.0;
  }
  /// What the region holds, less what is still to be charged, J.
  [[nodiscard]] double held() const {
    const PatchEnergy& energy = hand_.world().regions.at<PatchEnergy>(0);
    return energy.held - energy.owed;
  }
  [[nodiscard]] const Hand& hand() const { return hand_; }

  double work = 0.0;        // J
  double throughput = 0.0;  // J: what went to and fro

 private:
  static PrepareOptions options(const BallScene& scene) {
    PrepareOptions options = options_of(scene);
    options.rate = 10.0;  // Hz: what a new region exerts fades in within one step
    return options;
  }

  static constexpr glm::dvec3 kHome{0.0, 0.1 + kBallRadius - kBallDepth, 0.0};
  Hand hand_;
  double turn_ = 0.0;
};

constexpr double kSmallRise = 1e-4;  // as in mdr_energy_test.cpp

struct EnergyCase {
  double poisson;
  std::uint32_t side;
};

void PrintTo(const EnergyCase& energy, std::ostream* out) {
  *out << energy.poisson << " " << energy.side;
}

class PatchEnergyTest : public testing::TestWithParam<EnergyCase> {};

TEST_P(PatchEnergyTest, EveryPathCostsWhatTheRegionHoldsMoreAfterIt) {
  // A hundred thousand steps and more, one path after the other with all that the last one left.
  // Where nu < 0.5 pressing alone loads the springs along the surface, and a closed path may well
  // give that back; never more.
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  ball.go({});
  ball.stay(20);
  std::mt19937 random(41);
  double least = 1.0;
  for (int path = 0; path < 20000; ++path) {
    const double before = ball.held();
    ball.forget();
    for (const Place& place : random_path(random, kSmallRise, 1e-3)) {
      ball.go(place);
    }
    least = std::min(least, (ball.work - (ball.held() - before)) / ball.throughput);
  }
  EXPECT_GE(least, -1e-9);
}

TEST_P(PatchEnergyTest, WhatIsHeldIsTheWorkOfPressing) {
  // In a thousand steps: a staircase of cells holds what their forces took to it, up to what slips
  // under way and to the coming and going of cells, a part in a thousand.
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  constexpr int kSteps = 1000;
  for (int step = 1; step <= kSteps; ++step) {
    ball.go({{0.0, kBallDepth * (1.0 - static_cast<double>(step) / kSteps), 0.0}, 0.0});
  }
  ball.stay(20);
  EXPECT_NEAR(ball.held(), ball.work, 0.01 * ball.work);
  // Hertz: F d times 2/5.
  EXPECT_NEAR(ball.work, 0.4 * ball.hand().wrench().force.y * kBallDepth, 0.02 * ball.work);
}

TEST_P(PatchEnergyTest, FromTheAirToTheAirCostsWork) {
  // Touches, presses, goes about in steps of any size, lifts off, ten times over.
  WorkedBall ball({.poisson = GetParam().poisson, .side = GetParam().side});
  std::mt19937 random(43);
  constexpr int kSteps = 500;
  for (int press = 0; press < 10; ++press) {
    for (int step = -kSteps; step <= kSteps; ++step) {
      if (step == 0) {
        for (int path = 0; path < 100; ++path) {
          for (const Place& place : random_path(random, 0.02, 3e-2)) {
            ball.go(place);
          }
        }
      }
      const double high = std::abs(static_cast<double>(step)) / kSteps;
      ball.go({{0.0, 1.1 * kBallDepth * high, 0.0}, 0.0});
    }
    EXPECT_GT(ball.work, 0.0) << press;
  }
}

INSTANTIATE_TEST_SUITE_P(Grids, PatchEnergyTest,
                         testing::Values(EnergyCase{0.5, 12}, EnergyCase{0.3, 12},
                                         EnergyCase{0.0, 12}, EnergyCase{0.5, 16},
                                         EnergyCase{0.3, 16}));

TEST(PatchEnergyOfClosedPathsTest, AHundredThousandOfSmallStepsFromRestCostWork) {
  // The goal: never below -1e-9 of the path's throughput. From springs at rest, which an
  // incompressible body's are after it was pressed straight down.
  WorkedBall ball({.side = 12});
  std::mt19937 random(29);
  double least = 1.0;
  for (int path = 0; path < 100000; ++path) {
    ball.go({glm::dvec3(0.0, 2.0 * kBallDepth, 0.0), 0.0});
    ball.go({});
    ball.stay(12);
    ball.forget();
    for (const Place& place : random_path(random, kSmallRise, 1e-3)) {
      ball.go(place);
    }
    least = std::min(least, ball.work / ball.throughput);
  }
  EXPECT_GE(least, -1e-9);
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
  for (const InfluenceKind kind : {InfluenceKind::kXX, InfluenceKind::kYY, InfluenceKind::kZZ}) {
    const LocalInverse inverse = local_inverse(tables, kind);
    const double rows[2][2] = {{inverse.here, inverse.along_y}, {inverse.along_x, inverse.corner}};
    for (int from = 0; from < cells; ++from) {
      for (int to = 0; to < cells; ++to) {
        const int x = std::abs(from % side - to % side);
        const int y = std::abs(from / side - to / side);
        if (x <= 1 && y <= 1) {
          all(block * cells + to, block * cells + from) = rows[x][y];
        }
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
    constexpr std::size_t kTable = (2 * kSide - 1) * (2 * kSide);
    for (std::uint32_t aspect = 0; aspect < kAspects; ++aspect) {
      InfluenceTables tables;
      tables.side = kSide;
      for (std::size_t kind = 0; kind < kInfluenceKinds; ++kind) {
        tables.kinds[kind] = &values[(aspect * kInfluenceKinds + kind) * kTable];
      }
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
