#pragma once

#include "ecs/components.hpp"

namespace torsion::engine {

/// Where a handle is taken to be whose encoders count: the pose nearest to the last one that is
/// within two counts of what they say, on each axis, and from there slowly to within one. A handle
/// that trembles about the edge of a count stands still; with a coupling on what the encoders say
/// themselves the force would toggle there by the stiffness times a count, late, which is a relay
/// and feeds an oscillation.
///
/// A pose that moves at once when it is W counts behind is a relay, too, of hysteresis. By its
/// describing function (Gelb & Vander Velde, 1968, ch. 2) it does not oscillate where
/// -Im L(i w) < pi/2 W at every frequency w, for the loop L = K exp(-i w t_d) / (k + i w c - m w^2)
/// of a coupling K and a hand k, c, m. With K = 200 N/m, t_d = 4.5 ms, m = 0.15 kg and c = 6 N s/m
/// that asks for W > 0.65 with a hand of 200 N/m and W > 1.63 with a loose one of 50 N/m: two.
///
/// That is no place to rest yet: a count of the pose moves a loose hand by K / k = 4 counts, out of
/// the 3 in which what the encoders say stays within one count of it. The slow way between does not
/// jump, so that there is such a place for every hand, and lets the hand follow, whose slowest time
/// is c / k = 0.12 s.
///
/// Moving, the pose lags behind by up to two and a half counts, which over a way s of the handle
/// costs an energy of up to K (5/2 count) s. needs_play() says where that is the smaller evil.
/// @param last        what this returned before
/// @param measured    what the encoders say
/// @param count       m; 0: they do not count, and `measured` is returned
/// @param turn_count  rad, likewise
/// @param period      s, since `last`
Pose follow_counts(const Pose& last, const Pose& measured, double count, double turn_count,
                   double period);

/// Whether a spring is to pull at follow_counts() and not at what the encoders say: where a count's
/// toggling comes to more than 0.5 % of the largest force, and the spring is soft.
///
/// For the lag of a pose feeds a swing: of play h and a spring K a swing A gets 4 K h (A - h) each
/// time, of which a hand of damping c takes pi c w A^2 with w^2 = K / m. None is fed where
/// K < pi^2 c^2 / m, by A = 2 h, the worst. A loose hand that damps little on a device without
/// friction is taken for it: 2 N s/m and 0.1 kg, 3 mN m s and 0.25 g m^2.
/// @param count      m
/// @param stiffness  of the coupling, N/m
/// @param largest    N
bool needs_play(double count, double stiffness, double largest);

/// Likewise in turning: rad, N m/rad, N m.
bool needs_turn_play(double count, double stiffness, double largest);

}  // namespace torsion::engine
