#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ecs/components.hpp"
#include "ecs/result.hpp"
#include "ecs/surface.hpp"
#include "systems/geometry/distance.hpp"

namespace torsion::engine {

/// Signed distance to a mesh in its part's frame, read from a two-level grid of nodes that hold the
/// distance d_i and its gradient g_i. In a cell the value is the sum over its 8 nodes of w_i (d_i +
/// 1/2 g_i.(x - x_i)) with the trilinear weights w_i: the errors of second order of the trilinear
/// blend of the d_i and of the blend of the Taylor expansions d_i + g_i.(x - x_i) are equal and
/// opposite, so half of the slope cancels them. In cells with a sharp edge, where the halves would
/// leave a bulge beside it of an eighth of a cell, it is the distance to the planes that meet there
/// (distance_creases.hpp).
class FieldDistance {
 public:
  /// @param row  of world.fields
  FieldDistance(const Model& model, std::uint32_t row)
      : field_(model.fields.at<DistanceField>(row)),
        inverse_spacing_(1.0 / field_.spacing),
        nodes_(model.field_nodes.column<DistanceNode>().data() + field_.coarse_nodes.first),
        bricks_(model.field_bricks.rows<DistanceBrick>(field_.bricks).data()),
        creases_(model.field_creases.rows<DistanceCrease>(field_.creases).data()) {}

  /// @param x, y, z  m, part frame
  Distance operator()(double x, double y, double z) const;

 private:
  /// @param place  0 to 1 along each axis, within the coarse cell
  /// @return       gradient (unitless), and the distance (m) as w
  [[nodiscard]] glm::vec4 in_brick(const DistanceBrick& brick,
                                   const std::array<double, 3>& place) const;

  DistanceField field_;
  double inverse_spacing_;
  const DistanceNode* nodes_;
  const DistanceBrick* bricks_;
  const DistanceCrease* creases_;
};

/// The resolution of a distance field. Measured at the defaults on spheres and tori: the largest
/// error near the surface is 1e-5 of the longest side; doubling coarse_cells divides it by 8 where
/// the surface is smooth. At sharp edges it is 5e-4 of the longest side at most, and 5e-5 in the
/// mean; doubling coarse_cells halves it.
struct FieldOptions {
  std::uint32_t coarse_cells = 32;  // along the longest side, with a margin around the mesh
  std::uint32_t subdivision = 4;    // fine cells along one edge of a coarse cell
  std::uint32_t threads = 2;        // the result does not depend on it
};

/// The rows of one field, with ranges that count from 0 in its own nodes and bricks.
struct BuiltField {
  DistanceField header;
  std::vector<DistanceNode> nodes;
  std::vector<DistanceBrick> bricks;
  std::vector<DistanceCrease> creases;
};

/// What a field is of. Closed, oriented meshes.
struct FieldOfMesh {
  FieldOfMesh(const SurfaceMesh& mesh) : part(mesh), solid(mesh) {}  // NOLINT(google-explicit-*)
  FieldOfMesh(const SurfaceMesh& of_part, const SurfaceMesh& of_solid)
      : part(of_part), solid(of_solid) {}
  const SurfaceMesh& part;   // whose box the field covers
  const SurfaceMesh& solid;  // to which it measures: the part, or what it and others make
};

/// Load time: the distance field of a closed, oriented mesh, in the mesh's frame. Coarse nodes
/// cover the mesh's box and a margin of 1.5 coarse cells; every coarse cell that the surface comes
/// near gets a brick of fine nodes. Fails as MeshDistance::build does, and where the mesh has no
/// extent.
Result<BuiltField> build_distance_field(const FieldOfMesh& mesh, const FieldOptions& options = {});

/// A field as bytes and back; nullopt where the bytes are no such field.
std::vector<std::byte> to_bytes(const BuiltField& field);
std::optional<BuiltField> field_from_bytes(std::span<const std::byte> bytes);

}  // namespace torsion::engine
