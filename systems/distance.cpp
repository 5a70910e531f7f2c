#include "systems/distance.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "systems/distance_field.hpp"
#include "systems/distance_shapes.hpp"
#include "systems/widest.hpp"

namespace torsion {
namespace {

constexpr std::size_t kBlock =
    32;  // points: 8 columns of doubles in 2 KiB of the first-level cache

struct Block {
  std::array<double, kBlock> x;
  std::array<double, kBlock> y;
  std::array<double, kBlock> z;
  std::array<double, kBlock> value;
};

struct Placement {
  glm::dmat3 rotation;  // part to owner
  glm::dvec3 position;  // m, owner's frame
  bool turned;
};

bool is_turned(const glm::dquat& rotation) {
  return rotation.x != 0.0 || rotation.y != 0.0 || rotation.z != 0.0;
}

Placement placement_of(const Pose& pose) {
  return {glm::mat3_cast(pose.rotation), pose.position, is_turned(pose.rotation)};
}

/// Calls f with the distance function of `part` in its own frame.
template <class F>
void with_shape(const World& world, const ShapePart& part, F&& f) {
  if (part.kind == ShapeKind::kMesh) {
    f(FieldDistance(world, part.field));
  } else {
    with_exact_shape(part, f);
  }
}

/// Replaces x, y, z of `block` by the gradient.
template <class Shape>
TORSION_WIDEST void evaluate_block(Shape shape, Block& block, std::size_t count) {
  double* __restrict x = block.x.data();
  double* __restrict y = block.y.data();
  double* __restrict z = block.z.data();
  double* __restrict value = block.value.data();
  for (std::size_t i = 0; i < count; ++i) {
    const Distance distance = shape(x[i], y[i], z[i]);
    value[i] = distance.value;
    x[i] = distance.gradient.x;
    y[i] = distance.gradient.y;
    z[i] = distance.gradient.z;
  }
}

void to_part_frame(const Placement& placement, std::span<const glm::dvec3> points, Block& block) {
  const glm::dvec3 shift = placement.position;
  for (std::size_t i = 0; i < points.size(); ++i) {
    block.x[i] = points[i].x - shift.x;
    block.y[i] = points[i].y - shift.y;
    block.z[i] = points[i].z - shift.z;
  }
  if (!placement.turned) {
    return;
  }
  const glm::dmat3& r = placement.rotation;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = block.x[i];
    const double y = block.y[i];
    const double z = block.z[i];
    block.x[i] = r[0].x * x + r[0].y * y + r[0].z * z;
    block.y[i] = r[1].x * x + r[1].y * y + r[1].z * z;
    block.z[i] = r[2].x * x + r[2].y * y + r[2].z * z;
  }
}

void gradients_to_owner_frame(const Placement& placement, std::size_t count, Block& block) {
  if (!placement.turned) {
    return;
  }
  const glm::dmat3& r = placement.rotation;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = block.x[i];
    const double y = block.y[i];
    const double z = block.z[i];
    block.x[i] = r[0].x * x + r[1].x * y + r[2].x * z;
    block.y[i] = r[0].y * x + r[1].y * y + r[2].y * z;
    block.z[i] = r[0].z * x + r[1].z * y + r[2].z * z;
  }
}

void store(const Block& block, bool first_part, std::span<Distance> distances) {
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (first_part || block.value[i] < distances[i].value) {
      distances[i] = {block.value[i], {block.x[i], block.y[i], block.z[i]}};
    }
  }
}

/// Distances to one part; unless it is the first, only where they are smaller than those that are
/// there.
void nearer_of_part(const World& world, const ShapePart& part, bool first_part,
                    std::span<const glm::dvec3> points, std::span<Distance> distances) {
  const Placement placement = placement_of(part.pose);
  Block block;
  with_shape(world, part, [&](const auto& shape) {
    for (std::size_t first = 0; first < points.size(); first += kBlock) {
      const std::size_t count = std::min(kBlock, points.size() - first);
      to_part_frame(placement, points.subspan(first, count), block);
      evaluate_block(shape, block, count);
      gradients_to_owner_frame(placement, count, block);
      store(block, first_part, distances.subspan(first, count));
    }
  });
}

/// Points of another frame to the part's, as x_part = turn x + shift.
struct ColumnPlacement {
  glm::dmat3 turn;
  glm::dvec3 shift;  // m
};

ColumnPlacement column_placement(const Pose& part, const Pose& frame) {
  const glm::dquat to_part = glm::conjugate(part.rotation);
  return {glm::mat3_cast(to_part * frame.rotation), to_part * (frame.position - part.position)};
}

// The loops below vectorise only where the compiler knows that what they write is nothing that they
// read: hence the local copies and __restrict, which it believes of parameters only.

/// `to` = row . (x, y, z) + shift
TORSION_WIDEST
void place_coordinate(const glm::dvec3& row, double shift, const DistanceColumns& columns,
                      std::size_t first, std::size_t count, double* __restrict to) {
  const double* __restrict x = columns.x.data() + first;
  const double* __restrict y = columns.y.data() + first;
  const double* __restrict z = columns.z.data() + first;
  const double row_x = row.x;
  const double row_y = row.y;
  const double row_z = row.z;
  for (std::size_t i = 0; i < count; ++i) {
    to[i] = row_x * x[i] + row_y * y[i] + row_z * z[i] + shift;
  }
}

