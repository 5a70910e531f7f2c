#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "ecs/result.hpp"
#include "ecs/surface.hpp"
#include "systems/geometry/distance.hpp"

namespace torsion::engine {

/// Exact signed distance to a closed triangle mesh, for load-time work. Closest points come from
/// Embree's point query (a tree of boxes in float that only prunes, conservatively; the distances
/// are double), the sign from angle-weighted pseudonormals (Baerentzen and Aanaes, "Signed distance
/// computation using the angle weighted pseudonormal", 2005), which is right at edges and vertices
/// too. Queries may run in several threads at once.
class MeshDistance {
 public:
  struct Closest {
    Distance distance;  // in front of a face the gradient is exact; on the surface the pseudonormal
    glm::dvec3 point{0.0};  // m, on the surface
    std::uint32_t triangle = kNoRow;
  };

  /// Fails for a mesh without triangles, with indices out of range or with positions that are not
  /// finite.
  static Result<MeshDistance> build(const SurfaceMesh& mesh, std::uint32_t threads = 2);

  MeshDistance(const MeshDistance&) = delete;
  MeshDistance& operator=(const MeshDistance&) = delete;
  MeshDistance(MeshDistance&&) noexcept;
  MeshDistance& operator=(MeshDistance&&) noexcept;
  ~MeshDistance();

  /// @param hint  a triangle that is perhaps near, or kNoRow: makes the query faster, does not
  /// change its result
  ///              (but for the choice among points that are equally near)
  /// @pre point is finite
  [[nodiscard]] Closest closest(const glm::dvec3& point, std::uint32_t hint = kNoRow) const;

 private:
  struct Tree;
  explicit MeshDistance(std::unique_ptr<Tree> tree);
  std::unique_ptr<Tree> tree_;
};

}  // namespace torsion::engine
