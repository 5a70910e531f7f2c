#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

#include "scenes/problem.hpp"

namespace torsion::engine {

/// Most elements of one accessor, and most vertices or triangles of a scene.
inline constexpr std::uint64_t kMostElements = 20'000'000;

/// Checks that every buffer view lies in its buffer and every accessor in its view, in arithmetic
/// that cannot overflow; component types, strides, alignment, sparse counts, number of keys.
/// @pre check_gltf_structure() found nothing
void check_gltf_extents(const nlohmann::json& document, const ProblemList& problems);

}  // namespace torsion::engine
