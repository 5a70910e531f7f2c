#pragma once

// The Falcon's three legs: joint angles, position, force. Symbols as in the thesis of L. W.
// Stamper, "A three degree of freedom parallel manipulator with only translational degrees of
// freedom", Maryland 1997, with the published lengths of the device.

#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "device/protocols/falcon.hpp"

namespace torsion::engine {

/// Angles of the three motor joints, rad, from an encoder's counts.
glm::dvec3 falcon_joint_angles(const FalconInput& input);

/// Joint angles, rad, of a grip at `position` [m, device: z away from the base].
/// @return nothing out of the legs' reach
std::optional<glm::dvec3> falcon_inverse(const glm::dvec3& position);

/// d(angles)/d(position), rad/m, row k for leg k. @pre the position is in reach
glm::dmat3 falcon_jacobian(const glm::dvec3& position);

/// Position from joint angles by Newton's method. The legs' links are offset, so that there is no
/// closed form.
/// @param near  m: the last position, where the search begins
/// @return nothing where the search leaves the legs' reach
std::optional<glm::dvec3> falcon_forward(const glm::dvec3& angles, const glm::dvec3& near);

/// Motor values for a force [N, device axes] at `position`, made smaller all alike where one is too
/// large, so that the direction stays. The scale from N m to motor values is nominal.
std::array<std::int16_t, 3> falcon_motors(const glm::dvec3& position, const glm::dvec3& force);

}  // namespace torsion::engine
