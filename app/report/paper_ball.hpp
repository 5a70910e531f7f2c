#pragma once

namespace torsion::engine {

// The paper's ball, and the depth at which its contact is a tenth of its radius.
inline constexpr double kPaperBallRadius = 0.05;     // m
inline constexpr double kPaperBallDepth = 4.127e-4;  // m

}  // namespace torsion::engine
