#pragma once

#include <glm/gtc/quaternion.hpp>

namespace torsion::engine::test {

inline constexpr glm::dvec3 kUp(0.0, 1.0, 0.0);
inline constexpr glm::dquat kUpright(1.0, 0.0, 0.0, 0.0);  // not turned

}  // namespace torsion::engine::test
