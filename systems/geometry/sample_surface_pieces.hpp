#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ecs/scene_description.hpp"
#include "systems/geometry/distance_mesh.hpp"

namespace torsion {

/// A flat triangle of a part's surface, in the owner's frame.
struct SurfaceTriangle {
  std::array<glm::dvec3, 3> corner;  // m
  double area = 0.0;                 // m^2
  glm::dvec3 normal{0.0};            // unit
  double bulge = 0.0;                // m: how far the exact surface over it may lie from it
  std::uint32_t part = 0;            // row of the parts
};

/// Inside and outside of each part of a union, exactly.
class PartSolids {
 public:
  explicit PartSolids(std::span<const PartDescription> parts);

  /// True if `point` [m, owner's frame] lies in a part other than `own`, deeper than `margin` [m].
  [[nodiscard]] bool inside_others(const glm::dvec3& point, std::uint32_t own, double margin) const;

 private:
  /// Right inside the part; outside some number that is not negative.
  [[nodiscard]] double distance_inside(std::uint32_t part, const glm::dvec3& point) const;

  std::span<const PartDescription> parts_;
  std::vector<std::optional<MeshDistance>>
      meshes_;                 // one for each part; empty for exact shapes and bad meshes
  std::vector<Bounds> boxes_;  // of those meshes, m, owner's frame
};

/// Signed distance to an exact shape at a point of its owner's frame. @pre shape.kind is not kMesh
Distance exact_distance(const ShapePart& shape, const glm::dvec3& point);

/// The surface of the union of `parts` in pieces: a mesh's triangles; an exact shape cut finely
/// enough for `target_count` samples, with all corners on the exact surface and its edges along
/// those of the shape. Pieces that lie wholly inside another part, and those without area, are left
/// out.
std::vector<SurfaceTriangle> surface_pieces(std::span<const PartDescription> parts,
                                            const PartSolids& solids, std::uint32_t target_count);

}  // namespace torsion
