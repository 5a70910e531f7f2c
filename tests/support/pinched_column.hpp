#pragma once

#include <vector>

#include "ecs/scene_description.hpp"

namespace torsion::engine::test {

/// A column of 1 MPa, 0.1 m high, with body model compliance, that stands on its end between two
/// balls of 20 mm at a height of 80 mm.
SceneDescription pinched_column(double width, ContactModel contact, double friction);

/// The balls' places.
/// @param left, right  m: how far each has come into the column at rest, negative: is away from it
std::vector<Pose> pinch_poses(double width, double left, double right);

}  // namespace torsion::engine::test
