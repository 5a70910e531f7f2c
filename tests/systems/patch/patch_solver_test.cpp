#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "systems/patch/solver.hpp"
#include "tests/reference/exact/cattaneo_mindlin.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/lubkin.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kSide = 24;
constexpr double kShearModulus = 1e6;  // Pa
constexpr double kRadius = 0.05;       // m
constexpr double kDepth = 4e-4;        // m
constexpr double kFriction = 0.75;

/// One grid under a paraboloid, driven by hand, that goes from one solved state to the next.
class Grid {
 public:
  Grid(double poisson, bool coupled, double friction = kFriction)
      : poisson_(poisson), values_(influence_count(kSide)) {
    fill_influences(poisson, kSide, values_);
    const double half = 1.35 * std::sqrt(kRadius * kDepth);
    cell_ = 2.0 * half / kSide;
    for (std::vector<double>& column : columns_) {
      column.assign(kSide * kSide, 0.0);
    }
    work.reserve(kSide);
    problem.influences = influence_tables(values_, kSide, 0);
    problem.compliance = cell_ / kShearModulus;
    problem.coupled = coupled;
    problem.feedback = friction * (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson));
    problem.reference = 1e5;
    problem.skip = 1e-9;
    problem.settled = 0.0;
    problem.rounds = 100;
    problem.iterations = 1000;
    for (std::uint32_t cell = 0; cell < kSide * kSide; ++cell) {
      const double x = place_x(cell);
      const double y = place_y(cell);
      view().depth[cell] = kDepth - (x * x + y * y) / (2.0 * kRadius);
      view().friction[cell] = friction;
    }
  }

  [[nodiscard]] double place_x(std::uint32_t cell) const {
    return (cell % kSide + 0.5 - 0.5 * kSide) * cell_;
  }
  [[nodiscard]] double place_y(std::uint32_t cell) const {
    return (cell / kSide + 0.5 - 0.5 * kSide) * cell_;
  }
  PatchColumns view() {
    return {columns_[0], columns_[1], columns_[2], columns_[3], columns_[4], columns_[5],
            columns_[6], columns_[7], columns_[8], columns_[9], columns_[10]};
  }
  /// Cells that stick go on with the tool, those that slip start from where they are.
  PatchOutcome move(double slide, double turn) {
    const PatchColumns columns = view();
    for (std::uint32_t cell = 0; cell < kSide * kSide; ++cell) {
      const bool slips = columns.slips[cell] != 0.0;
      const double from_x = slips ? columns.moved_x[cell] : columns.target_x[cell];
      const double from_y = slips ? columns.moved_y[cell] : columns.target_y[cell];
      columns.target_x[cell] = from_x + slide - turn * place_y(cell);
      columns.target_y[cell] = from_y + turn * place_x(cell);
    }
    return solve_patch(problem, columns, work);
  }
  double force() {
    return sum([&](std::uint32_t cell) { return view().pressure[cell]; });
  }
  double pull() {
    return sum([&](std::uint32_t cell) { return view().traction_x[cell]; });
  }
  double couple() {
    return sum([&](std::uint32_t cell) {
      return place_x(cell) * view().traction_y[cell] - place_y(cell) * view().traction_x[cell];
    });
  }
  [[nodiscard]] reference::HertzSphere hertz() const {
    return reference::hertz_sphere_at_depth(kRadius, 2.0 * kShearModulus / (1.0 - poisson_),
                                            kDepth);
  }

  PatchProblem problem;
  PatchWork work;

 private:
  template <class Of>
  double sum(const Of& of) {
    double total = 0.0;
    for (std::uint32_t cell = 0; cell < kSide * kSide; ++cell) {
      total += of(cell) * cell_ * cell_;
    }
    return total;
  }

  double poisson_;
  double cell_ = 0.0;
  std::vector<double> values_;
  std::vector<double> columns_[11];
};

