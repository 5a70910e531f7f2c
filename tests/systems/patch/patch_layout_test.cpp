#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "systems/contact/region_grid.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/patch/grid.hpp"

namespace torsion::engine {
namespace {

TEST(SecondMomentsTest, ARectanglesAreThoseOfItsSides) {
  const double length = 8.0;
  const double width = 1.2;
  for (const double angle : {-1.4, -0.3, 0.0, 0.05, 0.8, 1.5}) {
    // Its own axes' moments, L^2 / 12 and w^2 / 12, turned.
    const double along = length * length / 12.0;
    const double across = width * width / 12.0;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const SecondMoments turned{along * c * c + across * s * s, (along - across) * c * s,
                               along * s * s + across * c * c};
    EXPECT_NEAR(turned.width_over_length(), width / length, 1e-12);
    EXPECT_NEAR(turned.angle(), angle, 1e-12);
  }
}

/// Where a rim lies, in cells from the grid's corner.
double rim_in_cells(double rim, double shift, double half_size, std::uint32_t side) {
  return ((rim - shift) / half_size + 1.0) * 0.5 * static_cast<double>(side);
}

TEST(PatchLayoutTest, StraightRimsRunBetweenCells) {
  for (const std::uint32_t side : {12U, 15U, 16U, 20U, 36U, 50U}) {
    for (const double length : {1.0, 2.4, 6.67, 15.0}) {
      for (const bool turned : {false, true}) {
        const glm::dvec2 size = turned ? glm::dvec2(1e-3, 1e-3 * length) : glm::dvec2(length, 1.0);
        const glm::dvec2 lowest = glm::dvec2(0.3, -0.7) * size;
        const GridLayout layout = layout_between_rims({lowest, lowest + size}, true, true, side);
        const double aspect = std::log2(layout.half_size.x / layout.half_size.y);
        EXPECT_NEAR(aspect, std::round(aspect), 1e-9);
        EXPECT_LE(std::abs(aspect), kMostAspect);
        const auto rim = [&](const glm::dvec2& at, int axis) {
          return rim_in_cells(at[axis], layout.shift[axis], layout.half_size[axis], side);
        };
        // Along x they do to rounding. The cells' shapes are doublings, so along y they cannot
        // always: but never farther off than half a cell for both together.
        EXPECT_NEAR(rim(lowest, 0), std::round(rim(lowest, 0)), 1e-9);
        EXPECT_NEAR(rim(lowest + size, 0), std::round(rim(lowest + size, 0)), 1e-9);
        EXPECT_NEAR(rim(lowest, 1), std::round(rim(lowest, 1)), 0.25 + 1e-9);
        for (int axis = 0; axis < 2; ++axis) {
          EXPECT_GE(rim(lowest, axis), 1.0) << side << " " << length;
          EXPECT_LE(rim(lowest + size, axis), static_cast<double>(side) - 1.0);
        }
      }
    }
  }
}

TEST(PatchLayoutTest, ASliverFitsItsGrid) {
  for (const glm::dvec2& size : {glm::dvec2(1.0, 0.01), glm::dvec2(0.01, 1.0)}) {
    const GridLayout layout = layout_between_rims({-0.5 * size, 0.5 * size}, true, true, 16);
    for (int axis = 0; axis < 2; ++axis) {
      const double half = 0.5 * size[axis];
      EXPECT_GE(rim_in_cells(-half, layout.shift[axis], layout.half_size[axis], 16), 1.0);
      EXPECT_LE(rim_in_cells(half, layout.shift[axis], layout.half_size[axis], 16), 15.0);
    }
    EXPECT_LE(layout.half_size.x, 1.0);
    EXPECT_LE(layout.half_size.y, 1.0);
  }
}

TEST(PatchLayoutTest, ARimThatIsNotSharpGetsWhatItNeeds) {
  // A roller: sharp at its ends, and its pressure ends where it will.
  const glm::dvec2 size(0.01, 0.0013);
  const GridLayout layout = layout_between_rims({-0.5 * size, 0.5 * size}, true, false, 20);
  EXPECT_GE(2.0 * layout.half_size.y * fill_of_new(20), size.y);
  const double first = rim_in_cells(-0.5 * size.x, layout.shift.x, layout.half_size.x, 20);
  EXPECT_NEAR(first, std::round(first), 1e-9);
}

}  // namespace
}  // namespace torsion::engine
