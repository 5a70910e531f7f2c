#pragma once

#include "ecs/components.hpp"

namespace torsion::engine {

/// What follows a mouse's poses, which come once a picture and jump from one to the next: two low
/// passes in a row, so that neither place nor velocity jumps. It lags by 2 kSmoothingTime.
struct HandleSmoothing {
  bool on = false;
  Pose first;   // follows the samples
  Pose second;  // follows the first
};

// s: a few times the period of the pictures would lag, less would show them.
inline constexpr double kSmoothingTime = 0.015;

/// Begins at a pose, at rest.
void restart_smoothing(HandleSmoothing& smoothing, const Pose& at);

/// One step of `dt` [s] towards `sample`: first order low passes, exact for a sample that stays.
/// @return where the handle is taken to be
Pose smooth(HandleSmoothing& smoothing, const Pose& sample, double dt);

}  // namespace torsion::engine
