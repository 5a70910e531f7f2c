#pragma once

// Triangles cut along other triangles.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "ecs/components/bodies.hpp"
#include "ecs/result.hpp"
#include "ecs/scene_description.hpp"
#include "ecs/surface.hpp"

namespace torsion::engine {

struct Facet {
  std::array<glm::dvec3, 3> corner;  // m
  glm::dvec3 normal{0.0};            // unit; zero without area
  Bounds box;
};

/// A convex, flat piece of a triangle: its corners in order, m.
using Polygon = std::vector<glm::dvec3>;

/// One for each triangle.
std::vector<Facet> facets_of(const SurfaceMesh& mesh);

/// True where all corners of `a` lie in the plane of `b`.
/// @param same  m: places nearer than that are one, here and below
bool is_coplanar(const Facet& a, const Facet& b, double same);

/// True where two facets cross or touch along a line, or are coplanar.
bool do_cross(const Facet& a, const Facet& b, double same);

/// True where a place in a facet's plane lies within its edges.
bool is_in(const Facet& facet, const glm::dvec3& place);

/// Cuts the pieces of a facet along another one.
void cut_by(std::vector<Polygon>& pieces, const Facet& facet, const Facet& other, double same);

// Flat pieces of a surface as one triangle mesh.

/// The pieces as one mesh, without places where an edge ends in the middle of another: nothing
/// where they bound no solid.
/// @param pieces  convex; as they were cut, so that neighbours may have different corners along one
///                edge
/// @param same    m: corners nearer than a few times that are one
std::optional<SurfaceMesh> close_pieces(const std::vector<Polygon>& pieces, double same);

// Meshes that overlap bound one solid: their union.

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

}  // namespace torsion::engine
