#pragma once

#include "systems/geometry/distance.hpp"

namespace torsion {

/// Signed distance to a mesh in its part's frame, read from a two-level grid of nodes that hold the
/// distance d_i and its gradient g_i. In a cell the value is the sum over its 8 nodes of w_i (d_i +
/// 1/2 g_i.(x - x_i)) with the trilinear weights w_i: the errors of second order of the trilinear
/// blend of the d_i and of the blend of the Taylor expansions d_i + g_i.(x - x_i) are equal and
/// opposite, so half of the slope cancels them.
class FieldDistance {
 public:
  /// @param row  of world.fields
  FieldDistance(const Model& model, std::uint32_t row)
      : field_(model.fields.at<DistanceField>(row)),
        inverse_spacing_(1.0 / field_.spacing),
        nodes_(model.field_nodes.column<DistanceNode>().data()),
        bricks_(model.field_bricks.rows<DistanceBrick>(field_.bricks).data()) {}

  /// @param x, y, z  m, part frame
  Distance operator()(double x, double y, double z) const;

 private:
  DistanceField field_;
  double inverse_spacing_;
  const DistanceNode* nodes_;
  const DistanceBrick* bricks_;
};

}  // namespace torsion
