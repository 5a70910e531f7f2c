#include "systems/contact/support/contact_load.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/contact/support/support_fit.hpp"
#include "systems/math/frames.hpp"
#include "tests/support/contact_scenes.hpp"

namespace torsion::engine {
namespace {

/// A ball pressed into a cube and turned, by cells.
test::Hand pressed_and_turned() {
  SceneDescription scene = test::ball_on_cube();
  scene.bodies[0].models = {ContactModel::kPatch, BodyModel::kCompliance};
  test::Hand hand(scene);
  hand.step_to({{glm::dvec3(0.01, 0.1501, 0.0), glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  hand.move(glm::dvec3(0.0, -1e-3, 0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0, 50);
  hand.move(glm::dvec3(2e-4, 0.0, 1e-4), glm::dvec3(0.1, 1.0, 0.0), 0.05, 50);
  return hand;
}

// Cell by cell, in the body's axes, as the moments are defined; rounding alone is between them.
TEST(ContactLoadTest, MomentsAreTheSumsOverTheCells) {
  const test::Hand hand = pressed_and_turned();
  const World& world = hand.world();
  ASSERT_EQ(world.state.regions.size(), 1U);
  const RegionFrame& frame = world.state.regions.at<RegionFrame>(0);
  const Range rows = world.state.regions.at<RegionIdentity>(0).cells;
  const auto tractions = world.state.cells.rows<CellTraction>(rows);
  const std::uint32_t side = world.model.settings.grid_side;
  const SupportFit& support_fit = world.state.support_fits.at<SupportFit>(rows.first / rows.count);
  SupportMoments moments{};
  glm::dvec3 couple(0.0);
  double friction = 0.0;
  for (std::uint32_t cell = 0; cell < tractions.size(); ++cell) {
    if (tractions[cell].pressure <= 0.0) {
      continue;
    }
    const glm::dvec2 place = cell_center(frame, side, cell % side, cell / side);
    const glm::dvec3 point = grid_to_body(frame, {place, 0.0});
    const glm::dvec3 force =
        -cell_area(frame, side) * (frame.normal * tractions[cell].pressure +
                                   tangent_to_body(frame, tractions[cell].traction));
    const auto terms = support_terms(coordinates_in(support_fit, point));
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      moments[k] += terms[k] * force;
    }
    couple += glm::cross(point - support_fit.center, force);
    friction += glm::length(tractions[cell].traction);
  }
  ASSERT_GT(friction, 0.0);
  const ContactLoad load = contact_load(world.model, world.state, 0, support_fit);
  const double force = glm::length(moments[0]);
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    EXPECT_LT(glm::distance(load.moments[k], moments[k]), 1e-12 * force) << k;
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(load.wrench[axis], moments[0][axis], 1e-12 * force);
    EXPECT_NEAR(load.wrench[3 + axis], couple[axis], 1e-12 * force * 0.1);
  }
}

}  // namespace
}  // namespace torsion::engine
