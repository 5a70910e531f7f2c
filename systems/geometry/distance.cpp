#include "systems/geometry/distance.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "systems/geometry/distance_field.hpp"
#include "systems/geometry/distance_shapes.hpp"
#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

bool is_turned(const glm::dquat& rotation) {
  return rotation.x != 0.0 || rotation.y != 0.0 || rotation.z != 0.0;
}

/// Calls f with the distance function of `part` in its own frame.
template <class F>
void with_shape(const Model& model, const ShapePart& part, F&& f) {
  if (part.kind == ShapeKind::kMesh) {
    f(FieldDistance(model, part.field));
  } else {
    with_exact_shape(part, f);
  }
}

/// Transforms points of another frame to the part's: x_part = turn x + shift.
struct ColumnPlacement {
  glm::dmat3 turn;
  glm::dvec3 shift;  // m
};

ColumnPlacement column_placement(const Pose& part, const Pose& frame) {
  const glm::dquat to_part = glm::conjugate(part.rotation);
  return {glm::mat3_cast(to_part * frame.rotation), to_part * (frame.position - part.position)};
}

// The loops below vectorise only if the compiler knows that they do not read what they write. It
// believes __restrict of parameters only: hence the local copies.

/// Distances and their gradients in the columns' frame. For the first part all are written, for
/// others only where they are smaller than the present ones.
template <bool First, class Shape>
TORSION_WIDEST void evaluate(Shape shape, const ColumnPlacement& placement, std::size_t count,
                             const double* __restrict x, const double* __restrict y,
                             const double* __restrict z, double* __restrict value,
                             double* __restrict gradient_x, double* __restrict gradient_y,
                             double* __restrict gradient_z) {
  const glm::dmat3 r = placement.turn;
  const glm::dvec3 shift = placement.shift;
  for (std::size_t i = 0; i < count; ++i) {
    const double at_x = x[i];
    const double at_y = y[i];
    const double at_z = z[i];
    const Distance distance = shape(r[0].x * at_x + r[1].x * at_y + r[2].x * at_z + shift.x,
                                    r[0].y * at_x + r[1].y * at_y + r[2].y * at_z + shift.y,
                                    r[0].z * at_x + r[1].z * at_y + r[2].z * at_z + shift.z);
    const glm::dvec3& g = distance.gradient;
    const bool nearer = First || distance.value < value[i];
    const double turned_x = r[0].x * g.x + r[0].y * g.y + r[0].z * g.z;
    const double turned_y = r[1].x * g.x + r[1].y * g.y + r[1].z * g.z;
    const double turned_z = r[2].x * g.x + r[2].y * g.y + r[2].z * g.z;
    value[i] = nearer ? distance.value : value[i];
    gradient_x[i] = nearer ? turned_x : gradient_x[i];
    gradient_y[i] = nearer ? turned_y : gradient_y[i];
    gradient_z[i] = nearer ? turned_z : gradient_z[i];
  }
}

/// The same for distances alone.
template <bool First, class Shape>
TORSION_WIDEST void evaluate_value(Shape shape, const ColumnPlacement& placement, std::size_t count,
                                   const double* __restrict x, const double* __restrict y,
                                   const double* __restrict z, double* __restrict value) {
  const glm::dmat3 r = placement.turn;
  const glm::dvec3 shift = placement.shift;
  for (std::size_t i = 0; i < count; ++i) {
    const double at_x = x[i];
    const double at_y = y[i];
    const double at_z = z[i];
    const double distance = shape(r[0].x * at_x + r[1].x * at_y + r[2].x * at_z + shift.x,
                                  r[0].y * at_x + r[1].y * at_y + r[2].y * at_z + shift.y,
                                  r[0].z * at_x + r[1].z * at_y + r[2].z * at_z + shift.z)
                                .value;
    value[i] = First || distance < value[i] ? distance : value[i];
  }
}

}  // namespace

