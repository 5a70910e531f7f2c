#pragma once

#include "torsion/torsion.hpp"

namespace torsion::test {

inline constexpr double kRadius = 0.02;  // m, of the ball
inline constexpr double kHalf = 0.05;    // m, of the pad

/// A ball over the middle of a pad, which is fixed at its bottom and has contact model `model`.
Scene ball_on_pad(const std::string& model);

/// The ball's pose when its lowest point is `depth` under the pad's top, turned about the vertical.
Pose pressed(double depth, double turn = 0.0);

/// The scene's simulation. Fails the test where it cannot be built.
Simulation simulation_of(const Scene& scene, const Options& options = {});

/// Presses the ball in by `depth` over `steps` steps.
void press(Simulation& simulation, double depth, int steps = 100);

double length(const Vector3& v);
double dot(const Vector3& a, const Vector3& b);
Vector3 minus(const Vector3& a, const Vector3& b);
Vector3 plus(const Vector3& a, const Vector3& b);

}  // namespace torsion::test