TEST(PatchSolverTest, SolutionMeetsTheLawsOfContactAndOfCoulomb) {
  struct Case {
    double poisson, friction;
  };
  // The last three: solved in turn, pressures and tractions would come no nearer to each other from
  // where (1 - 2 nu) / (2 (1 - nu)) times the friction is 1.
  for (const auto& [poisson, friction] : {Case{0.5, kFriction}, Case{0.3, kFriction},
                                          Case{0.0, 2.0}, Case{0.3, 8.0}, Case{0.0, 9.0}}) {
    SCOPED_TRACE(friction);
    Grid grid(poisson, poisson < 0.5, friction);
    grid.problem.iterations = 40;
    grid.move(0.0, 0.0);
    const double way = friction / kFriction;
    const PatchOutcome outcome = grid.move(8e-5 * way, 0.02 * way);
    EXPECT_LE(outcome.last_change, grid.problem.skip);
    EXPECT_LE(outcome.residual, 1e-6);  // as way_error below
    const PatchColumns columns = grid.view();
    int stuck = 0;
    int slipping = 0;
    // The residual of a Gauss-Seidel iteration is one cell's change; the sum of what is still to
    // come is some hundred times as much.
    const double traction_error = 1e-6 * grid.problem.reference;
    const double way_error = 1e-6 * kDepth;
    for (std::uint32_t cell = 0; cell < kSide * kSide; ++cell) {
      const double limit = friction * columns.pressure[cell];
      const double size = std::hypot(columns.traction_x[cell], columns.traction_y[cell]);
      const double gap = columns.depression[cell] - columns.depth[cell];
      ASSERT_GE(columns.pressure[cell], 0.0);
      ASSERT_GE(gap, -way_error);  // nothing overlaps
      ASSERT_LE(size, limit + traction_error);
      if (columns.pressure[cell] == 0.0) {
        ASSERT_EQ(size, 0.0);
        continue;
      }
      ASSERT_NEAR(gap, 0.0, way_error);
      const double slip_x = columns.target_x[cell] - columns.moved_x[cell];
      const double slip_y = columns.target_y[cell] - columns.moved_y[cell];
      if (columns.slips[cell] == 0.0) {
        ++stuck;
        ASSERT_LE(std::hypot(slip_x, slip_y), way_error);
      } else {
        ++slipping;
        ASSERT_NEAR(size, limit, traction_error);
        // The surface is dragged the way that the tool is ahead of it.
        ASSERT_NEAR(slip_x * columns.traction_x[cell] + slip_y * columns.traction_y[cell],
                    std::hypot(slip_x, slip_y) * size, way_error * limit);
      }
    }
    EXPECT_GT(stuck, 20);
    EXPECT_GT(slipping, 20);
  }
}

/// A flat strip that is dragged across its length, sixteen times as long as wide.
class DraggedStrip {
 public:
  /// @param feedback  friction times (1 - 2 nu) / (2 (1 - nu)), here of nu = 0
  explicit DraggedStrip(double feedback) : values_(influence_count(kSide)) {
    fill_influences(0.0, kSide, values_);
    for (std::vector<double>& column : columns_) {
      column.assign(kSide * kSide, 0.0);
    }
    work_.reserve(kSide);
    std::ranges::fill(view().depth, kDepth);
    std::ranges::fill(view().friction, 2.0 * feedback);
    std::ranges::fill(view().target_x, 1e3 * kDepth);
    PatchProblem problem;
    problem.influences = influence_tables(values_, kSide, -kMostAspect);
    problem.compliance = 1e-3 / kShearModulus;
    problem.coupled = true;
    problem.feedback = feedback;
    problem.reference = 1e5;
    problem.settled = 0.0;
    problem.rounds = 200;
    problem.iterations = 100;
    outcome = solve_patch(problem, view(), work_);
  }
  PatchColumns view() {
    return {columns_[0], columns_[1], columns_[2], columns_[3], columns_[4], columns_[5],
            columns_[6], columns_[7], columns_[8], columns_[9], columns_[10]};
  }
  /// Where the middle rows' pressure is centred, of half the width ahead of the middle.
  double centre() {
    double sum = 0.0;
    double moment = 0.0;
    for (std::uint32_t i = 0; i < kSide; ++i) {
      const double pressure = view().pressure[(kSide / 2) * kSide + i];
      sum += pressure;
      moment += pressure * ((2.0 * i + 1.0) / kSide - 1.0);
    }
    return moment / sum;
  }

  PatchOutcome outcome;

