// What a fit finds in data whose truth is known: from finite elements, from exact solutions, from
// the model itself with noise; and what it says where data leave something open.

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "app/fit/fit_scene.hpp"
#include "app/report/element_curve.hpp"
#include "app/report/element_scenes.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

constexpr double kStep = 1e-3;  // s
constexpr glm::dvec3 kUp(0.0, 1.0, 0.0);

ElementScene scene_named(const std::string& name) {
  std::vector<ElementScene> scenes = element_scenes();
  return *std::ranges::find(scenes, name, &ElementScene::name);
}

/// A measurement of the tool pressed along -y and turned about y, row by row.
class PressAndTurn {
 public:
  explicit PressAndTurn(const Pose& touching) : touching_(touching) {
    measurement_.motions.resize(1);
    measurement_.quantities = {{"force_y_N", 0, 1, {}}, {"torque_y_Nm", 0, 4, {}}};
  }
  /// @param torque  about y, on the tool
  void add(double seconds, double depth, double turn, double force, double torque) {
    time_ += seconds;
    measurement_.times.push_back(time_);
    measurement_.motions[0].positions.push_back(touching_.position - depth * kUp);
    measurement_.motions[0].rotations.push_back(glm::angleAxis(turn, kUp) * touching_.rotation);
    measurement_.quantities[0].values.push_back(force);
    measurement_.quantities[1].values.push_back(torque);
  }
  [[nodiscard]] const Measurement& measurement() const { return measurement_; }

 private:
  Pose touching_;
  Measurement measurement_;
  double time_ = 0.0;
};

/// Normal noise on forces and torques, of a share of the largest of each.
/// @param memory  correlation of a row's noise with that of the row before
void add_noise(Measurement& measurement, double share, unsigned seed, double memory = 0.0) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (MeasuredQuantity& quantity : measurement.quantities) {
    double largest = 0.0;
    for (const double value : quantity.values) {
      largest = std::max(largest, std::abs(value));
    }
    double noise = normal(random);
    for (double& value : quantity.values) {
      value += share * largest * noise;
      noise = memory * noise + std::sqrt(1.0 - memory * memory) * normal(random);
    }
  }
}

FitProblem problem_of(SceneDescription scene, Measurement measurement,
                      const std::vector<std::string>& free, ContactModel contact, BodyModel body) {
  PrepareOptions options;
  options.contact_model = contact;
  options.body_model = body;
  auto parameters = read_parameters(free, scene);
  EXPECT_TRUE(parameters) << parameters.error().text;
  auto problem = make_fit_problem(std::move(scene), options, std::move(measurement),
                                  std::move(parameters).value());
  EXPECT_TRUE(problem) << problem.error().text;
  problem.value().jobs = 2;
  return std::move(problem).value();
}

FitResult fitted(const FitProblem& problem) {
  Result<FitResult> result = fit_scene(problem);
  EXPECT_TRUE(result) << result.error().text;
  return std::move(result).value();
}

bool warns_of(const FitResult& result, const std::string& words) {
  return std::ranges::any_of(result.warnings, [&](const std::string& warning) {
    return warning.find(words) != std::string::npos;
  });
}

/// What finite elements say of a ball on a cube, with noise: E = 3 MPa, mu = 0.75.
Measurement element_measurement(const ElementScene& scene, double noise, unsigned seed) {
  PressAndTurn made(scene.touching);
  made.add(0.0, -2e-5, 0.0, 0.0, 0.0);
  for (const ElementCurve::Row& row : finest_curve(scene.name).rows) {
    made.add(6 * kStep, row.depth, row.turn, row.force, -row.torque);
  }
  Measurement measurement = made.measurement();
  add_noise(measurement, noise, seed);
  return measurement;
}

TEST(FitTest, FiniteElementsWithNoiseGiveBackModulusAndFriction) {
  // What a fit takes by itself; with nu = 0.49 contact model mdr has no error to speak of either.
  for (const auto& [name, contact] : {std::pair("ball_on_cube_nu30", ContactModel::kAuto),
                                      std::pair("ball_on_cube_nu49", ContactModel::kMdr)}) {
    if (test::is_left_out(contact == ContactModel::kMdr)) {
      continue;
    }
    SCOPED_TRACE(name);
    const ElementScene scene = scene_named(name);
    SceneDescription start = scene.scene;
    start.bodies[0].elasticity.youngs_modulus = 4e5;
    start.bodies[0].friction = {0.3, 0.3};
    const std::string node = start.bodies[0].node;
    const FitResult result = fitted(problem_of(start, element_measurement(scene, 0.01, 7),
                                               {node + ".youngs_modulus", node + ".friction"},
                                               contact, BodyModel::kAuto));
    EXPECT_NEAR(result.estimates[0].value, 3e6, 0.03 * 3e6);
    EXPECT_NEAR(result.estimates[1].value, 0.75, 0.02 * 0.75);
    for (std::size_t k = 0; k < 2; ++k) {
      const double truth = k == 0 ? 3e6 : 0.75;
      EXPECT_LT(result.estimates[k].low, truth);
      EXPECT_GT(result.estimates[k].high, truth);
    }
    EXPECT_TRUE(result.warnings.empty()) << result.warnings[0];
  }
}

