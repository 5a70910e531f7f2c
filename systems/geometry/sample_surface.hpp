#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ecs/components.hpp"
#include "ecs/scene_description.hpp"
#include "systems/geometry/distance_mesh.hpp"

namespace torsion::engine {

/// The rows of one tool: samples of its surface and the tree of balls over them, in the tool's
/// frame.
struct SampledSurface {
  std::vector<SurfaceSample> samples;
  std::vector<SurfaceBall> balls;  // depth first; a leaf's centre is its sample
};

/// Load time: spreads `target_count` samples evenly over the surface of the union of `parts`,
/// however finely their meshes are cut; a crease or a thin wall has samples on both sides. Samples
/// of an exact shape lie on the exact surface, and surface inside another part has none. Every
/// point of the union's surface lies in the ball of a leaf and of all that leaf's ancestors.
/// Depends on nothing but its arguments. Fewer samples only where parts have no area. Empty for no
/// parts.
SampledSurface sample_surface(std::span<const PartDescription> parts, std::uint32_t target_count);

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

/// A tree of balls over points, depth first, without radii: 4 branches a node down to nodes of at
/// most 8 leaves. `order` says which point each leaf is, in the order of the leaves. Leaf i has
/// sample = i.
struct PointTree {
  std::vector<SurfaceBall> balls;
  std::vector<std::uint32_t> order;  // row of `points` for leaf 0, 1, 2, ...
};

/// Cuts the points at the median of the longest side of their box, twice for each node.
PointTree point_tree(std::span<const glm::dvec3> points);

/// Sets the inner balls so that each holds the leaf balls below it.
void fit_balls(std::span<SurfaceBall> balls);

/// The leaf whose centre is nearest to `point`. @param hint  a leaf that is perhaps near
std::uint32_t nearest_leaf(std::span<const SurfaceBall> balls,
                           std::span<const glm::dvec3> leaf_centers, const glm::dvec3& point,
                           std::uint32_t hint);

}  // namespace torsion::engine