 private:
  std::vector<double> values_;
  std::vector<double> columns_[11];
  PatchWork work_;
};

// A punch dragged in plane strain has p ~ (a + x)^(-1/2 - g) (a - x)^(-1/2 + g), tan(pi g) = mu
// beta (Johnson, Contact Mechanics, 1985, 2.8(b)): its centre is 2 g a behind the middle. A cell at
// a rim has its pressure in its middle, not where it is largest: half a cell, 1 / 24 of a. At mu
// beta = 4 the rim's cells hold more than half of the load, and where in them decides.
TEST(PatchSolverTest, ADraggedStripLeansOnItsEdgeAsThePlanePunch) {
  for (const double feedback : {0.1, 0.5, 1.0, 2.0, 4.0}) {
    DraggedStrip strip(feedback);
    EXPECT_LE(strip.outcome.residual, 1e-8) << feedback;
    if (feedback < 3.0) {
      const double lean = 2.0 * std::atan(feedback) / std::numbers::pi;
      EXPECT_NEAR(-strip.centre(), lean, 1.0 / kSide) << feedback;
    }
  }
}

// The gap and overlap that is left over the depth, and how far a cell would have to go to have the
// friction that its slip asks for over friction times depth: found here cell by
// cell.
TEST(PatchSolverTest, TheResidualIsWhatIsLeftOfTheEquations) {
  double before = 1e300;
  for (const std::uint32_t iterations : {1U, 2U, 4U, 30U}) {
    Grid grid(0.5, false);
    grid.problem.rounds = 1;
    grid.problem.iterations = iterations;
    const PatchOutcome outcome = grid.move(8e-5, 0.02);
    const PatchColumns columns = grid.view();
    const InfluenceTables& tables = grid.problem.influences;
    const double softest =
        std::max(tables.self(InfluenceKind::kXX), tables.self(InfluenceKind::kYY));
    const double stiffness = 1.0 / (softest * grid.problem.compliance);
    double gaps = 0.0;
    double lacking = 0.0;
    double depths = 0.0;
    double slips = 0.0;
    for (std::uint32_t cell = 0; cell < kSide * kSide; ++cell) {
      const double overlap = columns.depth[cell] - columns.depression[cell];
      const bool loaded = columns.pressure[cell] > 0.0;
      gaps += loaded || overlap > 0.0 ? overlap * overlap : 0.0;
      depths += std::pow(std::max(columns.depth[cell], 0.0), 2);
      slips += loaded ? std::pow(kFriction * columns.depth[cell], 2) : 0.0;
      const double limit = kFriction * columns.pressure[cell];
      const double preconditioned_x =
          columns.traction_x[cell] + stiffness * (columns.target_x[cell] - columns.moved_x[cell]);
      const double preconditioned_y =
          columns.traction_y[cell] + stiffness * (columns.target_y[cell] - columns.moved_y[cell]);
      double x = preconditioned_x;
      double y = preconditioned_y;
      if (std::hypot(x, y) > limit) {
        const double angle = std::atan2(preconditioned_y, preconditioned_x);
        x = limit * std::cos(angle);
        y = limit * std::sin(angle);
      }
      lacking += std::pow((columns.traction_x[cell] - x) / stiffness, 2) +
                 std::pow((columns.traction_y[cell] - y) / stiffness, 2);
    }
    const double expected = std::sqrt(std::max(gaps / depths, lacking / slips));
    EXPECT_NEAR(outcome.residual, expected, 1e-9 * expected + 1e-14) << iterations;
    EXPECT_LT(outcome.residual, before) << iterations;
    before = outcome.residual;
  }
}

// Influences with the wrong sign have no solution: to end is no success.
TEST(PatchSolverTest, ABreakdownHasALargeResidual) {
  Grid grid(0.5, false);
  grid.problem.compliance *= -1.0;
  EXPECT_GT(grid.move(0.0, 0.0).residual, 0.9);
}

