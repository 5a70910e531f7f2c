#pragma once

#include "ecs/components.hpp"

namespace torsion {

/// Where a handle is taken to be whose encoders count: the pose nearest to the last one that is
/// within a count of what they say, on each axis. A handle that trembles about the edge of a count
/// stands still; with a coupling on what the encoders say themselves the force would toggle there
/// by the stiffness times a count, late, which is a relay and feeds an oscillation. With half a
/// count it would still be a relay, of hysteresis, and by its describing function (Gelb & Vander
/// Velde, 1968, ch. 2) oscillate slowly with a hand of 200 N/m and 6 N s/m; with a whole one it
/// does not. Moving, it lags behind by up to one and a half counts, which over a way s of the
/// handle costs an energy of up to K (3/2 count) s; the passivity controller sees it.
/// @param last        what this returned before
/// @param measured    what the encoders say
/// @param count       m; 0: they do not count, and `measured` is returned
/// @param turn_count  rad, likewise
Pose within_a_count(const Pose& last, const Pose& measured, double count, double turn_count);

}  // namespace torsion
