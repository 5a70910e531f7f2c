#include "app/run_statistics.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

TEST(HistogramTest, QuantilesAreRightWithinABin) {
  Histogram histogram(kShortestTime);
  for (int i = 1; i <= 1000; ++i) {
    histogram.add(static_cast<double>(i));  // us
  }
  // A bin is a factor of sqrt(2) wide, and times are taken as even within it.
  EXPECT_NEAR(histogram.quantile(0.5), 500.0, 0.05 * 500.0);
  EXPECT_NEAR(histogram.quantile(0.99), 990.0, 0.05 * 990.0);
  EXPECT_EQ(histogram.quantile(1.0), 1000.0);
  EXPECT_EQ(histogram.largest(), 1000.0);
  EXPECT_EQ(histogram.count(), 1000U);
}

TEST(HistogramTest, TakesAnyTime) {
  Histogram histogram(kShortestTime);
  histogram.add(0.0);
  histogram.add(1e12);
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_LE(histogram.quantile(0.25), 0.2);
  EXPECT_FALSE(histogram.text().empty());
}

TEST(HistogramTest, TakesWhatIsNoNumberAndWhatIsEndless) {
  Histogram histogram(kLeastResidual);
  histogram.add(std::numeric_limits<double>::quiet_NaN());
  histogram.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_EQ(histogram.bins().size(), 2U);
}

/// Two bodies, of which only the first has contact model patch, with two regions on it and one on
/// the other.
World world_with_patches() {
  World world;
  Capacities capacities;
  capacities.bodies = 2;
  capacities.regions = 3;
  capacities.patch_bodies = 1;
  world.model.reserve(capacities, Settings{});
  world.state.reserve(capacities, Settings{});
  world.model.bodies.append(2);
  world.model.bodies.at<BodyModels>(0).contact = ContactModel::kPatch;
  world.model.bodies.at<BodyModels>(1).contact = ContactModel::kMdr;
  world.state.regions.append(3);
  world.state.regions.at<RegionIdentity>(1).body = 1;
  return world;
}

TEST(RunStatisticsTest, ResidualsAndSweepsAreThoseOfRegionsWithPatch) {
  World world = world_with_patches();
  world.state.regions.at<PatchState>(1) = {.residual = 9.0,
                                           .iterations = 90};  // means nothing there
  RunStatistics statistics;
  // Residuals 0.001 to 0.1 evenly, iterations 1 in the one region, 2 in the other and once 12.
  for (int i = 1; i <= 100; ++i) {
    world.state.regions.at<PatchState>(0) = {.residual = 1e-3 * i, .iterations = 1};
    world.state.regions.at<PatchState>(2) = {.residual = 1e-3 * i,
                                             .iterations = i == 50 ? 12U : 2U};
    statistics.add_step(world, 1.0);
  }
  EXPECT_EQ(statistics.patch.region_steps(), 200U);
  EXPECT_EQ(statistics.patch.most_iterations, 12U);
  EXPECT_DOUBLE_EQ(statistics.patch.mean_iterations(), (100.0 + 99.0 * 2.0 + 12.0) / 200.0);
  EXPECT_DOUBLE_EQ(statistics.patch.residuals.largest(), 0.1);
  // Even within a bin, as they are but for their coarseness of a hundredth.
  EXPECT_NEAR(statistics.patch.residuals.quantile(0.5), 0.05, 0.05 * 0.05);
}

TEST(RunStatisticsTest, OtherModelsHaveNoResiduals) {
  World world = world_with_patches();
  world.model.bodies.at<BodyModels>(0).contact = ContactModel::kPaper;
  RunStatistics statistics;
  statistics.add_step(world, 1.0);
  EXPECT_EQ(statistics.patch.region_steps(), 0U);
}

TEST(RunStatisticsTest, StrainIsOfTractionAndTilt) {
  World world = world_with_patches();
  for (Elasticity& elasticity : world.model.bodies.column<Elasticity>()) {
    elasticity = {.youngs_modulus = 7.5e3, .poisson_ratio = 0.5};  // E* = 10 kPa
  }
  RunStatistics statistics;
  statistics.add_step(world, 1.0);
  EXPECT_EQ(statistics.strain.most_traction, 0.0) << "without area there is no traction";
  world.state.regions.at<Contact>(0).area = 1e-4;
  world.state.regions.at<RegionNormal>(0).force = 0.03;
  world.state.regions.at<RegionFriction>(0).force = {0.0, -0.04};
  // A turn about the normal tilts nothing.
  world.state.regions.at<RegionFrame>(1) = {};
  world.state.regions.at<RegionSupport>(1).rotation = {0.06, 0.08, 5.0};
  statistics.add_step(world, 1.0);
  EXPECT_NEAR(statistics.strain.most_traction, 0.05 / 1e-4 / 1e4, 1e-15);
  EXPECT_NEAR(statistics.strain.most_tilt, 0.1, 1e-15);
  EXPECT_EQ(statistics.strain.large_share(), 0.0);
  world.state.regions.at<RegionNormal>(0).force = 0.3;
  statistics.add_step(world, 1.0);
  world.state.regions.at<RegionSupport>(2).rotation = {0.4, 0.0, 0.0};
  world.state.regions.at<RegionFrame>(2) = {};
  statistics.add_step(world, 1.0);
  EXPECT_DOUBLE_EQ(statistics.strain.large_share(), 3.0 / 12.0) << "of three regions in four steps";
}

}  // namespace
}  // namespace torsion::engine
