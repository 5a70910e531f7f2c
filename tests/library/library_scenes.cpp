#include "tests/library/library_scenes.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace torsion::test {

Scene ball_on_pad(const std::string& model) {
  Body pad;
  pad.name = "pad";
  pad.parts = {make_box({2.0 * kHalf, 2.0 * kHalf, 2.0 * kHalf})};
  pad.material = {1e5, 0.5, 1000.0, 0.5, 0.5};
  pad.fixed = Fixed::kBottomFace;
  pad.contact_model = model;
  pad.body_model = "none";
  Tool ball;
  ball.name = "ball";
  ball.parts = {make_sphere(kRadius)};
  Scene scene;
  scene.bodies = {pad};
  scene.tools = {ball};
  return scene;
}

Pose pressed(double depth, double turn) {
  return {{0.0, kHalf + kRadius - depth, 0.0},
          {std::cos(0.5 * turn), 0.0, std::sin(0.5 * turn), 0.0}};
}

Simulation simulation_of(const Scene& scene, const Options& options) {
  Result<std::shared_ptr<const Model>> model = build(scene, options);
  if (!model) {
    ADD_FAILURE() << model.error().message;
    std::abort();
  }
  return Simulation(std::move(model).value());
}

void press(Simulation& simulation, double depth, int steps) {
  for (int step = 0; step <= steps; ++step) {
    const Pose pose = pressed(depth * step / steps);
    simulation.step({&pose, 1});
  }
}

double length(const Vector3& v) {
  return std::sqrt(dot(v, v));
}

double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector3 minus(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector3 plus(const Vector3& a, const Vector3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

}  // namespace torsion::test
