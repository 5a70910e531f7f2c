// Blades that turn by 90 degrees: their grids are laid anew along them again and again, and the
// torque must not tell when.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "app/session.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine::test {
namespace {

constexpr std::uint32_t kAutoSide = 20;  // choose_models_test.cpp

struct Errors {
  double worst = 0.0;  // over the largest torque
  double mean = 0.0;   // likewise, over the steps
  double step = 0.0;   // the largest change in a step, likewise
};

Errors errors_of(const std::vector<double>& found, const std::vector<double>& fine) {
  EXPECT_EQ(found.size(), fine.size());
  Errors errors;
  double most = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double error = std::abs(found[i] - fine[i]);
    most = std::max(most, std::abs(fine[i]));
    errors.worst = std::max(errors.worst, error);
    errors.mean += error / static_cast<double>(found.size());
    errors.step = std::max(errors.step, i > 0 ? std::abs(found[i] - found[i - 1]) : 0.0);
  }
  return {errors.worst / most, errors.mean / most, errors.step / most};
}

/// The torque about the axis of a screwdriver's blade, 8 mm by 1.2 mm on gel, in each step, N m.
/// @param side  cells along a side of the grids; 0: as `auto` has it
std::vector<double> screwdriver(std::uint32_t side) {
  PrepareOptions options;
  options.settings.grid_side = side;
  Result<Session> opened =
      open_session(source_folder() + "/tests/cases/driver2.glb", options, true);
  EXPECT_TRUE(opened) << opened.error().text;
  Session& session = opened.value();
  std::vector<double> torques;
  const std::uint64_t steps = steps_in(session, session.scene.duration);
  for (std::uint64_t i = 0; i < steps; ++i) {
    step_scripted(session);
    torques.push_back(session.simulation.world.state.tools.at<ToolWrench>(0).total.torque.y);
  }
  return torques;
}

/// That of a box 12 mm long that lies askew to the grid it begins with, pressed half a millimetre
/// into a half-space and turned by 90 degrees in two seconds.
std::vector<double> box(double width, std::uint32_t side, std::uint32_t iterations) {
  const glm::dvec3 up(0.0, 1.0, 0.0);
  SceneDescription scene = ball_on_cube();
  scene.bodies[0].elasticity.youngs_modulus = 5e4;
  scene.bodies[0].elasticity.poisson_ratio = 0.48;
  scene.bodies[0].friction = {0.9, 0.9};
  scene.bodies[0].models.contact = ContactModel::kPatch;
  scene.bodies[0].models.body = BodyModel::kNone;
  scene.tools[0] = make_tool({make_part(ShapeKind::kBox, {0.006, 0.005, 0.5 * width})});
  PrepareOptions options;
  options.settings = {side, iterations};
  Hand hand(scene, options);
  hand.step_to({{glm::dvec3(0.0, 0.1051, 0.0), glm::angleAxis(0.3, up)}});
  hand.move({0.0, -6e-4, 0.0}, up, 0.0, 400);
  std::vector<double> torques;
  for (int i = 0; i < 2000; ++i) {
    hand.move(glm::dvec3(0.0), up, 0.5 * std::numbers::pi / 2000.0, 1);
    torques.push_back(hand.wrench().torque.y);
  }
  return torques;
}

TEST(LongContactTest, ATurningScrewdriverKeepsItsTorque) {
  // The next test has contacts of its kind, against a reference of fewer cells.
  if (test::is_left_out(false)) {
    GTEST_SKIP() << test::kLeftOut;
  }
  // A contact's rim is where its face's is, to a tenth of a cell on either side (the stiffness
  // against turning is a third power of the length: rim_stiffness_test.cpp): with 16 cells along
  // the blade 4 %. What comes in under a leading edge takes about a cell's length to come to the
  // limit, of which the fine grid's cells are half: 3 % more while it slides. When a grid is laid
  // anew hangs on rounding: with friction changed in its seventh digit six runs were worst by 3.8
  // to 4.6 % and .8 to .9 % on average, against 2500 cells by 4.9 to 5.7 % and 1.4 %. (Where cells
  // counted as wholes it was 9 to 21 %.) What a grid that is laid anew changes fades in by a
  // twentieth a step at most, and friction goes on changing meanwhile.
  const std::vector<double> fine = screwdriver(36);
  const Errors errors = errors_of(screwdriver(0), fine);
  EXPECT_LE(errors.worst, 0.07);  // what `auto` says
  EXPECT_LE(errors.mean, 0.02);
  EXPECT_LE(errors.step, 0.05);
  EXPECT_LE(errors_of(fine, fine).step, 0.05);
}

/// What the blade of scenes/looks feels in each step while it is turned about its axis.
/// @param side  as in screwdriver()
std::vector<Wrench> blade_on_gel(std::uint32_t side) {
  PrepareOptions options;
  options.settings.grid_side = side;
  Result<Session> opened =
      open_session(source_folder() + "/scenes/looks/screwdriver_on_gel.gltf", options, true);
  EXPECT_TRUE(opened) << opened.error().text;
  Session& session = opened.value();
  std::vector<Wrench> wrenches;
  const std::uint64_t steps = steps_in(session, 2.2);
  for (std::uint64_t i = 0; i < steps; ++i) {
    step_scripted(session);
    wrenches.push_back(session.simulation.world.state.tools.at<ToolWrench>(0).total);
  }
  return wrenches;
}

// Turned by half a turn all is the same, so that what is felt is along the axis, and what is felt
// across it is the solver's error alone. With two iterations for friction it was 0.8 % of the
// force, and on 2500 cells 5 %, a third of the torque missing: errors grew from step to step.
TEST(LongContactTest, ABladeThatTurnsAboutItsAxisIsNotPushedSideways) {
  std::vector<double> ends;
  for (const std::uint32_t side : {0U, 50U}) {
    double sideways = 0.0;
    double force = 0.0;
    for (const Wrench& wrench : blade_on_gel(side)) {
      sideways = std::max(sideways, std::hypot(wrench.force.x, wrench.force.z));
      force = std::max(force, std::abs(wrench.force.y));
      ends.resize(side == 0 ? 1 : 2);
      ends.back() = wrench.torque.y;
    }
    EXPECT_GT(force, 0.2);
    EXPECT_LE(sideways, 1e-3 * force) << side << " cells along a side";
  }
  EXPECT_NEAR(ends[0], ends[1], 0.07 * std::abs(ends[1]));  // what `auto` says
}

// What `auto` says of them: 7 %, and 9 % of one that is more than 8 times as long as wide.
TEST(LongContactTest, TurningBoxesAreAsAutoSays) {
  struct Case {
    double width;  // m
    double worst;
  };
  const std::vector<Case> cases{{2e-3, 0.07}, {4e-3, 0.07}, {0.8e-3, 0.09}};
  for (const Case& each : std::span(cases).first(all_cases() ? cases.size() : 1)) {
    const Errors errors = errors_of(box(each.width, kAutoSide, 2), box(each.width, 43, 8));
    EXPECT_LE(errors.worst, each.worst) << each.width;
    EXPECT_LE(errors.mean, 0.5 * each.worst) << each.width;
    EXPECT_LE(errors.step, 0.05) << each.width;
  }
}

}  // namespace
}  // namespace torsion::engine::test
