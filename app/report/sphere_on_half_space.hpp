#pragma once

#include <string>
#include <vector>

#include "app/report/reference_case.hpp"
#include "tests/reference/exact/hertz.hpp"

namespace torsion::engine {

/// The paper's ball, pressed kPaperBallDepth deep into a block that stands for a half-space.
struct SphereOnHalfSpace {
  Elasticity elasticity;
  Friction friction;
  reference::HertzSphere hertz;
  int steps = 0;  // between the points of a path
};

SphereOnHalfSpace sphere_on_half_space(bool quick);

/// A sphere's own contact radius and force, with Hertz' form of the pressure.
reference::HertzSphere sphere_contact(double modulus, double depth);

SceneDescription scene_of(const SphereOnHalfSpace& sphere);

/// The ball this deep, turned about the normal and shifted along x.
Pose pose_at(double depth, double turn, double shift);

/// From just above the surface down to kPaperBallDepth.
std::vector<PathPoint> press(const SphereOnHalfSpace& sphere, bool force_is_normal);

/// The description's first sentences.
std::string sphere_text(const SphereOnHalfSpace& sphere);

}  // namespace torsion::engine
