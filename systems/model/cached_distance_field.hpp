#pragma once

#include "ecs/result.hpp"
#include "systems/geometry/distance_field_build.hpp"

namespace torsion {

/// A distance field as build_distance_field makes it, from the user's cache where the same mesh was
/// met before; stores it there if not.
Result<BuiltField> load_or_build_distance_field(const FieldOfMesh& mesh,
                                                const FieldOptions& options = {});

}  // namespace torsion