/// Hertz's force and Lubkin's torque of a ball on a half-space: pressed, then turned.
Measurement exact_measurement(const Pose& touching, double radius, double modulus, double poisson,
                              double friction) {
  constexpr double kDepth = 4e-4;  // m
  constexpr int kRows = 60;
  PressAndTurn made(touching);
  made.add(0.0, -2e-5, 0.0, 0.0, 0.0);
  const double contact_modulus = modulus / (1.0 - poisson * poisson);
  for (int k = 1; k <= kRows; ++k) {
    const double depth = kDepth * k / kRows;
    made.add(5 * kStep, depth, 0.0,
             reference::hertz_sphere_at_depth(radius, contact_modulus, depth).force, 0.0);
  }
  const reference::HertzSphere pressed =
      reference::hertz_sphere_at_depth(radius, contact_modulus, kDepth);
  const double shear = 0.5 * modulus / (1.0 + poisson);
  const reference::LubkinContact contact{reference::PressureShape::kHertz, pressed.force, friction,
                                         pressed.radius, shear};
  // To three times the turn at which half of the radius sticks.
  const double most = 3.0 * reference::slip_twist(contact, 0.5 * pressed.radius);
  for (int k = 1; k <= kRows; ++k) {
    const double turn = most * k / kRows;
    made.add(5 * kStep, kDepth, turn, pressed.force, -reference::torque(contact, turn));
  }
  return made.measurement();
}

TEST(FitTest, ExactSolutionsGiveBackWhatTheyWereMadeWith) {
  const ElementScene scene = scene_named("half_space");
  SceneDescription start = scene.scene;
  const double radius = start.tools[0].parts[0].shape.half_extent.x;
  const std::string node = start.bodies[0].node;
  start.bodies[0].elasticity.poisson_ratio = 0.3;
  start.bodies[0].elasticity.youngs_modulus = 3e4;
  for (const double friction : {0.2, 1.1}) {
    Measurement measurement = exact_measurement(scene.touching, radius, 8e5, 0.3, friction);
    add_noise(measurement, 0.01, 3);
    const FitResult result =
        fitted(problem_of(start, measurement, {node + ".youngs_modulus", node + ".friction"},
                          ContactModel::kMdr, BodyModel::kNone));
    EXPECT_NEAR(result.estimates[0].value, 8e5, 0.01 * 8e5);
    EXPECT_NEAR(result.estimates[1].value, friction, 0.02 * friction);
    EXPECT_LT(result.estimates[0].low, 8e5);
    EXPECT_GT(result.estimates[0].high, 8e5);
  }
}

/// The model's own run with these values in place of a measurement's forces and torques.
void measure_model(FitProblem& problem, const std::vector<double>& truth) {
  const Result<Prediction> made = predict(problem, truth);
  ASSERT_TRUE(made) << made.error().text;
  const std::size_t rows = problem.measurement.times.size();
  for (std::size_t q = 0; q < problem.measurement.quantities.size(); ++q) {
    const auto first = made.value().values.begin() + static_cast<std::ptrdiff_t>(q * rows);
    problem.measurement.quantities[q].values.assign(first,
                                                    first + static_cast<std::ptrdiff_t>(rows));
  }
}

TEST(FitTest, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const ElementScene scene = scene_named("half_space");
  const std::string node = scene.scene.bodies[0].node;
  const std::vector<double> truth = {2e6, 0.6};
  FitProblem problem = problem_of(
      scene.scene,
      exact_measurement(scene.touching, scene.scene.tools[0].parts[0].shape.half_extent.x, 2e6,
                        0.4999, 0.6),
      {node + ".youngs_modulus", node + ".friction"}, ContactModel::kMdr, BodyModel::kNone);
  measure_model(problem, truth);
  const unsigned seeds = test::all_cases() ? 200 : 6;
  for (const double memory : {0.0, 0.7}) {
    SCOPED_TRACE(memory);
    int held = 0;
    for (unsigned seed = 0; seed < seeds; ++seed) {
      FitProblem noisy = problem;
      add_noise(noisy.measurement, 0.02, seed, memory);
      const FitResult result = fitted(noisy);
      for (std::size_t k = 0; k < truth.size(); ++k) {
        const Estimate& estimate = result.estimates[k];
        held += estimate.low <= truth[k] && truth[k] <= estimate.high ? 1 : 0;
      }
    }
    // Binomial: three standard deviations below 95 %. With memory the autocorrelation time is
    // itself an estimate, of 120 rows, and a little low.
    const double count = 2.0 * seeds;
    const double share = memory > 0.0 ? 0.91 : 0.95;
    EXPECT_GE(held, share * count - 3.0 * std::sqrt(count * share * (1.0 - share)));
  }
}

