#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace torsion::engine {

/// Toward the key light, world.
inline const glm::dvec3 kToKeyLight = glm::normalize(glm::dvec3(-0.45, 0.85, 0.40));

/// The studio around every scene: a pale room, a soft box above on the key light's side, a dimmer
/// one behind, a strip low at the right. A picture's light from all around, diffuse and mirrored,
/// is of it (image-based light; Debevec, SIGGRAPH 1998).
/// @param direction  unit, world, +y up
/// @return linear rgb
glm::dvec3 studio_radiance(const glm::dvec3& direction);

/// What a white diffuse surface reflects of the studio, as nine coefficients of its normal's
/// polynomials (Ramamoorthi and Hanrahan, SIGGRAPH 2001), their constants multiplied in:
/// 1, y, z, x, xy, yz, 3 z^2 - 1, xz, x^2 - y^2.
std::array<glm::dvec3, 9> studio_irradiance();

/// That polynomial.
/// @param normal  unit
glm::dvec3 irradiance_at(const std::array<glm::dvec3, 9>& coefficients, const glm::dvec3& normal);

/// The studio as a rough mirror shows it: radiance averaged over GGX's distribution about a
/// direction, the eye in that direction too (Karis, SIGGRAPH 2013).
/// @param direction  unit
/// @param roughness  0 to 1
glm::dvec3 mirrored_studio(const glm::dvec3& direction, double roughness);

/// Texels of the reflections that shaders/reflection.glsl reads: kReflectionTiles squares, one over
/// another, rgb and 1, half floats. Tiles that no surface needs stay black.
/// @param roughness  of the surfaces
std::vector<std::uint16_t> reflection_texels(const std::vector<float>& roughness);

}  // namespace torsion::engine