void load_columns(const ColumnPlacement& placement, const DistanceColumns& columns,
                  std::size_t first, std::size_t count, Block& block) {
  const glm::dmat3 rows = glm::transpose(placement.turn);
  place_coordinate(rows[0], placement.shift.x, columns, first, count, block.x.data());
  place_coordinate(rows[1], placement.shift.y, columns, first, count, block.y.data());
  place_coordinate(rows[2], placement.shift.z, columns, first, count, block.z.data());
}

/// Turns gradients back into the columns' frame.
TORSION_WIDEST
void turn_back(const ColumnPlacement& placement, std::size_t count, Block& block) {
  const glm::dmat3 r = placement.turn;
  double* __restrict x = block.x.data();
  double* __restrict y = block.y.data();
  double* __restrict z = block.z.data();
  for (std::size_t i = 0; i < count; ++i) {
    const double gx = x[i];
    const double gy = y[i];
    const double gz = z[i];
    x[i] = r[0].x * gx + r[0].y * gy + r[0].z * gz;
    y[i] = r[1].x * gx + r[1].y * gy + r[1].z * gz;
    z[i] = r[2].x * gx + r[2].y * gy + r[2].z * gz;
  }
}

/// Stores what is nearer than what is there; all of it for the first part.
void store_columns(const Block& block, bool first_part, std::size_t first, std::size_t count,
                   const DistanceColumns& columns) {
  double* value = columns.value.data() + first;
  double* gx = columns.gradient_x.data() + first;
  double* gy = columns.gradient_y.data() + first;
  double* gz = columns.gradient_z.data() + first;
  if (first_part) {
    std::copy_n(block.value.begin(), count, value);
    std::copy_n(block.x.begin(), count, gx);
    std::copy_n(block.y.begin(), count, gy);
    std::copy_n(block.z.begin(), count, gz);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (block.value[i] < value[i]) {
      value[i] = block.value[i];
      gx[i] = block.x[i];
      gy[i] = block.y[i];
      gz[i] = block.z[i];
    }
  }
}

}  // namespace

Distance signed_distance(const World& world, Range parts, const glm::dvec3& point) {
  Distance nearest{std::numeric_limits<double>::infinity(), glm::dvec3(0.0)};
  bool first_part = true;
  for (const ShapePart& part : world.parts.rows<ShapePart>(parts)) {
    const glm::dquat& turn = part.pose.rotation;
    const bool turned = is_turned(turn);
    glm::dvec3 local = point - part.pose.position;
    if (turned) {
      local = glm::conjugate(turn) * local;
    }
    with_shape(world, part, [&](const auto& shape) {
      const Distance distance = shape(local.x, local.y, local.z);
      if (first_part || distance.value < nearest.value) {
        nearest = {distance.value, turned ? turn * distance.gradient : distance.gradient};
      }
    });
    first_part = false;
  }
  return nearest;
}

std::span<const std::uint32_t> parts_near(const World& world, Range parts, const glm::dvec3& center,
                                          double reach, std::span<std::uint32_t> rows) {
  TORSION_ASSERT(rows.size() >= parts.count);
  // A distance changes by at most `reach` on the way from the centre, so a part that is 2 reach
  // farther away than the nearest stays farther. Half a reach more covers what an ellipsoid or a
  // field is off by.
  const double farthest = signed_distance(world, parts, center).value + 2.5 * reach;
  std::uint32_t count = 0;
  for (std::uint32_t row = parts.first; row < parts.first + parts.count; ++row) {
    // Written so that NaN keeps all.
    if (parts.count == 1 || !(signed_distance(world, Range{row, 1}, center).value > farthest)) {
      rows[count++] = row;
    }
  }
  return rows.first(count);
}

void signed_distances(const World& world, std::span<const std::uint32_t> rows,
                      std::span<const glm::dvec3> points, std::span<Distance> distances) {
  TORSION_ASSERT(points.size() == distances.size());
  if (rows.empty()) {
    std::fill(distances.begin(), distances.end(),
              Distance{std::numeric_limits<double>::infinity(), glm::dvec3(0.0)});
  }
  for (const std::uint32_t& row : rows) {
    nearer_of_part(world, world.parts.at<ShapePart>(row), &row == rows.data(), points, distances);
  }
}

void signed_distances(const World& world, Range parts, std::span<const glm::dvec3> points,
                      std::span<Distance> distances) {
  TORSION_ASSERT(points.size() == distances.size());
  if (parts.count == 0) {
    signed_distances(world, std::span<const std::uint32_t>{}, points, distances);
  }
  for (std::uint32_t row = parts.first; row < parts.first + parts.count; ++row) {
    nearer_of_part(world, world.parts.at<ShapePart>(row), row == parts.first, points, distances);
  }
}

void signed_distances(const World& world, std::span<const std::uint32_t> rows, const Pose& frame,
                      const DistanceColumns& columns) {
  const std::size_t total = columns.x.size();
  if (rows.empty()) {
    std::ranges::fill(columns.value, std::numeric_limits<double>::infinity());
  }
  Block block;
  for (const std::uint32_t& row : rows) {
    const ShapePart& part = world.parts.at<ShapePart>(row);
    const bool first_part = &row == rows.data();
    const ColumnPlacement placement = column_placement(part.pose, frame);
    with_shape(world, part, [&](const auto& shape) {
      for (std::size_t first = 0; first < total; first += kBlock) {
        const std::size_t count = std::min(kBlock, total - first);
        load_columns(placement, columns, first, count, block);
        evaluate_block(shape, block, count);
        turn_back(placement, count, block);
        store_columns(block, first_part, first, count, columns);
      }
    });
  }
}

}  // namespace torsion
