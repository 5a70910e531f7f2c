#pragma once

// Meshes that overlap bound one solid: their union.

#include <string>

#include "ecs/result.hpp"
#include "ecs/scene_description.hpp"

namespace torsion {

/// What has become one.
struct Union {
  SurfaceMesh surface;       // closed and oriented, of the solid's outside alone
  bool changed = false;      // false: no shell touches another, and `surface` is empty
  std::uint32_t buried = 0;  // triangles of the meshes that lie inside the solid, wholly
  std::uint32_t cut = 0;     // triangles that another shell cuts
};

/// The boundary of all places that a closed mesh winds around at least once: shells that overlap or
/// lie in each other are one solid, shells that wind the other way are cavities. Triangles are cut
/// along those of other shells, and what lies inside is left out. Fails where the pieces do not
/// close up, as where shells touch along nearly coplanar faces. Shells are what shares vertices; a
/// shell that cuts itself is not looked for.
/// Winding numbers by solid angles: Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983)
/// 125; Jacobson, Kavan and Sorkine-Hornung, ACM Trans. Graph. 32 (2013) 33.
Result<Union> unite_shells(const SurfaceMesh& mesh);

/// Unites what overlaps of an owner's mesh parts: the shells of each, whose surface becomes the
/// union's; and, if asked for, parts with parts, which get their `solid`. Exact shapes stay as they
/// are: the nearest counts.
/// @param with_others  how deep a place is in the owner counts, as in a body: not in a tool
/// @return the nodes whose meshes were united, or the error that names one
Result<std::vector<std::string>> unite_parts(std::vector<PartDescription>& parts, bool with_others);

}  // namespace torsion
