#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>

#include "tests/systems/patch/pressed_ball.hpp"

namespace torsion::engine::test {

/// Where the ball is, over the place where it was pressed.
struct Place {
  glm::dvec3 shift{0.0};  // m
  double turn = 0.0;      // rad, about the world's y
};

inline Place operator+(const Place& a, const Place& b) {
  return {a.shift + b.shift, a.turn + b.turn};
}

inline Place operator-(const Place& a, const Place& b) {
  return {a.shift - b.shift, a.turn - b.turn};
}

inline constexpr std::size_t kWay = 3;  // steps away; as many lead back in another order
using Path = std::array<Place, 2 * kWay>;

/// Three steps away and the same three back in another order.
/// A step goes down or up, or aside and round: work by the mean of two forces counts what a rim
/// that is gone had held over half of the way that it never went.
/// @param least, most  steps aside, of the depth; a tenth as many radians of turn
inline Path random_path(std::mt19937& random, double least, double most) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  // A part in 10^4 of the depth: the mean of two forces is off by (h / depth)^2 / 16 = 6e-10 of a
  // power law of 3 / 2.
  const double depth = 1e-4 * kBallDepth;
  const double size = least * std::pow(most / least, 0.5 + 0.5 * uniform(random));
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

/// A ball over the cube whose holder's work is added up, by the tool's wrench and the poses: in the
/// mean of the wrenches before and after each step.
class WorkedBall {
 public:
  explicit WorkedBall(const BallScene& scene) : WorkedBall(scene, make_ball_scene(scene)) {}
  /// @param scene  another tool, that of make_ball_scene(ball) with more parts
  WorkedBall(const BallScene& ball, const SceneDescription& scene) : hand_(scene, options(ball)) {
    lift_off();
    forget();
  }

  void lift_off() { go(Place{{0.0, 2.0 * kBallDepth, 0.0}, 0.0}); }

  void go(const Place& place) {
    const glm::dvec3 from = hand_.poses[0].position;
    const Wrench wrench = hand_.wrench();
    hand_.step_to(
        {{kPressed + place.shift, glm::angleAxis(place.turn, glm::dvec3(0.0, 1.0, 0.0))}});
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
      go(Place{hand_.poses[0].position - kPressed, turn_});
    }
  }
  void forget() {
    work = 0.0;
    throughput = 0.0;
  }
  /// To and fro along x as a wheel rolls, in steps of `step` [m], `steps` each way.
  void roll(double step, int steps) {
    for (int k = 0; k < 2 * steps; ++k) {
      const double way = k < steps ? step : -step;
      const Wrench before = hand_.wrench();
      const double from = hand_.poses[0].position.x;
      hand_.move({way, 0.0, 0.0}, {0.0, 0.0, 1.0}, -way / kBallRadius, 1);
      const Wrench& after = hand_.wrench();
      const double gone = hand_.poses[0].position.x - from;
      work += 0.5 * (before.torque.z + after.torque.z) * way / kBallRadius -
              0.5 * (before.force.x + after.force.x) * gone;
    }
  }
  /// All steps of a path.
  void go(const Path& path) {
    for (const Place& place : path) {
      go(place);
    }
  }
  /// Of the work, what the region of patch holds, less what is still to be charged, J.
  [[nodiscard]] double held() const { return energy().held - energy().owed - energy().lent; }
  [[nodiscard]] double owed() const { return energy().owed; }
  [[nodiscard]] const Hand& hand() const { return hand_; }

  double work = 0.0;        // J
  double throughput = 0.0;  // J: what went to and fro

 private:
  static PrepareOptions options(const BallScene& scene) {
    PrepareOptions options = options_of(scene);
    options.rate = 10.0;  // Hz: what a new region exerts fades in within one step
    return options;
  }

  [[nodiscard]] const PatchEnergy& energy() const {
    return hand_.world().state.regions.at<PatchEnergy>(0);
  }

  static constexpr glm::dvec3 kPressed{0.0, 0.1 + kBallRadius - kBallDepth, 0.0};
  Hand hand_;
  double turn_ = 0.0;
};

}  // namespace torsion::engine::test
