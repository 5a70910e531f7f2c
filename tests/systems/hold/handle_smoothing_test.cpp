#include "systems/hold/handle_smoothing.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

constexpr double kStep = 1e-3;  // s

Pose at(double x, double angle) {
  return {{x, 0.0, 0.0}, glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0))};
}

TEST(HandleSmoothingTest, AJumpComesAsTwoLowPassesInARowHaveIt) {
  HandleSmoothing smoothing;
  restart_smoothing(smoothing, at(0.0, 0.0));
  // Poles z = exp(-dt/tau), twice, each with unit gain: after n steps 1 - z^n (1 + n (1 - z)).
  const double pole = std::exp(-kStep / kSmoothingTime);
  for (int n = 1; n <= 100; ++n) {
    const Pose pose = smooth(smoothing, at(1.0, 0.5), kStep);
    const double share = 1.0 - std::pow(pole, n) * (1.0 + n * (1.0 - pole));
    EXPECT_NEAR(pose.position.x, share, 1e-12);
    // A turn about one axis goes the same way.
    EXPECT_NEAR(glm::angle(pose.rotation), 0.5 * share, 1e-9);
  }
}

TEST(HandleSmoothingTest, SamplesOfAnEvenMotionOnceAPictureGiveAnEvenMotion) {
  HandleSmoothing smoothing;
  restart_smoothing(smoothing, at(0.0, 0.0));
  constexpr double kSpeed = 0.1;     // m/s
  constexpr int kPictureSteps = 17;  // 60 pictures a second
  double sample = 0.0;
  double last = 0.0;
  double slowest = 1e300;
  double fastest = 0.0;
  for (int step = 0; step < 1000; ++step) {
    sample = step % kPictureSteps == 0 ? kSpeed * step * kStep : sample;
    const double x = smooth(smoothing, at(sample, 0.0), kStep).position.x;
    if (step > 300) {
      slowest = std::min(slowest, (x - last) / kStep);
      fastest = std::max(fastest, (x - last) / kStep);
    }
    last = x;
  }
  // The velocity is a train of impulse responses t / tau^2 exp(-t / tau), a picture apart. It is
  // lowest just at a sample: u^2 q / (1 - q)^2 of the mean, with u = T / tau and q = exp(-u).
  const double u = kPictureSteps * kStep / kSmoothingTime;
  const double q = std::exp(-u);
  const double least = u * u * q / ((1.0 - q) * (1.0 - q));
  EXPECT_NEAR(slowest, least * kSpeed, 0.01 * kSpeed);
  EXPECT_LT(fastest, (2.0 - least) * kSpeed);
}

TEST(HandleSmoothingTest, WhatStaysIsReached) {
  HandleSmoothing smoothing;
  restart_smoothing(smoothing, at(0.3, 0.2));
  for (int step = 0; step < 1000; ++step) {
    smooth(smoothing, at(0.4, -2.9), kStep);
  }
  EXPECT_NEAR(smoothing.second.position.x, 0.4, 1e-15);
  EXPECT_NEAR(std::abs(glm::dot(smoothing.second.rotation, at(0.4, -2.9).rotation)), 1.0, 1e-15);
}

}  // namespace
}  // namespace torsion::engine