Distance signed_distance(const Model& model, Range parts, const glm::dvec3& point) {
  Distance nearest{std::numeric_limits<double>::infinity(), glm::dvec3(0.0)};
  bool first_part = true;
  for (const ShapePart& part : model.parts.rows<ShapePart>(parts)) {
    const glm::dquat& turn = part.pose.rotation;
    const bool turned = is_turned(turn);
    glm::dvec3 local = point - part.pose.position;
    if (turned) {
      local = glm::conjugate(turn) * local;
    }
    with_shape(model, part, [&](const auto& shape) {
      const Distance distance = shape(local.x, local.y, local.z);
      if (first_part || distance.value < nearest.value) {
        nearest = {distance.value, turned ? turn * distance.gradient : distance.gradient};
      }
    });
    first_part = false;
  }
  return nearest;
}

std::span<const std::uint32_t> parts_near(const Model& model, Range parts, const glm::dvec3& center,
                                          double reach, std::span<std::uint32_t> rows) {
  TORSION_ASSERT(rows.size() >= parts.count);
  constexpr std::size_t kKept = 32;  // distances; those of further parts are asked for twice
  std::array<double, kKept> kept;
  const auto distance = [&](std::uint32_t part) {
    return signed_distance(model, Range{parts.first + part, 1}, center).value;
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t part = 0; part < parts.count && parts.count > 1; ++part) {
    const double value = distance(part);
    // As signed_distance does for all parts: a NaN of the first stays.
    nearest = part == 0 || value < nearest ? value : nearest;
    if (part < kKept) {
      kept[part] = value;
    }
  }
  // On the way from the centre a distance changes by at most `reach`, so a part that is 2 reach
  // farther away than the nearest stays farther. Half a reach more allows for the errors of
  // ellipsoids and fields.
  const double farthest = nearest + 2.5 * reach;
  std::uint32_t count = 0;
  for (std::uint32_t part = 0; part < parts.count; ++part) {
    // Written so that NaN keeps all parts.
    if (parts.count == 1 || !((part < kKept ? kept[part] : distance(part)) > farthest)) {
      rows[count++] = parts.first + part;
    }
  }
  return rows.first(count);
}

void signed_distances(const Model& model, std::span<const std::uint32_t> rows, const Pose& frame,
                      const DistanceColumns& columns) {
  const DistanceColumns& at = columns;
  if (rows.empty()) {
    std::ranges::fill(at.value, std::numeric_limits<double>::infinity());
  }
  for (const std::uint32_t& row : rows) {
    const ShapePart& part = model.parts.at<ShapePart>(row);
    const ColumnPlacement placement = column_placement(part.pose, frame);
    const auto into = [&](const auto& shape, auto&& evaluate_part) {
      evaluate_part(shape, placement, at.x.size(), at.x.data(), at.y.data(), at.z.data(),
                    at.value.data(), at.gradient_x.data(), at.gradient_y.data(),
                    at.gradient_z.data());
    };
    with_shape(model, part, [&]<class Shape>(const Shape& shape) {
      if (&row == rows.data()) {
        into(shape, evaluate<true, Shape>);
      } else {
        into(shape, evaluate<false, Shape>);
      }
    });
  }
}

void distance_values(const Model& model, Range parts, const Pose& frame, const PointColumns& points,
                     std::span<double> values) {
  if (parts.count == 0) {
    std::ranges::fill(values, std::numeric_limits<double>::infinity());
  }
  for (std::uint32_t row = parts.first; row < parts.end(); ++row) {
    const ShapePart& part = model.parts.at<ShapePart>(row);
    const ColumnPlacement placement = column_placement(part.pose, frame);
    with_shape(model, part, [&]<class Shape>(const Shape& shape) {
      const auto evaluate_part =
          row == parts.first ? evaluate_value<true, Shape> : evaluate_value<false, Shape>;
      evaluate_part(shape, placement, values.size(), points.x.data(), points.y.data(),
                    points.z.data(), values.data());
    });
  }
}

}  // namespace torsion::engine
