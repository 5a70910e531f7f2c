#include "systems/patch/disc_projection.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "systems/math/wide_lanes.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kAcross = 7;
constexpr std::size_t kDiscs = std::size_t{kAcross} * kAcross;

/// Cells, discs and trials of all kinds: inside, far outside, without a disc.
struct Problem {
  DiscColumns columns;
  std::vector<double> limit;
  BodyInBalance body;

  /// @param yields  a motion of 1 by such a load: 1 is about as soft as the cells together
  /// @param rank    of the body's compliance: it yields along so many motions
  Problem(unsigned seed, double yields, int rank) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const std::size_t count = whole_lanes(kDiscs);
    columns.reserve(count);
    limit.assign(count, 0.0);
    for (std::size_t k = 0; k < kDiscs; ++k) {
      columns.place_x[k] = static_cast<double>(k % kAcross) - 3.0;
      columns.place_y[k] = 0.7 * (static_cast<double>(k / kAcross) - 3.0);
      columns.stiffness[k] = 1.5 + uniform(random);
      columns.trial_x[k] = 3.0 * uniform(random);
      columns.trial_y[k] = 3.0 * uniform(random) + 1.0;
      limit[k] = std::max(uniform(random) + 0.7, 0.0);
    }
    glm::dmat3 root(0.0);
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < rank; ++row) {
        root[column][row] = uniform(random) + (row == column ? 1.0 : 0.0);
      }
    }
    body.yields = yields / static_cast<double>(kDiscs) * (glm::transpose(root) * root);
    body.before = {uniform(random), uniform(random), uniform(random)};
    // As from the step before it: of a motion about as far as the trials go.
    body.known =
        1.0 / (1.0 + yields) * SurfaceLoad(uniform(random), uniform(random), uniform(random));
  }
};

// What must hold at the least of a convex function over the discs, from its definition: the body
// moves by the load, inside of a disc the cell's spring has what it asks for, on a rim it only
// pulls outwards.
TEST(DiscProjectionTest, BodyMovesByTheLoadAndEveryCellIsAtItsLeast) {
  for (const double yields : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (unsigned seed = 0; seed < 60; ++seed) {
      Problem problem(seed, yields, 1 + static_cast<int>(seed % 3));
      DiscColumns& columns = problem.columns;
      const BodyInBalance& body = problem.body;
      const BodyAnswer answer = project_in_balance(body, problem.limit.data(), columns);
      const SurfaceMotion& motion = answer.motion;
      glm::dvec3 load(0.0);
      for (std::size_t k = 0; k < kDiscs; ++k) {
        const glm::dvec2 result(columns.result_x[k], columns.result_y[k]);
        const glm::dvec2 moved(motion.x - motion.z * columns.place_y[k],
                               motion.y + motion.z * columns.place_x[k]);
        const glm::dvec2 left = glm::dvec2(columns.trial_x[k], columns.trial_y[k]) -
                                columns.stiffness[k] * moved - result;
        load += glm::dvec3(result, columns.place_x[k] * result.y - columns.place_y[k] * result.x);
        const double size = glm::length(result);
        const double scale = 10.0 + glm::length(columns.stiffness[k] * moved);
        EXPECT_LE(size, problem.limit[k] * (1.0 + 1e-14));
        if (size < problem.limit[k] * (1.0 - 1e-12)) {
          EXPECT_LT(glm::length(left), 1e-13 * scale) << yields << " " << seed << " " << k;
        } else if (problem.limit[k] > 0.0) {
          const glm::dvec2 out = result / size;
          EXPECT_GE(glm::dot(left, out), -1e-13 * scale);
          EXPECT_LT(std::abs(left.x * out.y - left.y * out.x), 1e-13 * scale);
        }
      }
      const SurfaceMotion by_load = body.yields * (load - body.before);
      const SurfaceMotion lacking = body.yields * body.known + motion - by_load;
      // The search ends at 1e-6 of what friction moves a cell by, and at rounding.
      EXPECT_LT(glm::length(lacking), 1e-5 + 1e-13 * glm::length(by_load)) << yields << " " << seed;
      EXPECT_LT(glm::length(answer.load - (load - body.before)), 1e-12 * kDiscs);
    }
  }
}

}  // namespace
}  // namespace torsion::engine
