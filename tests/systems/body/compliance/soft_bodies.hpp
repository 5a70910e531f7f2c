#pragma once

namespace torsion::engine::test {

// What tests of bodies with compliance press, and with what.
inline constexpr double kSoftShearModulus = 1e5;  // Pa
inline constexpr double kSmallBallRadius = 0.02;  // m

}  // namespace torsion::engine::test