TEST(FitTest, WhatTheDataLeaveOpenIsSaid) {
  // Pressing alone: the force knows E / (1 - nu^2) only, and nothing of friction.
  const ElementScene scene = scene_named("half_space");
  SceneDescription start = scene.scene;
  start.bodies[0].elasticity.poisson_ratio = 0.3;
  const std::string node = start.bodies[0].node;
  Measurement pressed =
      exact_measurement(scene.touching, start.tools[0].parts[0].shape.half_extent.x, 8e5, 0.3, 0.5);
  for (glm::dquat& rotation : pressed.motions[0].rotations) {
    rotation = scene.touching.rotation;
  }
  pressed.quantities.pop_back();
  add_noise(pressed, 0.01, 1);
  const FitResult result = fitted(problem_of(
      start, pressed, {node + ".youngs_modulus", node + ".poisson_ratio", node + ".friction"},
      ContactModel::kMdr, BodyModel::kNone));
  EXPECT_FALSE(result.estimates[0].determined());
  EXPECT_FALSE(result.estimates[1].determined());
  EXPECT_FALSE(result.estimates[2].determined());
  EXPECT_TRUE(warns_of(
      result, "cannot tell " + node + ".youngs_modulus, " + node + ".poisson_ratio apart"));
  EXPECT_TRUE(warns_of(result, "nothing that was measured depends on " + node + ".friction"));
  // What they determine together is right all the same.
  const double ratio = result.estimates[1].value;
  EXPECT_NEAR(result.estimates[0].value / (1.0 - ratio * ratio), 8e5 / 0.91, 0.01 * 8e5 / 0.91);
}

TEST(FitTest, OneOfTwoCoefficientsOfFrictionIsPointedOut) {
  const ElementScene scene = scene_named("half_space");
  const std::string node = scene.scene.bodies[0].node;
  const double radius = scene.scene.tools[0].parts[0].shape.half_extent.x;
  SceneDescription start = scene.scene;
  start.bodies[0].friction = {0.9, 0.9};
  const Measurement measurement = exact_measurement(scene.touching, radius, 2e6, 0.4999, 0.6);
  const FitResult result = fitted(problem_of(start, measurement, {node + ".dynamic_friction"},
                                             ContactModel::kMdr, BodyModel::kNone));
  EXPECT_TRUE(warns_of(result, "static_friction stayed at 0.9"));
  EXPECT_TRUE(warns_of(result, "free " + node + ".friction"));
}

TEST(FitTest, PositionsThatAreOffAreFound) {
  const ElementScene scene = scene_named("half_space");
  const std::string node = scene.scene.bodies[0].node;
  Measurement measurement = exact_measurement(
      scene.touching, scene.scene.tools[0].parts[0].shape.half_extent.x, 2e6, 0.4999, 0.6);
  for (glm::dvec3& position : measurement.motions[0].positions) {
    position.y += 1e-4;  // a quarter of the depth
  }
  add_noise(measurement, 0.005, 5);
  const FitResult result = fitted(problem_of(
      scene.scene, measurement, {node + ".youngs_modulus", node + ".friction", "tool.offset_y"},
      ContactModel::kMdr, BodyModel::kNone));
  EXPECT_NEAR(result.estimates[2].value, -1e-4, 5e-6);
  EXPECT_NEAR(result.estimates[0].value, 2e6, 0.03 * 2e6);
  EXPECT_NEAR(result.estimates[1].value, 0.6, 0.02 * 0.6);
}

TEST(FitTest, AnotherShapeThanWasMeasuredIsNoticed) {
  const ElementScene scene = scene_named("half_space");
  const std::string node = scene.scene.bodies[0].node;
  Measurement measurement = exact_measurement(
      scene.touching, scene.scene.tools[0].parts[0].shape.half_extent.x, 2e6, 0.4999, 0.6);
  // A flat punch's force goes with the depth, a ball's with its 1.5th power.
  for (std::size_t k = 0; k < measurement.times.size(); ++k) {
    const double depth = scene.touching.position.y - measurement.motions[0].positions[k].y;
    measurement.quantities[0].values[k] = depth > 0.0 ? 5e4 * std::sqrt(depth) : 0.0;
  }
  measurement.quantities.pop_back();
  const FitResult result = fitted(problem_of(scene.scene, measurement, {node + ".youngs_modulus"},
                                             ContactModel::kMdr, BodyModel::kNone));
  EXPECT_TRUE(warns_of(result, "the forces differ by"));
}

}  // namespace
}  // namespace torsion::engine