TEST(PatchSolverTest, DisplacementsAreThoseOfTheTractions) {
  Grid grid(0.3, true);
  grid.move(0.0, 0.0);
  for (int step = 0; step < 30; ++step) {
    grid.move(5e-6, -2e-3);
  }
  const PatchColumns columns = grid.view();
  const std::vector<double> depression(columns.depression.begin(), columns.depression.end());
  const std::vector<double> moved(columns.moved_x.begin(), columns.moved_x.end());
  displace_patch(grid.problem, columns, grid.work);
  for (std::size_t cell = 0; cell < depression.size(); ++cell) {
    // Sums of thousands of changes: rounding only.
    ASSERT_NEAR(columns.depression[cell], depression[cell], 1e-11 * kDepth);
    ASSERT_NEAR(columns.moved_x[cell], moved[cell], 1e-11 * kDepth);
  }
}

TEST(PatchSolverTest, UnloadingEveryCellLeavesNothing) {
  Grid grid(0.3, true);
  grid.move(0.0, 0.0);
  grid.move(8e-5, 0.02);
  const PatchColumns columns = grid.view();
  release_cells(grid.problem, columns, grid.work, kDepth);
  for (std::uint32_t cell = 0; cell < kSide * kSide; ++cell) {
    ASSERT_EQ(columns.pressure[cell], 0.0);
    ASSERT_NEAR(columns.depression[cell], 0.0, 1e-11 * kDepth);
    ASSERT_NEAR(columns.moved_x[cell], 0.0, 1e-11 * kDepth);
    ASSERT_NEAR(columns.moved_y[cell], 0.0, 1e-11 * kDepth);
  }
}

TEST(PatchSolverTest, WithoutCouplingEveryPoissonRatioTwistsAsLubkinAndSlidesAsMindlin) {
  // Pressure and friction decouple exactly for nu = 0.5 only; with the coupling left out they do
  // for all, and the exact solutions hold. 18 cells across: the staircase of the rim makes 0.5 %.
  // Mindlin leaves out the slip across the force, 0.2 % at nu = 0.5.
  for (const double poisson : {0.0, 0.3, 0.45, 0.5}) {
    Grid twisted(poisson, false);
    twisted.problem.skip = 1e-6;
    twisted.move(0.0, 0.0);
    const reference::HertzSphere sphere = twisted.hertz();
    EXPECT_NEAR(twisted.force() / sphere.force, 1.0, 0.003) << poisson;
    const reference::LubkinContact lubkin{reference::PressureShape::kHertz, sphere.force, kFriction,
                                          sphere.radius, kShearModulus};
    const double largest = reference::saturated_torque(lubkin);
    const double turn = largest / reference::torsional_stiffness(lubkin) / 15.0;
    for (int step = 1; step <= 60; ++step) {
      twisted.move(0.0, turn);
      EXPECT_NEAR(twisted.couple(), reference::torque(lubkin, step * turn), 0.006 * largest)
          << poisson << " " << step;
    }
    Grid pushed(poisson, false);
    pushed.problem.skip = 1e-6;
    pushed.move(0.0, 0.0);
    const reference::CattaneoMindlin mindlin{sphere.force, kFriction, sphere.radius,
                                             4.0 * kShearModulus / (2.0 - poisson)};
    const double slide = reference::full_slip_displacement(mindlin) / 20.0;
    for (int step = 1; step <= 25; ++step) {
      pushed.move(slide, 0.0);
      EXPECT_NEAR(pushed.pull(), reference::tangential_force(mindlin, step * slide),
                  0.008 * reference::full_slip_force(mindlin))
          << poisson << " " << step;
    }
  }
}

TEST(PatchSolverTest, WithoutFrictionNothingPulls) {
  Grid grid(0.5, false);
  grid.move(0.0, 0.0);
  grid.move(8e-5, 0.02);
  EXPECT_GT(grid.couple(), 0.0);
  for (double& friction : grid.view().friction) {
    friction = 0.0;
  }
  grid.move(8e-5, 0.02);
  EXPECT_EQ(grid.couple(), 0.0);
  EXPECT_EQ(grid.pull(), 0.0);
}

TEST(PatchSolverTest, NoOverlapGivesNothing) {
  Grid grid(0.3, true);
  for (double& depth : grid.view().depth) {
    depth = -1e30;
  }
  EXPECT_EQ(grid.move(1e-4, 0.1).iterations, 0U);
  EXPECT_EQ(grid.force(), 0.0);
}

}  // namespace
}  // namespace torsion::engine
